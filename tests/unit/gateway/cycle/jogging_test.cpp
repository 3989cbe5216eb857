#include "gateway/cycle/jogging.hpp"

#include <gmock/gmock.h>

#include "unit/gateway/cycle/cycle_bench.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class Jogs : public testing::Test {
 protected:
  CycleBench bench_;
  Jogging jogging_{bench_.cycle, bench_.entry};
};

TEST_F(Jogs, PositionsAndIsIdleAgain) {
  ASSERT_TRUE(jogging_.run(CycleBench::move_to(-1, 3)));
  EXPECT_EQ(bench_.state(), CycleState::Running);
  ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Idle; }));
  EXPECT_NEAR(bench_.x(), 3, 1e-9);
  EXPECT_FALSE(jogging_.renew(1)) << "no jog is under way";
}

TEST_F(Jogs, StopsWhenItIsNotRenewedAndLeavesNothingQueued) {
  ASSERT_TRUE(jogging_.run(CycleBench::move_to(-1, 40), 1.0));
  for (int i = 0; i < 4; ++i) {
    bench_.run(150);
    ASSERT_TRUE(jogging_.renew(1.0)) << i;
  }
  bench_.run(210);
  EXPECT_EQ(bench_.state(), CycleState::Stopping);
  ASSERT_TRUE(bench_.run_to_rest());
  EXPECT_EQ(bench_.moves_left(), 0U);
  EXPECT_LT(bench_.x(), 40);
  EXPECT_THAT(bench_.told(Event::Kind::Stopped), HasSubstr("not renewed in time"));
}

TEST_F(Jogs, GoesAtItsShareOfTheMovesSpeed) {
  const auto way_in_100_ms = [](double share) {
    CycleBench bench;
    Jogging jogging(bench.cycle, bench.entry);
    EXPECT_TRUE(jogging.run(CycleBench::move_to(-1, 40), share));
    bench.run(100);
    EXPECT_TRUE(jogging.renew(share));
    const double before = bench.x();
    bench.run(100);
    return bench.x() - before;
  };
  EXPECT_NEAR(way_in_100_ms(1), 5, 0.2);
  EXPECT_NEAR(way_in_100_ms(0.2), 1, 0.05);
}

TEST_F(Jogs, LeavesThePersonsOverrideAsItWasWhenItEnds) {
  ASSERT_TRUE(jogging_.run(CycleBench::move_to(-1, 40), 0.2));
  bench_.run(50);
  ASSERT_TRUE(jogging_.end());
  ASSERT_TRUE(bench_.run_to_rest());
  const GatewayTurn turn(bench_.cycle.lock);
  EXPECT_EQ(bench_.cycle.feed.effective_percent(), 100);
}

TEST_F(Jogs, IsRefusedWhileAProgramIsQueuedOrRuns) {
  ASSERT_TRUE(bench_.queue(1, 20));
  const auto queued = jogging_.run(CycleBench::move_to(-1, 3));
  ASSERT_FALSE(queued);
  EXPECT_THAT(queued.error().message, HasSubstr("empty queue"));
  ASSERT_TRUE(bench_.start());
  bench_.run(10);
  const auto running = jogging_.run(CycleBench::move_to(-1, 3));
  ASSERT_FALSE(running);
  EXPECT_THAT(running.error().message, HasSubstr("stop the cycle first"));
  EXPECT_TRUE(jogging_.end()) << "without effect";
  EXPECT_EQ(bench_.state(), CycleState::Running);
}

TEST_F(Jogs, ToWhereItStandsRunsNothing) {
  ASSERT_TRUE(jogging_.run(CycleBench::move_to(-1, 0)));
  EXPECT_EQ(bench_.state(), CycleState::Idle);
}

}  // namespace
}  // namespace rmac::gateway
