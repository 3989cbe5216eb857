#include "gateway/cycle/standing_wishes.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

class Wishes : public testing::Test {
 protected:
  void SetUp() override {
    wishes_.change([](ServoWishes& wish) {
      wish.spindle_rpm[0] = 800;
      wish.outputs = 0b111;
    });
  }
  LatestValue<ServoWishes> servo_;
  StandingWishes wishes_{servo_};
};

TEST_F(Wishes, ReachTheServoLoopWhole) {
  EXPECT_EQ(servo_.read().spindle_rpm[0], 800);
  wishes_.change([](ServoWishes& wish) { wish.power = true; });
  EXPECT_TRUE(servo_.read().power);
  EXPECT_EQ(servo_.read().outputs, 0b111U) << "a change leaves the others alone";
}

TEST_F(Wishes, TurnOffTheSpindlesAndTheOutputsThatAreNamed) {
  const auto was = wishes_.turn_off(0b1010);
  EXPECT_EQ(servo_.read().spindle_rpm[0], 0);
  EXPECT_EQ(servo_.read().outputs, 0b101U);
  EXPECT_EQ(was.spindle_rpm[0], 800);
  EXPECT_EQ(was.outputs, 0b10U) << "only what was on goes on again";
}

TEST_F(Wishes, TurnOnAgainOnceWhatWasKeptForLater) {
  EXPECT_FALSE(wishes_.turn_on_again()) << "nothing was kept";
  wishes_.keep_for_later(wishes_.turn_off(0b10));
  wishes_.change([](ServoWishes& wish) { wish.outputs |= 0b1000; });
  EXPECT_TRUE(wishes_.turn_on_again());
  EXPECT_EQ(servo_.read().spindle_rpm[0], 800);
  EXPECT_EQ(servo_.read().outputs, 0b1111U);
  wishes_.change([](ServoWishes& wish) { wish.spindle_rpm[0] = 0; });
  EXPECT_FALSE(wishes_.turn_on_again());
  EXPECT_EQ(servo_.read().spindle_rpm[0], 0);
}

TEST_F(Wishes, AreKeptAcrossASecondTurnOff) {
  wishes_.keep_for_later(wishes_.turn_off(0b10));
  wishes_.keep_for_later(wishes_.turn_off(0b110));
  EXPECT_TRUE(wishes_.turn_on_again());
  EXPECT_EQ(servo_.read().spindle_rpm[0], 800) << "it was off already when it was turned off again";
  EXPECT_EQ(servo_.read().outputs, 0b111U);
}

TEST_F(Wishes, StayOffWhenWhatWasKeptIsForgotten) {
  wishes_.keep_for_later(wishes_.turn_off(0b10));
  wishes_.forget_later();
  EXPECT_FALSE(wishes_.turn_on_again());
  EXPECT_EQ(servo_.read().spindle_rpm[0], 0);
}

}  // namespace
}  // namespace rmac::gateway
