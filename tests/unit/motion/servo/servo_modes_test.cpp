// Drives that follow a position or a velocity themselves: what words they get for what the joints are to do.
#include <gmock/gmock.h>

#include <limits>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

constexpr double kGain = 20;  // 1/s

class ServoModes : public ServoLoopTest {
 protected:
  /// Joint 0 is left to its drive; the others stay in torque mode.
  ServoLoopParts with(DriveMode mode, std::shared_ptr<const ActuatorMap> map = std::make_shared<DirectMap>()) {
    ServoLoopParts made = parts(std::move(map));
    made.joints[0].law = nullptr;
    made.actuators[0].mode = mode;
    if (mode == DriveMode::CyclicSyncVelocity) made.actuators[0].position_gain = kGain;
    return made;
  }
  [[nodiscard]] const DriveCommand& words(std::size_t axis = 0) const { return bus->commands[axis]; }
  [[nodiscard]] double sent_mm(std::size_t axis = 0) const { return words(axis).target_position_counts / kCountsPerMm; }
  /// 1 rad a mm.
  [[nodiscard]] double sent_mm_s() const { return words().target_velocity_rpm * 2 * std::numbers::pi / 60; }
  std::string refusal_of(ServoLoopParts made) {
    const auto built = ServoLoop::create(std::move(made));
    return built ? std::string() : built.error().message;
  }
};

TEST_F(ServoModes, PositionDriveIsSentWhereItStandsUntilItIsEnabledAndThenItsSetpoint) {
  build(with(DriveMode::CyclicSyncPosition));
  put_at(0, 7.25);
  cycle();
  EXPECT_EQ(words().mode, DriveMode::CyclicSyncPosition);
  EXPECT_EQ(sent_mm(), 7.25);
  engage();
  EXPECT_EQ(sent_mm(), 7.25);
  for (int i = 1; i <= 5; ++i) {
    command.setpoint.position[0] = 7.25 + 0.1 * i;
    cycle();
    EXPECT_NEAR(sent_mm(), 7.25 + 0.1 * i, 1e-9);
    EXPECT_EQ(torque(0), 0);
  }
  EXPECT_EQ(words(1).mode, DriveMode::CyclicSyncTorque);
}

TEST_F(ServoModes, PositionDrivesOfAGantryAreNotPulledTogetherAsTheyAreEnabled) {
  ServoLoopParts made = with(DriveMode::CyclicSyncPosition, std::make_shared<GantryMap>());
  made.joints.pop_back();
  made.actuators[2].mode = DriveMode::CyclicSyncPosition;
  build(std::move(made));
  put_at(0, 10);
  put_at(2, -9.4);
  engage();
  EXPECT_NEAR(sent_mm(0), 10, 1e-3);
  EXPECT_NEAR(sent_mm(2), -9.4, 1e-3);
  for (int i = 1; i <= 5; ++i) {
    command.setpoint.position[0] += 0.1;
    cycle();
    EXPECT_NEAR(sent_mm(0), 10 + 0.2 * i, 1e-3);
    EXPECT_NEAR(sent_mm(2), -9.4 - 0.2 * i, 1e-3);
    put_at(0, sent_mm(0));
    put_at(2, sent_mm(2));
  }
}

TEST_F(ServoModes, PositionWordWrapsAsTheDrivesDoes) {
  build(with(DriveMode::CyclicSyncPosition));
  constexpr double kWrap = 2147483.648;  // 2^31 counts in mm
  put_at(0, kWrap - 0.1);
  engage();
  command.setpoint.position[0] += 0.3;
  cycle();
  EXPECT_NEAR(sent_mm(), -kWrap + 0.2, 2e-3);
}

TEST_F(ServoModes, HonourTheDrivesSenseAndHome) {
  ServoLoopParts made = with(DriveMode::CyclicSyncPosition);
  made.actuators[0].scale.direction = -1;
  made.actuators[0].scale.home_counts = 2000;
  build(std::move(made));
  put_at(0, 12);
  engage();
  command.setpoint.position[0] = -9.5;
  cycle();
  EXPECT_NEAR(sent_mm(), 11.5, 1e-9);
}

TEST_F(ServoModes, VelocityDriveIsSentTheSetpointsVelocityAndAPartOfTheError) {
  build(with(DriveMode::CyclicSyncVelocity));
  engage();
  EXPECT_EQ(sent_mm_s(), 0);
  command.setpoint.position[0] = 0.1;
  cycle();
  EXPECT_NEAR(sent_mm_s(), 100 + kGain * 0.1, 1e-6);
  cycle();
  EXPECT_NEAR(sent_mm_s(), kGain * 0.1, 1e-6) << "the setpoint stands, and the joint does not";
  put_at(0, 0.1);
  cycle();
  EXPECT_NEAR(sent_mm_s(), 0, 1e-6);
}

TEST_F(ServoModes, StopWithoutPowerLeavesNoSetpointBehind) {
  build(with(DriveMode::CyclicSyncVelocity));
  engage();
  command.setpoint.position[0] = 0.1;
  cycle();
  command.power = false;
  cycle();
  EXPECT_EQ(sent_mm_s(), 0);
  put_at(0, 30);
  command.power = true;
  for (int i = 0; i < 10; ++i) {
    cycle();
    EXPECT_EQ(sent_mm_s(), 0) << "it is enabled where it stands";
    for (std::size_t j = 0; j < 2; ++j) command.setpoint.position[j] = loop->hold_position()[j];
  }
}

TEST_F(ServoModes, HandoverGoesOnWithTheSetpoint) {
  build(with(DriveMode::CyclicSyncPosition));
  engage();
  command.setpoint.position[0] = 0.4;
  cycle();
  const ServoHandover handover = loop->handover();
  build(with(DriveMode::CyclicSyncPosition));
  loop->engage(handover);
  for (int i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 2; ++j) command.setpoint.position[j] = loop->hold_position()[j];
    cycle();
    EXPECT_NEAR(sent_mm(), 0.4, 1e-9);
  }
}

TEST_F(ServoModes, JointIsNotFollowedInAnotherModeThanItsOwn) {
  build(with(DriveMode::CyclicSyncPosition));
  fake->drives[0].words.mode = DriveMode::CyclicSyncTorque;
  command.power = true;
  for (int i = 0; i < 20; ++i) cycle();
  EXPECT_FALSE(report.follows);
}

TEST_F(ServoModes, WhatDoesNotFitTogetherIsRefused) {
  ServoLoopParts law = with(DriveMode::CyclicSyncPosition);
  law.joints[0].law = laws[0];
  EXPECT_THAT(refusal_of(law), testing::HasSubstr("joint 0 has a servo law, but its drive closes the loop itself"));
  ServoLoopParts none = parts();
  none.joints[1].law = nullptr;
  EXPECT_THAT(refusal_of(none), testing::HasSubstr("joint 1 has no servo law, and its drive takes a torque"));
  ServoLoopParts gain = with(DriveMode::CyclicSyncVelocity);
  gain.actuators[0].position_gain = 0;
  EXPECT_THAT(refusal_of(gain), testing::HasSubstr("position gain of 0"));
  gain.actuators[0].position_gain = 501;
  EXPECT_THAT(refusal_of(gain), testing::HasSubstr("at most 500"));
  ServoLoopParts idle = with(DriveMode::CyclicSyncPosition);
  idle.actuators[0].position_gain = 20;
  EXPECT_THAT(refusal_of(idle), testing::HasSubstr("only a drive in cyclic synchronous velocity"));
  ServoLoopParts cogging = with(DriveMode::CyclicSyncPosition);
  cogging.actuators[0].cogging.harmonics = {{12, 0.01, 0}};
  EXPECT_THAT(refusal_of(cogging), testing::HasSubstr("has Cogging, and its drive follows positions or velocities"));
  ServoLoopParts strong = parts();
  strong.actuators[1].cogging.harmonics = {{12, 0.15, 0}, {60, 0, -0.11}};
  EXPECT_THAT(refusal_of(strong), testing::HasSubstr("actuator 1 has cogging of up to 0.26"));
  for (const int order : {0, 1001}) {
    strong.actuators[1].cogging.harmonics = {{order, 0.01, 0}};
    EXPECT_THAT(refusal_of(strong), testing::HasSubstr("periods a turn; there are 1 to 1000"));
  }
  strong.actuators[1].cogging.harmonics = {{12, 0, std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_THAT(refusal_of(strong), testing::HasSubstr("actuator 1 has cogging"));
  EXPECT_THAT(refusal_of(with(DriveMode::ProfileVelocity)), testing::HasSubstr("which no joint can be moved in"));
  ServoLoopParts mixed = with(DriveMode::CyclicSyncPosition, std::make_shared<DifferentialMap>());
  EXPECT_THAT(refusal_of(mixed), testing::HasSubstr("give them all the same kind of mode"));
}

}  // namespace
}  // namespace rmac::servo_test
