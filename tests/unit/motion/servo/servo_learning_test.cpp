// What was learned of a program, as laws see it: beside the setpoint, without a step, and nowhere else.
#include "rmac/motion/servo/learned_path.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

class ServoLearning : public ServoLoopTest {
 protected:
  /// Move 1, of 100 mm, with offsets of joint 0 of `height` in its middle and none at its ends.
  std::shared_ptr<const LearnedPath> hill(double height = 0.1) {
    LearnedPath::Parts made{{{1, 0}}, 100, {}, 2, {}};
    for (int i = 0; i <= 100; ++i) {
      made.places.push_back(i);
      made.offsets.push_back(height * std::pow(std::sin(std::numbers::pi * i / 100), 2));
      made.offsets.push_back(0);
    }
    return std::make_shared<const LearnedPath>(*LearnedPath::create(made));
  }
  void teach(std::shared_ptr<const LearnedPath> path) { loop->exchange_learned(path); }

  /// Joint 0 goes along the move, 0.2 mm a cycle, and its drive follows exactly.
  void go_on(double step = 0.2) {
    command.setpoint.position[0] += step;
    command.setpoint.velocity[0] = step / kPeriod;
    command.setpoint.move_id = move_;
    command.setpoint.s_mm += step;
    command.setpoint.moving = true;
    put_at(0, command.setpoint.position[0]);
    cycle();
    const double before = offset_;
    offset_ = laws[0]->last.position_setpoint - report.position_set[0];
    steepest_ = std::max(steepest_, std::abs(offset_ - before));
    EXPECT_NEAR(laws[0]->last.velocity_setpoint - command.setpoint.velocity[0], (offset_ - before) / kPeriod, 1e-9);
    EXPECT_EQ(report.position_set[0], command.setpoint.position[0]) << "what is told is the program's";
    EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
  }
  void go_to(double s_mm) {
    while (command.setpoint.s_mm < s_mm - 0.1) go_on();
  }

  std::int64_t move_ = 1;
  double offset_ = 0, steepest_ = 0;
};

TEST_F(ServoLearning, TheLawIsToldTheOffsetOfThePlaceAndTheReportIsNot) {
  build();
  engage();
  teach(hill());
  command.program = true;
  for (const double place : {10.0, 25.0, 50.0, 80.0, 100.0}) {
    go_to(place);
    EXPECT_NEAR(offset_, 0.1 * std::pow(std::sin(std::numbers::pi * place / 100), 2), 1e-5) << place;
  }
  EXPECT_EQ(laws[1]->last.position_setpoint, report.position_set[1]);
}

TEST_F(ServoLearning, NothingIsAddedWhereNoProgramRuns) {
  build();
  engage();
  teach(hill());
  go_to(50);
  EXPECT_EQ(offset_, 0) << "a jog, a way back, homing";
}

TEST_F(ServoLearning, NothingStepsWhereLearningBeginsEndsOrThePathJumps) {
  build();
  engage();
  teach(hill());
  go_to(30);
  for (int i = 0; i < 8; ++i) {
    command.program = i % 2 == 0;
    for (int k = 0; k < 20; ++k) go_on(0.05);
  }
  command.program = true;
  go_to(45);
  teach(nullptr);
  go_to(50);
  teach(hill(-0.1));
  go_to(60);
  command.setpoint.s_mm = 10;
  go_to(20);
  move_ = 2;  // of which nothing is known
  for (int i = 0; i < 200; ++i) go_on();
  EXPECT_NEAR(offset_, 0, 1e-3);
  // Critically damped with 50 1/s: the fastest that 0.2 mm go away is 0.2 · 50 / e mm/s; the hill itself has 0.63.
  EXPECT_LT(steepest_, (0.2 * 50 / std::numbers::e + 0.7) * kPeriod);
  EXPECT_GT(steepest_, 0);
}

TEST_F(ServoLearning, WhatIsLeftIsGoneWithinAFifthOfASecond) {
  build();
  engage();
  teach(hill());
  command.program = true;
  go_to(50);
  EXPECT_NEAR(offset_, 0.1, 1e-4);
  command.program = false;
  for (int i = 0; i < 200; ++i) go_on(0);
  EXPECT_NEAR(offset_, 0, 1e-4);
}

TEST_F(ServoLearning, AHoldKeepsTheOffsetOfThePlace) {
  build();
  engage();
  teach(hill());
  command.program = true;
  go_to(50);
  for (int i = 0; i < 500; ++i) go_on(0);
  EXPECT_NEAR(offset_, 0.1, 1e-4);
}

TEST_F(ServoLearning, AnOffsetIsNeverMoreThanAQuarterOfWhatAJointMayFallBehind) {
  build();
  engage();
  EXPECT_EQ(loop->learned_bound(0), 0.25);
  teach(hill(5));
  command.program = true;
  for (int i = 0; i < 499; ++i) {
    go_on();
    ASSERT_LE(std::abs(offset_), 0.25);
  }
}

TEST_F(ServoLearning, FollowingErrorsAreWatchedAgainstTheProgram) {
  ServoLoopParts made = parts();
  made.joints[0].max_following_error = 0.5;
  build(std::move(made));
  engage();
  teach(hill(0.12));
  command.program = true;
  go_to(50);
  command.setpoint.position[0] += 0.1;
  command.setpoint.s_mm += 0.1;
  put_at(0, command.setpoint.position[0] + 0.45);
  cycle();
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
  put_at(0, command.setpoint.position[0] - 0.45);
  cycle();
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None) << "to the law's setpoint it would be 0.57";
}

TEST_F(ServoLearning, AnOffsetGoesNoFasterThanItMayWhateverThePathSays) {
  build();
  engage();
  teach(hill(500));  // as of somebody who has not learned it: the whole bound from one knot to the next
  command.program = true;
  go_to(90);
  EXPECT_LE(steepest_, 0.25 * 0.25 + 1e-12) << "a quarter of its bound in a cycle of 1 ms";
  EXPECT_GT(steepest_, 0.01);
}

TEST_F(ServoLearning, AJointWhoseDriveClosesItsLoopTakesNone) {
  fake->torque_offset = true;  // its law is a model beside
  ServoLoopParts made = parts();
  made.actuators[0].mode = DriveMode::CyclicSyncPosition;
  build(std::move(made));
  EXPECT_EQ(loop->learned_bound(0), 0);
  EXPECT_EQ(loop->learned_bound(1), 0.25);
  engage();
  teach(hill());
  command.program = true;
  for (int i = 0; i < 400; ++i) {
    go_on();
    ASSERT_EQ(offset_, 0);
  }
}

TEST_F(ServoLearning, AJointWithoutPowerForgetsItsOffset) {
  build();
  engage();
  teach(hill());
  command.program = true;
  go_to(50);
  ASSERT_GT(offset_, 0.09);
  command.power = false;
  cycle(50);
  command.program = false;
  engage();
  offset_ = 0;  // no law was asked meanwhile
  go_on(0);
  EXPECT_EQ(offset_, 0);
}

}  // namespace
}  // namespace rmac::servo_test
