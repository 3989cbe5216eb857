#include "gateway/cycle/parking.hpp"

#include <gmock/gmock.h>

#include "unit/gateway/cycle/cycle_bench.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class ParksAProgram : public testing::Test {
 protected:
  /// Two moves, held on the first.
  void hold_at(double x) {
    ASSERT_TRUE(bench_.queue(1, 20));
    ASSERT_TRUE(bench_.queue(2, 30));
    ASSERT_TRUE(bench_.start());
    ASSERT_TRUE(bench_.run_until([&] { return bench_.x() > x; }));
    ASSERT_TRUE(bench_.hold());
    ASSERT_TRUE(bench_.run_to_rest());
  }
  void park(std::uint64_t outputs_off = 0) {
    const auto parked = parking_.park(outputs_off);
    ASSERT_TRUE(parked) << parked.error().message;
    ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Idle; }));
  }
  void take_up() {
    const auto steps = parking_.parked()->steps;
    ASSERT_TRUE(bench_.entry.prepare());
    ASSERT_TRUE(parking_.add_rest_of(steps.front()));
    for (std::size_t i = 1; i < steps.size(); ++i) ASSERT_TRUE(bench_.entry.add(std::get<Move>(steps[i].what)));
    ASSERT_TRUE(parking_.hold_taken_up());
  }
  CycleBench bench_;
  Parking parking_{bench_.cycle};
};

TEST_F(ParksAProgram, FromWhereItIsHeld) {
  hold_at(8);
  const double held = bench_.x();
  park();
  EXPECT_EQ(bench_.moves_left(), 0U);
  ASSERT_TRUE(parking_.parked());
  EXPECT_EQ(parking_.parked()->mechanism, "Bench");
  ASSERT_EQ(parking_.parked()->steps.size(), 2U);
  EXPECT_NEAR(parking_.parked()->steps.front().from_mm, held, 1e-9);
  EXPECT_NEAR(parking_.parked()->place.tip[0], held, 1e-9);
  take_up();
  EXPECT_EQ(bench_.state(), CycleState::Holding);
  EXPECT_FALSE(parking_.parked()) << "it is queued again";
  ASSERT_TRUE(bench_.resume());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.moves_left() == 0; }));
  EXPECT_NEAR(bench_.x(), 30, 1e-9);
}

TEST_F(ParksAProgram, WithSpindleCoolantAndOverrideAndHasThemAgainWhenItGoesOn) {
  bench_.status.spindle_rpm[0] = 500;
  {
    const GatewayTurn turn(bench_.cycle.lock);
    bench_.cycle.wishes.change([](ServoWishes& wish) {
      wish.spindle_rpm[0] = 500;
      wish.outputs = 0b11;
    });
    ASSERT_TRUE(bench_.cycle.feed.set(60));
  }
  hold_at(8);
  park(0b10);
  EXPECT_EQ(bench_.wishes().spindle_rpm[0], 0);
  EXPECT_EQ(bench_.wishes().outputs, 0b01U);
  {
    const GatewayTurn turn(bench_.cycle.lock);
    ASSERT_TRUE(bench_.cycle.feed.set(100));
  }
  take_up();
  EXPECT_EQ(bench_.wishes().spindle_rpm[0], 0) << "held, it cuts nothing";
  ASSERT_TRUE(bench_.resume());
  EXPECT_EQ(bench_.wishes().spindle_rpm[0], 500);
  EXPECT_EQ(bench_.wishes().outputs, 0b11U);
  const GatewayTurn turn(bench_.cycle.lock);
  EXPECT_EQ(bench_.cycle.feed.percent(), 60);
}

TEST_F(ParksAProgram, OnlyOneAndOnlyWhatIsHeldAtRest) {
  EXPECT_THAT(parking_.park(0).error().message, HasSubstr("nothing is queued"));
  ASSERT_TRUE(bench_.queue(1, 20));
  ASSERT_TRUE(bench_.start());
  bench_.run(100);
  EXPECT_THAT(parking_.park(0).error().message, HasSubstr("hold the program with FeedHold first"));
  ASSERT_TRUE(bench_.hold());
  EXPECT_THAT(parking_.park(0).error().message, HasSubstr("still coming to rest"));
  ASSERT_TRUE(bench_.run_to_rest());
  park();
  ASSERT_TRUE(bench_.queue(3, 0));
  EXPECT_THAT(parking_.park(0).error().message, HasSubstr("a program is parked already, on Bench"));
}

TEST_F(ParksAProgram, AndKeepsItWhenAStopComesWhileItIsTakenUp) {
  hold_at(8);
  park();
  ASSERT_TRUE(bench_.entry.prepare());
  ASSERT_TRUE(parking_.add_rest_of(parking_.parked()->steps.front()));
  ASSERT_TRUE(bench_.stop_now());
  ASSERT_TRUE(bench_.run_to_rest());
  EXPECT_FALSE(parking_.hold_taken_up());
  parking_.drop_taken_up();
  EXPECT_EQ(bench_.moves_left(), 0U);
  EXPECT_TRUE(parking_.parked());
}

TEST_F(ParksAProgram, AndSaysWhatIsLostWhenItIsDropped) {
  parking_.drop("nothing is parked");
  EXPECT_EQ(bench_.told(Event::Kind::Mechanism), "");
  hold_at(8);
  park();
  (void)bench_.events();
  parking_.drop("it rains");
  EXPECT_EQ(bench_.told(Event::Kind::Mechanism),
            "the program that was parked on Bench is dropped, with 2 moves to do: it rains");
  EXPECT_FALSE(parking_.parked());
}

}  // namespace
}  // namespace rmac::gateway
