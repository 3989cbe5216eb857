#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {

class ServoHandoverTest : public ServoLoopTest {
 protected:
  /// Replaces the loop between two cycles, as a mechanism swap does.
  void swap_for(std::shared_ptr<const ActuatorMap> map) {
    const ServoHandover handover = loop->handover();
    build(parts(std::move(map)));
    loop->engage(handover);
    for (std::size_t j = 0; j < 2; ++j) command.setpoint.position[j] = loop->hold_position()[j];
  }
  void expect_operational() const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(drive_state(fake->drives[axis].words.statusword), DriveState::OperationEnabled) << "axis " << axis;
    }
  }
};

TEST_F(ServoHandoverTest, KeepsDrivesOperationalWithTheirTorque) {
  build();
  put_at(0, 4);
  put_at(1, 5);
  engage();
  laws[0]->bias = 0.3;
  laws[2]->bias = -0.2;
  cycle();
  ASSERT_EQ(torque(0), 300);
  swap_for(std::make_shared<DirectMap>());
  for (int i = 0; i < 5; ++i) {
    cycle();
    expect_operational();
    EXPECT_EQ(torque(0), 300);
    EXPECT_EQ(torque(1), 0);
    EXPECT_EQ(torque(2), -200);
  }
  EXPECT_EQ(report.state, ServoState::Engaged);
  EXPECT_TRUE(report.follows);
  EXPECT_EQ(laws[0]->engaged, 1);
}

TEST_F(ServoHandoverTest, KeepsTheSetpointNotTheMeasuredPosition) {
  build();
  engage();
  command.setpoint.position[0] = 0.4;
  cycle();
  swap_for(std::make_shared<DirectMap>());
  cycle();
  EXPECT_NEAR(report.position_set[0], 0.4, 1e-12);
  EXPECT_EQ(torque(0), 40) << "the effort continues";
}

TEST_F(ServoHandoverTest, KeepsShaftsAndTorquesThroughAnotherMap) {
  build();
  put_at(0, 4);
  put_at(1, 2);
  put_at(2, 1);
  engage();
  laws[0]->bias = 0.3;
  laws[1]->bias = 0.1;
  cycle();
  swap_for(std::make_shared<DifferentialMap>());
  EXPECT_NEAR(loop->hold_position()[0], 3, 1e-9);
  EXPECT_NEAR(loop->hold_position()[1], 1, 1e-9);
  cycle(3);
  expect_operational();
  EXPECT_EQ(torque(0), 300);
  EXPECT_EQ(torque(1), 100);
  EXPECT_EQ(report.state, ServoState::Engaged);
}

TEST_F(ServoHandoverTest, KeepsCountingBeyondTheWrap) {
  build();
  for (int turn = 0; turn < 5; ++turn) {  // 5 mm a million counts at a time: past 2^31 in the end
    for (int i = 0; i < 1000; ++i) {
      put_at(0, (turn * 1000.0 + i) * 1000);
      cycle();
    }
  }
  const double before = report.position[0];
  ASSERT_GT(before, 2147483.648);
  swap_for(std::make_shared<DirectMap>());
  cycle();
  EXPECT_NEAR(report.position[0], before, 1e-6);
}

TEST_F(ServoHandoverTest, SwitchesOffDrivesThatTheNewLoopDoesNotHave) {
  build();
  engage();
  const ServoHandover handover = loop->handover();
  ServoLoopParts without_spindle = parts();
  without_spindle.spindles.clear();
  build(std::move(without_spindle));
  loop->engage(handover);
  cycle();
  EXPECT_EQ(fake->drives[3].command.controlword, 0);
  expect_operational();
}

TEST_F(ServoHandoverTest, EnablesDrivesThatTheOldLoopDidNotHave) {
  build();
  engage();
  const ServoHandover handover = loop->handover();
  ServoLoopParts with_more = parts();
  with_more.actuators[2].axis = 4;
  build(std::move(with_more));
  loop->engage(handover);
  cycle();
  EXPECT_EQ(report.state, ServoState::Enabling);
  EXPECT_EQ(drive_state(fake->drives[0].words.statusword), DriveState::OperationEnabled);
  for (std::size_t j = 0; j < 2; ++j) command.setpoint.position[j] = loop->hold_position()[j];
  cycle(10);
  EXPECT_EQ(report.state, ServoState::Engaged);
  EXPECT_EQ(drive_state(fake->drives[0].words.statusword), DriveState::OperationEnabled);
}

TEST_F(ServoHandoverTest, OfADriveThatDropsOutMeanwhileIsAFault) {
  build();
  engage();
  const ServoHandover handover = loop->handover();
  build();
  loop->engage(handover);
  fake->drives[1].words.online = false;
  cycle();
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::DriveOffline);
  EXPECT_EQ(report.fault.index, 1U);
}

TEST_F(ServoHandoverTest, OfALoopThatWasOffEnablesNothing) {
  build();
  put_at(0, 3);
  cycle(3);
  swap_for(std::make_shared<DirectMap>());
  cycle(3);
  EXPECT_EQ(report.state, ServoState::Off);
  EXPECT_EQ(bus->commands[0].controlword, 0);
}

TEST_F(ServoHandoverTest, IntoVirtualModeStartsWhereTheMachineStood) {
  build();
  put_at(0, 3);
  put_at(1, 4);
  engage();
  const ServoHandover handover = loop->handover();
  ServoLoopParts animated = parts();
  animated.virtual_mode = true;
  animated.virtual_start = {9, 9, 9};
  build(std::move(animated));
  loop->engage(handover);
  EXPECT_NEAR(loop->hold_position()[0], 3, 1e-9);
  EXPECT_NEAR(loop->hold_position()[1], 4, 1e-9);
}

}  // namespace rmac::servo_test
