#include <limits>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

/// Joints with bounds, moved by hand; how the machine stops is the test's to say.
class ServoWatch : public ServoLoopTest {
 protected:
  static constexpr double kMaxVelocity = 200;  // mm/s
  static constexpr double kMaxJump = 0.6;      // mm
  static constexpr double kDeceleration = 1000;
  static constexpr double kJerk = 20'000;

  ServoLoopParts watched_parts() {
    ServoLoopParts result = parts();
    for (ServoJoint& axis : result.joints) axis.bounds = {kMaxVelocity, kMaxJump, kDeceleration, kJerk};
    for (ServoActuator& actuator : result.actuators) actuator.max_torque_nm = 2;
    result.joints[2].force_sensor = ServoForceSensor{bus, 4, 0.01, 100};
    result.max_cycles_lost = 3;
    fake->drives[4].words.sensor_valid = true;
    return result;
  }
  void build_watched(StopCategory category, std::shared_ptr<const ActuatorMap> map = std::make_shared<DirectMap>()) {
    ServoLoopParts made = watched_parts();
    made.actuator_map = std::move(map);
    made.stop_categories = {category, category, category, category, category, category};
    build(std::move(made));
  }
  /// All joints at `velocity` for some cycles, followed without error.
  void move(double velocity, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      travelled_ += velocity * kPeriod;
      for (std::size_t j = 0; j < 2; ++j) {
        command.setpoint.position[j] = travelled_;
        command.setpoint.velocity[j] = velocity;
        put_at(j, travelled_);
      }
      cycle();
    }
  }
  void expect_fault(ServoFault::Kind kind, ServoFault::Part part, std::uint32_t index) const {
    EXPECT_EQ(report.state, ServoState::Faulted);
    EXPECT_STREQ(to_string(report.fault.kind), to_string(kind));
    EXPECT_EQ(report.fault.part, part);
    EXPECT_EQ(report.fault.index, index);
    EXPECT_FALSE(report.follows);
  }
  /// Joints that follow their setpoints, for so many cycles.
  void follow(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      for (std::size_t j = 0; j < 2; ++j) put_at(j, report.position_set[j]);
      cycle();
    }
  }
  [[nodiscard]] bool enabled(std::size_t axis) const {
    return (bus->commands[axis].controlword & controlword::kEnableOperation) != 0;
  }

  double travelled_ = 0;
};

TEST_F(ServoWatch, MotionWithinItsBoundsIsNoFault) {
  build_watched(StopCategory::StopThenRemovePower);
  engage();
  move(0.9 * kMaxVelocity, 50);
  fake->drives[0].words.torque_permille = 1999;
  move(-0.9 * kMaxVelocity, 50);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
}

TEST_F(ServoWatch, JointBeyondItsVelocityIsAFaultInTheThirdCycle) {
  build_watched(StopCategory::StopThenRemovePower);
  engage();
  move(1.1 * kMaxVelocity, 2);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
  move(1.1 * kMaxVelocity, 1);
  expect_fault(ServoFault::Kind::VelocityBound, ServoFault::Part::Joint, 0);
  EXPECT_NEAR(report.fault.value, 1.1 * kMaxVelocity, 1);
  EXPECT_EQ(report.fault.bound, kMaxVelocity);
  expect_all_quick_stopped();
}

TEST_F(ServoWatch, AWordThatCameACycleLateIsNoFault) {
  build_watched(StopCategory::StopThenRemovePower);
  engage();
  const double speed = 0.9 * kMaxVelocity;
  move(speed, 20);
  travelled_ += speed * kPeriod;
  command.setpoint.position[0] = command.setpoint.position[1] = travelled_;
  cycle();  // the drives told their old positions
  move(speed, 20);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
}

TEST_F(ServoWatch, TorqueBeyondItsBoundIsAFaultInTheThirdCycle) {
  build_watched(StopCategory::StopKeepPower);
  engage();
  fake->drives[1].words.torque_permille = -2001;  // of 1 N·m
  cycle(2);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
  cycle();
  expect_fault(ServoFault::Kind::TorqueBound, ServoFault::Part::Actuator, 1);
  EXPECT_NEAR(report.fault.value, -2.001, 1e-9);
  EXPECT_EQ(report.fault.stop, StopCategory::StopThenRemovePower) << "the drive may be what is wrong";
  expect_all_quick_stopped();
}

TEST_F(ServoWatch, EncoderThatJumpsIsNamedAndNotTakenForAFollowingError) {
  build_watched(StopCategory::StopKeepPower);
  engage();
  move(50, 20);
  put_at(1, travelled_ + 50 * kPeriod - 1.5 * kMaxJump);
  cycle();
  expect_fault(ServoFault::Kind::EncoderJump, ServoFault::Part::Joint, 1);
  EXPECT_NEAR(report.fault.value, -1.5 * kMaxJump, 1e-6);
  EXPECT_EQ(report.fault.stop, StopCategory::StopThenRemovePower) << "positions cannot be trusted";
  expect_all_quick_stopped();
}

TEST_F(ServoWatch, ForceSensorWithoutAValueIsAFault) {
  build_watched(StopCategory::StopThenRemovePower);
  fake->drives[4].words.sensor_counts = 350;
  engage();
  EXPECT_DOUBLE_EQ(report.force[2], 2.5);
  fake->drives[4].words.sensor_valid = false;
  cycle();
  expect_fault(ServoFault::Kind::SensorLost, ServoFault::Part::Joint, 2);
}

TEST_F(ServoWatch, DriveThatReportsItsEncoderGoneIsALostSensor) {
  build_watched(StopCategory::StopKeepPower);
  engage();
  fake->drives[1].words.statusword = 0x08;
  fake->drives[1].words.error_code = 0x7305;
  cycle();
  expect_fault(ServoFault::Kind::SensorLost, ServoFault::Part::Actuator, 1);
  EXPECT_EQ(report.fault.stop, StopCategory::StopThenRemovePower) << "it cannot brake";
}

TEST_F(ServoWatch, DeadlinesMissedWithinASecondAreAFaultBeyondTheirBound) {
  build_watched(StopCategory::StopThenRemovePower);
  engage();
  for (int second = 0; second < 3; ++second) {
    command.cycles_missed = 3;
    cycle();
    command.cycles_missed = 0;
    cycle(1000);
    ASSERT_EQ(report.fault.kind, ServoFault::Kind::None) << "as many as are allowed, in a second of their own";
  }
  command.cycles_missed = 4;
  cycle();
  expect_fault(ServoFault::Kind::CyclesLost, ServoFault::Part::Clock, 0);
  EXPECT_EQ(report.fault.bound, 3);
}

TEST_F(ServoWatch, CategoryOneTakesThePowerAwayWhenTheDriveHasComeToRest) {
  build_watched(StopCategory::StopThenRemovePower);
  engage();
  move(50, 20);
  command.cycles_missed = 4;
  cycle();
  command.cycles_missed = 0;
  for (int i = 0; i < 200; ++i) {  // the drives coast on for a while
    put_at(0, travelled_ += 0.05);
    put_at(1, travelled_);
    cycle();
    ASSERT_NE(bus->commands[0].controlword & controlword::kEnableVoltage, 0) << "braking takes power";
  }
  cycle(25);
  for (std::size_t axis = 0; axis < 4; ++axis) {
    EXPECT_EQ(bus->commands[axis].controlword & controlword::kEnableVoltage, 0) << "axis " << axis;
  }
}

TEST_F(ServoWatch, ResetWaitsUntilTheDrivesStand) {
  build_watched(StopCategory::StopThenRemovePower);
  engage();
  move(50, 20);
  command.cycles_missed = 4;
  cycle();
  command.cycles_missed = 0;
  command.power = false;
  command.reset = true;
  for (int i = 0; i < 200; ++i) {
    put_at(0, travelled_ += 0.05);
    put_at(1, travelled_);
    cycle();
    ASSERT_EQ(report.state, ServoState::Faulted) << "cycle " << i;
    ASSERT_NE(bus->commands[0].controlword & controlword::kEnableVoltage, 0) << "braking takes power";
  }
  cycle(25);
  EXPECT_EQ(report.state, ServoState::Off);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
}

TEST_F(ServoWatch, CategoryTwoBrakesJointsWithinTheirLimitsAndHoldsThemUnderPower) {
  build_watched(StopCategory::StopKeepPower);
  engage();
  move(100, 20);
  fake->drives[4].words.sensor_valid = false;
  cycle();
  expect_fault(ServoFault::Kind::SensorLost, ServoFault::Part::Joint, 2);
  EXPECT_EQ(report.fault.stop, StopCategory::StopKeepPower);
  const double began = report.position_set[0];
  double velocity = report.velocity_set[0], acceleration = report.acceleration_set[0];
  for (int i = 0; i < 300; ++i) {
    follow(1);
    ASSERT_EQ(report.velocity_set[0], report.velocity_set[1]) << "of the same limits";
    ASSERT_LE(velocity - report.velocity_set[0], kDeceleration * kPeriod * 1.0001);
    ASSERT_LE(std::abs(report.acceleration_set[0] - acceleration), kJerk * kPeriod * 1.0001) << "cycle " << i;
    velocity = report.velocity_set[0];
    acceleration = report.acceleration_set[0];
    ASSERT_TRUE(enabled(0) && enabled(1) && enabled(2)) << "cycle " << i;
  }
  EXPECT_EQ(velocity, 0);
  const double time_s = 100 / kDeceleration + kDeceleration / kJerk;
  EXPECT_NEAR(report.position_set[0] - began, 100 * time_s / 2, 0.11);
}

TEST_F(ServoWatch, CategoryTwoGoesOverToOneWhenMoreGoesWrong) {
  build_watched(StopCategory::StopKeepPower);
  engage();
  move(100, 20);
  fake->drives[4].words.sensor_valid = false;
  cycle();
  follow(10);
  fake->drives[1].words.statusword = 0x08;
  cycle();
  expect_fault(ServoFault::Kind::SensorLost, ServoFault::Part::Joint, 2);
  EXPECT_EQ(report.fault.stop, StopCategory::StopThenRemovePower);
  expect_all_quick_stopped();
}

TEST_F(ServoWatch, SilentDriveIsLeftOutWhileTheOthersBrake) {
  build_watched(StopCategory::StopKeepPower);
  engage();
  move(100, 20);
  fake->drives[0].words.online = false;
  cycle();
  expect_fault(ServoFault::Kind::DriveOffline, ServoFault::Part::Actuator, 0);
  EXPECT_EQ(report.fault.stop, StopCategory::StopKeepPower);
  double velocity = report.velocity_set[1];
  EXPECT_NEAR(velocity, 100 - kJerk * kPeriod * kPeriod / 2, 1e-9) << "at once";
  for (int i = 0; i < 300; ++i) {
    if (i == 50) fake->drives[0].words.online = true;
    follow(1);
    ASSERT_LE(velocity - report.velocity_set[1], kDeceleration * kPeriod * 1.0001);
    velocity = report.velocity_set[1];
    ASSERT_TRUE(enabled(1) && enabled(2)) << "cycle " << i;
    ASSERT_FALSE(enabled(0)) << "cycle " << i;
    ASSERT_EQ(torque(0), 0) << "cycle " << i;
  }
  EXPECT_EQ(velocity, 0);
  EXPECT_EQ(report.fault.stop, StopCategory::StopKeepPower) << "it was back meanwhile";
  command.power = false;
  command.reset = true;
  cycle(25);
  command.reset = false;
  engage();
  EXPECT_TRUE(enabled(0));
}

TEST_F(ServoWatch, SilentSpindleLeavesEveryJointToBrake) {
  build_watched(StopCategory::StopKeepPower);
  engage();
  move(100, 20);
  fake->drives[3].words.online = false;
  cycle();
  expect_fault(ServoFault::Kind::DriveOffline, ServoFault::Part::Spindle, 0);
  EXPECT_EQ(report.fault.stop, StopCategory::StopKeepPower);
  for (int i = 0; i < 300; ++i) {
    if (i == 50) fake->drives[3].words.online = true;
    follow(1);
    ASSERT_EQ(report.velocity_set[0], report.velocity_set[1]) << "of the same limits";
    ASSERT_TRUE(enabled(0) && enabled(1) && enabled(2)) << "cycle " << i;
    ASSERT_FALSE(enabled(3)) << "cycle " << i;
  }
  EXPECT_EQ(report.velocity_set[0], 0);
}

TEST_F(ServoWatch, SecondSilentDriveMakesItCategoryOne) {
  build_watched(StopCategory::StopKeepPower);
  engage();
  move(100, 20);
  fake->drives[0].words.online = false;
  cycle();
  follow(10);
  fake->drives[1].words.online = false;
  cycle();
  expect_fault(ServoFault::Kind::DriveOffline, ServoFault::Part::Actuator, 0);
  EXPECT_EQ(report.fault.stop, StopCategory::StopThenRemovePower);
  expect_all_quick_stopped();
}

TEST_F(ServoWatch, SilentDriveThatJointsShareIsCategoryOne) {
  build_watched(StopCategory::StopKeepPower, std::make_shared<DifferentialMap>());
  engage();
  fake->drives[1].words.online = false;
  cycle();
  expect_fault(ServoFault::Kind::DriveOffline, ServoFault::Part::Actuator, 1);
  EXPECT_EQ(report.fault.stop, StopCategory::StopThenRemovePower);
  expect_all_quick_stopped();
}

TEST_F(ServoWatch, ResetLeavesAStopThatKeptPower) {
  build_watched(StopCategory::StopKeepPower);
  engage();
  fake->drives[4].words.sensor_valid = false;
  cycle();
  fake->drives[4].words.sensor_valid = true;
  command.power = false;
  command.reset = true;
  cycle(25);  // until the drives are seen to stand
  EXPECT_EQ(report.state, ServoState::Off);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
  command.reset = false;
  engage();
}

}  // namespace
}  // namespace rmac::servo_test
