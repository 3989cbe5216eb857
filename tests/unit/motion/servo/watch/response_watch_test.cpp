#include "servo/watch/response_watch.hpp"

#include <numbers>

#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using Kind = ServoFault::Kind;
using testing::IsEmpty;

class AnsweringJoint : public testing::Test {
 protected:
  AnsweringJoint() { joint_.max_effort = 800; }
  /// Cycles until something is found, or -1; the mass of 35 kg gets `share` of the effort, and is to stand, or to go
  /// so.
  int push(int cycles, double effort, double share, bool is_to = false) {
    constexpr double kMass = 0.035, kCycle = 0.001;
    for (int i = 1; i <= cycles; ++i) {
      velocity_ += share * effort / kMass * kCycle;
      position_ += velocity_ * kCycle;
      watch_.step({.effort = effort, .position = position_, .position_set = is_to ? position_ : 0}, faults_);
      if (!faults_.raised.empty()) return i;
    }
    return -1;
  }
  ServoJoint joint_;
  ResponseWatch watch_{joint_, 4, 0.001};
  RecordedFaults faults_;
  double position_ = 0, velocity_ = 0;
};

TEST_F(AnsweringJoint, IsFoundWithin10MsWhereItGoesTheWrongWayEitherWay) {
  for (const double effort : {250.0, -250.0, 800.0}) {
    watch_.rest();
    faults_.raised.clear();
    position_ = velocity_ = 0;
    const int found = push(100, effort, -1);
    ASSERT_GT(found, 0);
    EXPECT_LE(found, 10);
    EXPECT_EQ(faults_.raised[0].kind, Kind::WrongDirection);
    EXPECT_EQ(faults_.raised[0].index, 4U);
    EXPECT_LT(faults_.raised[0].value * effort, 0);
  }
}

TEST_F(AnsweringJoint, MaySpeedUpWithItsEffortAndBrakeAgainstIt) {
  EXPECT_EQ(push(50, 500, 1, true), -1);
  EXPECT_EQ(push(50, -500, 1, true), -1);
  EXPECT_EQ(push(50, 500, 0, true), -1) << "nor is it wrong to be held";
}

TEST_F(AnsweringJoint, MayLetAHeavyHeadDownAgainstAnyEffort) {
  for (const double effort : {-790.0, -400.0, 400.0, 790.0}) {
    watch_.rest();
    velocity_ = 0;
    EXPECT_EQ(push(200, effort, -0.3, true), -1) << effort;
  }
}

TEST_F(AnsweringJoint, GoesWhereThePartLetsItUnderForceControl) {
  joint_.method = ControlMethod::Force;
  EXPECT_EQ(push(100, 700, -1), -1);
  for (int i = 0; i < 1000; ++i)
    watch_.step({.effort = 700, .position = position_, .position_set = i * 0.1, .out_of_bound = true}, faults_);
  EXPECT_THAT(faults_.raised, IsEmpty());
}

TEST_F(AnsweringJoint, MayStandForAnHourBeforeItGoesALongWayInTheFirstCycles) {
  for (int i = 0; i < 3'600'000; ++i) watch_.step({.position = 7, .position_set = 7}, faults_);
  for (int i = 1; i <= 15; ++i)  // until the first answer that is not of its rest
    watch_.step({.position = 7, .position_set = 7 + 0.02 * i * i, .out_of_bound = i > 8}, faults_);
  EXPECT_THAT(faults_.raised, IsEmpty());
}

TEST_F(AnsweringJoint, MayMissAnAnswerInSlowCycles) {
  ResponseWatch slow{joint_, 4, 0.02};
  for (int i = 0; i < 200; ++i) {
    const double there = i % 4 == 3 ? i - 1 : i;
    slow.step({.position = 2 * there, .position_set = 2.0 * i}, faults_);
  }
  EXPECT_THAT(faults_.raised, IsEmpty());
}

// As when a cutter leaves material, and what held it lets go.
TEST_F(AnsweringJoint, MayComeBackToItsSetpointAgainstItsEffort) {
  for (const double effort : {-450.0, 450.0}) {
    watch_.rest();
    velocity_ = 0;
    position_ = std::copysign(20, effort);
    EXPECT_EQ(push(40, effort, -1), -1) << effort;
    EXPECT_LT(position_ * effort, 20 * std::abs(effort)) << "it comes back";
  }
}

TEST_F(AnsweringJoint, MayBePushedAgainstALittleEffort) {
  EXPECT_EQ(push(100, 199, -1), -1);
}

TEST_F(AnsweringJoint, StandsStillWhereItWasToGoAMillimetreOrLeavesItsBound) {
  const auto go = [this](double step, double bound, bool moves) {
    watch_.rest();
    faults_.raised.clear();
    for (int i = 0; i <= 3000; ++i) {
      const double wanted = i * step;
      watch_.step({.position = moves ? 0.5 * wanted : 7, .position_set = 7 + wanted, .out_of_bound = wanted > bound},
                  faults_);
      if (!faults_.raised.empty()) return i;
    }
    return -1;
  };
  EXPECT_EQ(go(0.2, 100, false), 20) << "20 ms, though it was to go a millimetre in five";
  EXPECT_NEAR(go(0.01, 100, false), 100, 1) << "a millimetre, though it stands for longer";
  EXPECT_NEAR(go(0.001, 0.5, false), 501, 1) << "its bound comes first";
  EXPECT_EQ(faults_.raised[0].kind, Kind::StandsStill);
  EXPECT_NEAR(faults_.raised[0].value, 0.5, 0.01);
  EXPECT_EQ(go(0.01, 0.5, true), -1) << "it moves, by half";
  EXPECT_EQ(go(0, 0, false), -1) << "it is to stand";
}

/// A guide that seizes while a head hangs on it by 100 N: what holds it gives way, and so it swings there, and its
/// effort about that weight.
TEST_F(AnsweringJoint, StandsStillWhereItLeftItsBoundSwingingAgainstWhatHoldsIt) {
  for (int phase = 0; phase < 16; ++phase) {
    for (const double period : {7.0, 11.0, 17.0}) {
      watch_.rest();
      faults_.raised.clear();
      joint_.max_following_error = 0.5;
      double error = 0;
      for (int i = -40; std::abs(error) <= 0.5; ++i) {
        const double set = -0.033 * i;
        const double swing = i < 0 ? set : 0.045 * std::sin(2 * std::numbers::pi * (i + phase * period / 16) / period);
        error = set - swing;
        watch_.step({.effort = 100 + 90 * error + (i < 0 ? 0 : 400 * swing),
                     .position = swing,
                     .position_set = set,
                     .out_of_bound = std::abs(error) > 0.5},
                    faults_);
      }
      if (faults_.raised.empty()) watch_.name_error(error, faults_);
      EXPECT_EQ(faults_.raised[0].kind, Kind::StandsStill) << phase << ", " << period << " ms";
    }
  }
}

TEST_F(AnsweringJoint, LeavesItsBoundForNoReasonThatShowsWhereOneWordIsWrong) {
  joint_.max_following_error = 0.5;
  for (const double lag : {0.0, 0.1, 0.3}) {
    watch_.rest();
    faults_.raised.clear();
    for (int i = 0; i < 60; ++i) {
      watch_.step({.effort = 20, .position = 0.03 * i - lag, .position_set = 0.03 * i}, faults_);
    }
    watch_.step({.effort = 20, .position = 1.2, .position_set = 1.8, .out_of_bound = true}, faults_);
    watch_.name_error(0.6, faults_);
    ASSERT_FALSE(faults_.raised.empty());
    EXPECT_EQ(faults_.raised[0].kind, Kind::FollowingError) << lag;
  }
}

}  // namespace
}  // namespace rmac::servo_test
