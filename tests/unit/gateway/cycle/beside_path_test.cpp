// A machine that a stop has brought to rest beside its path, and one that does not get on.
#include <gmock/gmock.h>

#include "unit/gateway/cycle/cycle_bench.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class BesideThePath : public testing::Test {
 protected:
  BesideThePath() {
    EXPECT_TRUE(bench_.queue(1, 40));
    EXPECT_TRUE(bench_.queue(2, 45));
    EXPECT_TRUE(bench_.start());
    bench_.run(300);
    left_at_ = bench_.x();
    bench_.link.stops.asked = true;
    while (bench_.status.moving) bench_.follow();
    bench_.link.stops.asked = false;
    (void)bench_.events();
  }
  Expected<> stop() {
    return bench_.cycle.stop_command([](CycleSequencer& sequencer, const auto&) { return sequencer.stop(); });
  }
  void expect_the_rest_is_done() {
    ASSERT_TRUE(bench_.run_until([&] { return bench_.moves_left() == 0 && bench_.status.moves_done == 2; }));
    EXPECT_NEAR(bench_.x(), 45, 1e-9);
  }

  CycleBench bench_;
  double left_at_ = 0;
};

TEST_F(BesideThePath, AHeldMachineSaysSoAndGoesBackFirst) {
  ASSERT_TRUE(bench_.hold());
  bench_.run(3);
  EXPECT_EQ(bench_.state(), CycleState::Holding);
  EXPECT_THAT(bench_.told(Event::Kind::CycleStateChanged), HasSubstr("Holding, beside the path"));
  bench_.run(3);
  EXPECT_EQ(bench_.told(Event::Kind::CycleStateChanged), "") << "it is told once";
  const double rests_at = bench_.x();
  EXPECT_GT(rests_at, left_at_);
  ASSERT_TRUE(bench_.resume());
  double least = rests_at;
  ASSERT_TRUE(bench_.run_until([&] {
    least = std::min(least, bench_.x());
    return bench_.x() > rests_at + 1;
  }));
  EXPECT_LT(least, rests_at - 0.1) << "it was at the place where the path was left";
  expect_the_rest_is_done();
}

TEST_F(BesideThePath, AStoppedCycleSaysSoAndGoesBackFirst) {
  ASSERT_TRUE(stop());
  bench_.run(3);
  EXPECT_EQ(bench_.state(), CycleState::Idle);
  EXPECT_THAT(bench_.told(Event::Kind::Stopped), HasSubstr("beside the path"));
  ASSERT_TRUE(bench_.start());
  expect_the_rest_is_done();
}

TEST_F(BesideThePath, ACycleThatWasNotStoppedAfterAllGoesOnByItself) {
  expect_the_rest_is_done();
}

TEST_F(BesideThePath, StopNowForgetsThePath) {
  ASSERT_TRUE(bench_.stop_now());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Idle; }));
  EXPECT_THAT(bench_.told(Event::Kind::Stopped), testing::Not(HasSubstr("beside the path")));
  EXPECT_EQ(bench_.moves_left(), 0U);
  const double rests_at = bench_.x();
  ASSERT_TRUE(bench_.queue(3, rests_at + 2));
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.moves_left() == 0; }));
  EXPECT_NEAR(bench_.x(), rests_at + 2, 1e-9);
}

class Watched : public testing::Test {
 protected:
  Watched() {
    EXPECT_TRUE(bench_.queue(1, 40));
    EXPECT_TRUE(bench_.start());
    bench_.run(200);
    (void)bench_.events();
  }
  void advance() {
    const PlannerTurn turn(bench_.cycle.lock);
    (void)bench_.cycle.advance(bench_.status);
  }
  /// Machine time passes, and the setpoint stays where it is.
  void stand(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      bench_.status.t_s += 0.001;
      advance();
    }
  }
  CycleBench bench_;
};

TEST_F(Watched, StandingWithoutAReasonIsAFault) {
  stand(400);
  EXPECT_EQ(bench_.state(), CycleState::Running);
  stand(200);
  EXPECT_EQ(bench_.state(), CycleState::Faulted);
  EXPECT_THAT(bench_.told(Event::Kind::Fault), HasSubstr("stood for 0.5 s at move 1"));
  EXPECT_TRUE(bench_.link.stops.stop());
}

TEST_F(Watched, StandingAtAnOverrideOfZeroIsNone) {
  {
    const GatewayTurn turn(bench_.cycle.lock);
    ASSERT_TRUE(bench_.cycle.feed.set(0));
    bench_.cycle.apply_feed();
  }
  bench_.run(500);
  stand(2000);
  EXPECT_EQ(bench_.state(), CycleState::Running);
}

TEST_F(Watched, StandingWhileHeldIsNone) {
  ASSERT_TRUE(bench_.hold());
  bench_.run(500);
  stand(2000);
  EXPECT_EQ(bench_.state(), CycleState::Holding);
}

TEST_F(Watched, KinematicsThatFailOnTheWayAreAFault) {
  bench_.status.progress.departure = {1, 1, 150, PathDeparture::Cause::NoSolution, 0};
  advance();
  EXPECT_EQ(bench_.state(), CycleState::Faulted);
  EXPECT_THAT(bench_.told(Event::Kind::Fault), HasSubstr("found no joints"));
}

TEST(JogWish, EndsNothingButAJog) {
  CycleBench bench;
  Jogging jogging(bench.cycle, bench.entry);
  EXPECT_FALSE(bench.cycle.jogs());
  ASSERT_TRUE(jogging.run(CycleBench::move_to(-1, 40), 0.5));
  EXPECT_TRUE(bench.cycle.jogs());
  ASSERT_TRUE(jogging.end());
  EXPECT_FALSE(bench.cycle.jogs());
  ASSERT_TRUE(bench.run_to_rest());
  ASSERT_TRUE(bench.queue(1, 40));
  ASSERT_TRUE(bench.start());
  bench.run(100);
  ASSERT_TRUE(jogging.end()) << "the key of a jog that is no more";
  EXPECT_EQ(bench.state(), CycleState::Running);
  EXPECT_FALSE(bench.link.stops.stop());
}

TEST(JogWish, HasTheServoThreadEndAJogThatIsNotRenewed) {
  CycleBench bench;
  Jogging jogging(bench.cycle, bench.entry);
  ASSERT_TRUE(jogging.run(CycleBench::move_to(-1, 40), 0.5));
  const double until_s = bench.wishes().moves_until_s;
  EXPECT_NEAR(until_s, bench.status.t_s + 0.2, 1e-9);
  bench.run(100);
  ASSERT_TRUE(jogging.renew(0.5));
  EXPECT_NEAR(bench.wishes().moves_until_s, until_s + 0.1, 1e-9);
  ASSERT_TRUE(jogging.end());
  EXPECT_TRUE(std::isinf(bench.wishes().moves_until_s));
}

}  // namespace
}  // namespace rmac::gateway
