#include "servo/watch/standing_watch.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using Kind = ServoFault::Kind;
using testing::IsEmpty;

/// 800 N, 1 m/s², 0.5 mm of following error; a digit is 0.0001 mm.
class StandingJoint : public testing::Test {
 protected:
  void step(double position, double position_set, double effort = 0) {
    watch_.step({.effort = effort, .position = position, .position_set = position_set}, faults_);
  }
  /// It rests, and its last digit goes to and fro.
  void rest_restlessly(int cycles) {
    for (int i = 0; i < cycles; ++i) step(i % 2 == 0 ? 0 : 1e-4, 0);
  }
  ServoJoint joint_ = [] {
    ServoJoint made;
    made.max_effort = 800;
    made.max_following_error = 0.5;
    made.bounds.stop_deceleration = 1000;
    return made;
  }();
  StandingWatch watch_{joint_, 4, 0.001};
  RecordedFaults faults_;
};

TEST_F(StandingJoint, HasAFrozenEncoderWhereItsLastDigitRestsWhileTheEffortChanges) {
  rest_restlessly(30);
  int cycles = 0;
  while (faults_.raised.empty() && cycles < 1000) step(0, 0, 2.0 * ++cycles);
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::EncoderFrozen);
  EXPECT_NEAR(cycles, 21, 2) << "20 ms, and 24 N of 800 sooner";
}

TEST_F(StandingJoint, MayRestWithACoarseEncoderUntilItsEffortIsThatOfNoFriction) {
  for (int i = 0; i < 300; ++i) step(0, 0);
  for (int i = 0; i < 400; ++i) step(0, 1e-5 * i, 0.39 * i);
  EXPECT_THAT(faults_.raised, IsEmpty()) << "a fifth of its effort";
  for (int i = 0; i < 20; ++i) step(0, 0.005, 200);
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::StandsStill);
}

TEST_F(StandingJoint, ForgetsWhereItsCounterWasBeforeItWasUnderControl) {
  watch_.rest(5);
  watch_.rest(0);
  step(0, 0);
  for (int i = 0; i < 400; ++i) step(0, 1e-5 * i, 0.39 * i);
  EXPECT_THAT(faults_.raised, IsEmpty());
}

TEST_F(StandingJoint, IsNotStoppedByOneDigitHoweverShortTheCycle) {
  StandingWatch quick(joint_, 4, 0.00025);
  const auto look = [&](double position, double effort) {
    quick.step({.effort = effort, .position = position, .position_set = 0}, faults_);
  };
  for (int i = 0; i < 100; ++i) look(1e-3 * (i / 20), 0);
  for (int i = 0; i < 200; ++i) look(4e-3, 0.3 * i);
  EXPECT_THAT(faults_.raised, IsEmpty());
}

TEST_F(StandingJoint, MayBePushedWhileItIsToGoByLessThanADigit) {
  for (const double position : {0.0, 0.001, 0.0}) step(position, 0);
  for (int i = 0; i < 200; ++i) step(0, 1e-6 * i, i < 100 ? 0 : 170);
  EXPECT_THAT(faults_.raised, IsEmpty());
}

// A push that grows is held without an error that grows: nothing moves.
TEST_F(StandingJoint, MayBePushedAtRestWithACoarseEncoder) {
  for (int i = 0; i < 400; ++i) step(0, 0, 1.9 * i);
  EXPECT_THAT(faults_.raised, IsEmpty());
}

TEST_F(StandingJoint, HasAFrozenEncoderWhereItStopsDeadAtSpeed) {
  for (const double position : {0.0, 1e-4, 0.0}) step(position, 0);
  for (int i = 0; i < 20; ++i) step(0.05 * i, 0.05 * i);
  EXPECT_FALSE(watch_.froze());
  for (int i = 0; i < 4; ++i) step(0.05 * 19, 1);
  EXPECT_TRUE(watch_.froze());
  step(0.96, 1);
  EXPECT_FALSE(watch_.froze());
}

TEST_F(StandingJoint, IsBlockedThoughWhatBlocksItGivesWay) {
  int cycles = 0;
  for (int i = 0; i < 300; ++i) step(0, 0);
  while (faults_.raised.empty() && cycles < 1000) {
    ++cycles;
    step(0.002 * cycles, 0.01 * cycles, 300);
  }
  EXPECT_NEAR(cycles, 100, 3) << "a millimetre";
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::StandsStill);
}

TEST_F(StandingJoint, IsBlockedOnAWayToAndFroThatIsNoMillimetreLong) {
  double way = 0, before = 0;
  for (int i = 0; i < 300; ++i) step(0, 0);
  for (int i = 0; i < 5000 && faults_.raised.empty(); ++i) {
    const double set = 0.2 * std::sin(0.02 * i);
    way += std::abs(set - std::exchange(before, set));
    step(i % 2 == 0 ? 0 : 1e-4, set, 100);
  }
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::StandsStill);
  EXPECT_NEAR(way, 1, 0.05);
}

TEST_F(StandingJoint, IsBlockedWhereAllItsEffortForATenthOfASecondComesToNothing) {
  int cycles = 0;
  while (faults_.raised.empty() && cycles < 1000) {
    ++cycles;
    step(cycles % 2 == 0 ? 0 : 1e-4, 1e-5 * cycles, 799);
  }
  EXPECT_NEAR(cycles, 100, 3);
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::StandsStill);
}

TEST_F(StandingJoint, IsBlockedByAllThatItsLoopAsksForThoughItsDriveTellsLess) {
  int cycles = 0;
  while (faults_.raised.empty() && cycles < 1000) {
    ++cycles;
    watch_.step({.effort = 0.91 * 800, .commanded = 800, .position = cycles % 2 == 0 ? 0 : 1e-4}, faults_);
  }
  EXPECT_NEAR(cycles, 100, 3);
}

/// It creeps at half a millimetre a minute; its digits go to and fro by three, and rest for some milliseconds.
class FineEncoder : public StandingJoint {
 protected:
  FineEncoder() {
    for (; cycle_ < 300; ++cycle_) step(at(cycle_), set(cycle_), 100);
  }
  static double at(int i) {
    const double noise = i % 10 == 0 ? 3 : i % 10 == 1 ? -3 : i % 10 == 2 ? -2 : 0;
    return 1e-4 * (std::round(0.75 * (i / 10)) + noise);
  }
  static double set(int i) { return 7.5e-6 * i; }
  /// How much its effort changed until anything was found.
  double freeze(double effort_a_cycle) {
    const double stays = at(cycle_ - 1);
    double change = 0;
    for (; faults_.raised.empty() && change < 800; ++cycle_) step(stays, set(cycle_), 100 + (change += effort_a_cycle));
    return change;
  }
  int cycle_ = 0;
};

TEST_F(FineEncoder, FreezesThoughItRestedAtTimesBefore) {
  const double change = freeze(0.05);
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::EncoderFrozen);
  EXPECT_LE(change, 0.031 * 800) << "before its joint is pushed through its friction";
}

TEST_F(FineEncoder, FreezesByAHundredthOfItsEffortWhereItWasToGoFarMeanwhile) {
  const double change = freeze(0.008);
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::EncoderFrozen);
  EXPECT_NEAR(change, 0.01 * 800, 0.5) << "after 67 digits; 3 % would take three seconds";
}

// 40 N of friction; a digit of 5 um does not show how that gives way, and flickers by one as the joint is held before.
TEST_F(StandingJoint, MayMoveAndTurnRoundAgainstItsFrictionWithACoarseEncoder) {
  constexpr double kDigit = 5e-3, kStiffness = 600;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.3);
  double set = 0, position = 0;
  for (int i = 0; i < 30'000; ++i) {
    const bool held = i < 3000;
    set = held ? 0 : 0.5 * std::sin(2e-3 * (i - 3000));
    const double effort = std::clamp(kStiffness * (set - position), -40.0, 40.0);
    if (std::abs(effort) == 40) position = set - std::copysign(40 / kStiffness, effort);
    const double flicker = held && i / 7 % 2 == 0 ? kDigit : 0;
    step(kDigit * std::round(position / kDigit) + flicker, set, effort + noise(random));
  }
  EXPECT_THAT(faults_.raised, IsEmpty());
}

// As with `rmac load --soften 8` on a joint that is heavier than it is said to be.
TEST_F(StandingJoint, MayBeSlowToFollowWhereItsLoopIsSoft) {
  double position = 0, velocity = 0, largest = 0;
  for (int i = 0; i < 300; ++i) {
    const double t = std::max(0, i - 10) * 1e-3, speed = std::min(1000 * t, 50.0);
    const double set = t < 0.05 ? 500 * t * t : 1.25 + 50 * (t - 0.05);
    const double effort = 26 * (set - position) + 0.42 * (speed - velocity);
    velocity += effort / 0.105 * 1e-3;
    position += velocity * 1e-3;
    largest = std::max(largest, set - position);
    step(position, set, effort);
  }
  EXPECT_THAT(faults_.raised, IsEmpty());
  EXPECT_GT(largest, 1);
}

// It goes by a digit in a third of a second, and its motor cogs.
TEST_F(StandingJoint, MayCreepFromDigitToDigitOfACoarseEncoder) {
  for (int i = 0; i < 20'000; ++i) {
    const double set = 16e-6 * i, noise = 4e-4 * std::sin(1.7 * i);
    step(5e-3 * std::round((set + noise) / 5e-3), set, 30 * std::sin(2e-3 * i));
  }
  EXPECT_THAT(faults_.raised, IsEmpty());
}

// What slips is under velocity control, and makes nothing good that kept it from going.
TEST_F(StandingJoint, MaySlipUnderVelocityControlButNotWithAFrozenEncoder) {
  joint_.method = ControlMethod::Velocity;
  for (int i = 0; i < 2000; ++i) step(0, std::min(0.01 * i, 0.25), std::min(4.0 * i, 800.0));
  EXPECT_THAT(faults_.raised, IsEmpty());
  watch_.rest();
  rest_restlessly(30);
  for (int i = 0; i < 100; ++i) step(0, std::min(0.01 * i, 0.25), 4.0 * i);
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::EncoderFrozen);
}

TEST_F(StandingJoint, IsBlockedAfterItSpedUpWithAllItsEffort) {
  double at = 0;
  for (int i = 0; i < 200; ++i) step(at = 5e-4 * i * i, 5e-4 * i * i, 800);
  EXPECT_THAT(faults_.raised, IsEmpty());
  int cycles = 0;
  while (faults_.raised.empty() && cycles < 1000) step(at + (++cycles % 2 == 0 ? 0 : 1e-4), at + 1e-4, 800);
  EXPECT_LE(cycles, 202) << "a tenth of a second of its own";
}

TEST_F(StandingJoint, MaySpeedUpWithAllItsEffort) {
  for (int i = 0; i < 400; ++i) step(5e-4 * i * i, 5e-4 * i * i, 800);
  EXPECT_THAT(faults_.raised, IsEmpty());
}

}  // namespace
}  // namespace rmac::servo_test
