#include <limits>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {

class ServoFaultTest : public ServoLoopTest {
 protected:
  void expect_fault(ServoFault::Kind kind, ServoFault::Part part, std::uint32_t index) {
    EXPECT_EQ(report.state, ServoState::Faulted);
    EXPECT_EQ(report.fault.kind, kind);
    EXPECT_EQ(report.fault.part, part);
    EXPECT_EQ(report.fault.index, index);
    EXPECT_FALSE(report.follows);
  }
};

TEST_F(ServoFaultTest, FollowingErrorNamesJointAmountAndBound) {
  build();
  engage();
  put_at(1, 1.01);
  cycle();
  expect_fault(ServoFault::Kind::FollowingError, ServoFault::Part::Joint, 1);
  EXPECT_NEAR(report.fault.value, -1.01, 1e-9);
  EXPECT_EQ(report.fault.bound, 1);
  expect_all_quick_stopped();
}

TEST_F(ServoFaultTest, HeldJointPushedAwayIsAFollowingError) {
  build();
  engage();
  put_at(2, 1.5);
  cycle();
  expect_fault(ServoFault::Kind::FollowingError, ServoFault::Part::Joint, 2);
}

TEST_F(ServoFaultTest, NanOfALawStopsEveryDriveInTheSameCycle) {
  build();
  engage();
  laws[1]->answer_nan = true;
  cycle();
  expect_fault(ServoFault::Kind::NotANumber, ServoFault::Part::Joint, 1);
  expect_all_quick_stopped();
}

TEST_F(ServoFaultTest, NanSetpointIsNeverFollowed) {
  build();
  engage();
  command.setpoint.velocity[0] = std::numeric_limits<double>::quiet_NaN();
  cycle();
  expect_fault(ServoFault::Kind::NotANumber, ServoFault::Part::Joint, 0);
  expect_all_quick_stopped();
}

TEST_F(ServoFaultTest, FaultOfOneDriveStopsAll) {
  build();
  engage();
  fake->drives[1].words.statusword = 0x08;
  fake->drives[1].words.error_code = 0x2310;
  cycle();
  expect_fault(ServoFault::Kind::DriveFault, ServoFault::Part::Actuator, 1);
  EXPECT_EQ(report.fault.value, 0x2310);
  EXPECT_EQ(bus->commands[0].controlword & controlword::kNoQuickStop, 0);
}

TEST_F(ServoFaultTest, SilentDriveStopsAll) {
  build();
  engage();
  fake->drives[2].words.online = false;
  cycle();
  expect_fault(ServoFault::Kind::DriveOffline, ServoFault::Part::Actuator, 2);
}

TEST_F(ServoFaultTest, DriveThatLeavesOperationByItselfStopsAll) {
  build();
  engage();
  fake->drives[0].stuck = true;
  fake->drives[0].words.statusword = 0x23;
  cycle();
  expect_fault(ServoFault::Kind::DriveDropped, ServoFault::Part::Actuator, 0);
  EXPECT_EQ(report.fault.value, 0x23);
}

TEST_F(ServoFaultTest, SpindleFaultStopsAll) {
  build();
  engage();
  fake->drives[3].words.statusword = 0x08;
  cycle();
  expect_fault(ServoFault::Kind::DriveFault, ServoFault::Part::Spindle, 0);
}

TEST_F(ServoFaultTest, BusFailureStopsAll) {
  build();
  engage();
  fake->works = false;
  cycle();
  expect_fault(ServoFault::Kind::BusFailure, ServoFault::Part::Bus, 0);
  expect_all_quick_stopped();
}

TEST_F(ServoFaultTest, BusThatSendsNoMoreStopsAllFromTheNextCycleOn) {
  build();
  engage();
  fake->sends = false;
  cycle();
  expect_fault(ServoFault::Kind::BusFailure, ServoFault::Part::Bus, 0);
  cycle();
  expect_all_quick_stopped();
}

TEST_F(ServoFaultTest, DriveThatDoesNotComeUpIsNamedAfterTheTimeOut) {
  build();
  fake->drives[1].stuck = true;
  fake->drives[1].words.statusword = 0x21;
  command.power = true;
  cycle(49);
  EXPECT_EQ(report.state, ServoState::Enabling);
  cycle(3);
  expect_fault(ServoFault::Kind::EnableTimeout, ServoFault::Part::Actuator, 1);
  EXPECT_EQ(report.fault.value, 0x21);
}

TEST_F(ServoFaultTest, FirstCauseStays) {
  build();
  engage();
  put_at(0, 2);
  cycle();
  fake->works = false;
  cycle(5);
  expect_fault(ServoFault::Kind::FollowingError, ServoFault::Part::Joint, 0);
}

TEST_F(ServoFaultTest, IsLeftByAResetAndFreshPowerOnly) {
  build();
  engage();
  fake->drives[1].words.statusword = 0x08;
  cycle(20);
  EXPECT_EQ(report.state, ServoState::Faulted);
  EXPECT_EQ(report.statusword[1], 0x08) << "the drive's fault was reset unasked";
  command.reset = true;
  cycle(5);
  EXPECT_EQ(report.state, ServoState::Off) << "power that was on all the time must not enable again";
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
  command.reset = false;
  command.power = false;
  cycle();
  engage();
}

TEST_F(ServoFaultTest, StaysWhileTheDrivesFaultStays) {
  build();
  engage();
  fake->drives[1].stuck = true;
  fake->drives[1].words.statusword = 0x08;
  cycle();
  command.reset = true;
  cycle(200);
  expect_fault(ServoFault::Kind::DriveFault, ServoFault::Part::Actuator, 1);
}

class HandheldIo : public DigitalIoInterface {
 public:
  [[nodiscard]] Expected<> start() override { return {}; }
  void stop() noexcept override {}
  [[nodiscard]] bool exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept override {
    seen = outputs;
    inputs = on;
    return works;
  }
  std::uint64_t seen = 0;
  std::uint64_t on = 0xA5;
  bool works = true;
};

TEST_F(ServoFaultTest, QuickStopAfterAnEarlierFaultBrakesTheDrivesAgain) {
  build();
  engage();
  fake->drives[1].words.statusword = 0x08;
  cycle();
  ASSERT_EQ(report.state, ServoState::Faulted);
  command.power = false;
  cycle(50);  // all stand, and have lost their power
  command.reset = true;
  cycle(3);
  command.reset = false;
  ASSERT_EQ(report.state, ServoState::Off);
  report.follows = false;
  engage();
  command.quick_stop = true;
  cycle();
  for (std::size_t axis = 0; axis < 4; ++axis) {
    EXPECT_EQ(bus->commands[axis].controlword, controlword::kEnableVoltage) << "axis " << axis << " is to brake";
  }
}

TEST_F(ServoFaultTest, IoIsExchangedAndItsFailureStopsAll) {
  const auto io = std::make_shared<HandheldIo>();
  ServoLoopParts with_io = parts();
  with_io.io = io;
  build(std::move(with_io));
  command.outputs = 0x11;
  engage();
  EXPECT_EQ(io->seen, 0x11U);
  EXPECT_EQ(report.inputs, 0xA5U);
  io->works = false;
  cycle();
  expect_fault(ServoFault::Kind::IoFailure, ServoFault::Part::Io, 0);
}

/// Bit 4 is an emergency stop, bit 9 a limit switch.
class ServoInputTest : public ServoFaultTest {
 protected:
  void SetUp() override {
    ServoLoopParts with_io = parts();
    with_io.io = io;
    with_io.emergency_stop_inputs = 1U << 4U;
    with_io.limit_inputs = 1U << 9U;
    io->on = 0;
    build(std::move(with_io));
  }
  void reset() {
    command.power = false;
    command.reset = true;
    cycle(2);
    command.reset = false;
    cycle();
  }
  std::shared_ptr<HandheldIo> io = std::make_shared<HandheldIo>();
};

TEST_F(ServoInputTest, EmergencyStopStopsAllInItsCycleAndIsNotResetBeforeItIsReleased) {
  engage();
  io->on = 1U << 4U;
  cycle();
  expect_fault(ServoFault::Kind::EmergencyStop, ServoFault::Part::Io, 4);
  expect_all_quick_stopped();
  reset();
  expect_fault(ServoFault::Kind::EmergencyStop, ServoFault::Part::Io, 4);
  cycle(100);  // until the loop has given that reset up
  io->on = 0;
  cycle(100);
  expect_fault(ServoFault::Kind::EmergencyStop, ServoFault::Part::Io, 4);
  reset();
  EXPECT_EQ(report.state, ServoState::Off);
  cycle(100);
  EXPECT_EQ(report.state, ServoState::Off) << "nothing is enabled by itself";
  engage();
}

TEST_F(ServoInputTest, EmergencyStopIsToldThoughTheMachineIsFaultedAlready) {
  engage();
  fake->works = false;
  cycle();
  expect_fault(ServoFault::Kind::BusFailure, ServoFault::Part::Bus, 0);
  io->on = 1U << 4U;
  cycle();
  expect_fault(ServoFault::Kind::EmergencyStop, ServoFault::Part::Io, 4);
}

TEST_F(ServoInputTest, NothingIsEnabledWhileTheEmergencyStopIsPressed) {
  io->on = 1U << 4U;
  command.power = true;
  for (int i = 0; i < 50; ++i) {
    cycle();
    EXPECT_EQ(report.state, ServoState::Faulted);
    for (std::size_t axis = 0; axis < 4; ++axis) {
      EXPECT_EQ(bus->commands[axis].controlword & controlword::kEnableOperation, 0);
    }
  }
}

TEST_F(ServoInputTest, LimitSwitchStopsAllAsItIsReachedAndLetsTheMachineMoveOffIt) {
  engage();
  io->on = 1U << 9U;
  cycle();
  expect_fault(ServoFault::Kind::LimitSwitch, ServoFault::Part::Io, 9);
  expect_all_quick_stopped();
  cycle(25);  // until the drives are seen to stand
  reset();
  EXPECT_EQ(report.state, ServoState::Off);
  engage();
  cycle(20);
  EXPECT_EQ(report.state, ServoState::Engaged) << "it is still closed";
  io->on = 0;
  cycle();
  io->on = 1U << 9U;
  cycle();
  expect_fault(ServoFault::Kind::LimitSwitch, ServoFault::Part::Io, 9);
}

TEST_F(ServoInputTest, OtherInputsStopNothing) {
  engage();
  io->on = ~(1ULL << 4U | 1ULL << 9U);
  cycle(20);
  EXPECT_EQ(report.state, ServoState::Engaged);
}

}  // namespace rmac::servo_test
