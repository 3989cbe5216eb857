#include "rmac/fieldbus/simulated_interface.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <deque>
#include <map>

#include "conformance/control_interface_conformance.hpp"
#include "rmac/fieldbus/simulated_io_interface.hpp"

namespace {

using namespace rmac;
using namespace rmac::fieldbus;

class SimulatedBus : public testing::Test {
 protected:
  DriveState cycle(std::size_t axis, DriveWish wish, std::int16_t torque_permille = 0, bool reset = false) {
    DriveCommand& command = commands_[axis];
    command.controlword = next_controlword(feedback_[axis].statusword, wish, reset, command.controlword);
    command.mode = axis == kSpindle ? DriveMode::ProfileVelocity : DriveMode::CyclicSyncTorque;
    command.target_torque_permille = torque_permille;
    ok_ = bus_.exchange(commands_, feedback_);
    return drive_state(feedback_[axis].statusword);
  }
  void enable(std::size_t axis) {
    for (int i = 0; i < 20; ++i) cycle(axis, DriveWish::Operational);
    ASSERT_EQ(drive_state(feedback_[axis].statusword), DriveState::OperationEnabled);
  }

  static constexpr std::size_t kX = 0;
  static constexpr std::size_t kZ = 2;
  static constexpr std::size_t kSpindle = 3;
  SimulatedInterface bus_{default_simulated_axes(), 0.001};
  std::vector<DriveCommand> commands_ = std::vector<DriveCommand>(bus_.axis_count());
  std::vector<DriveFeedback> feedback_ = std::vector<DriveFeedback>(bus_.axis_count());
  bool ok_ = false;
};

TEST_F(SimulatedBus, ConformsToThePort) {
  conformance::ControlInterfaceConformance(bus_, kX).check();
}

/// Whatever speed is asked of its own loop, a drive turns its motor no faster than it may, either way.
TEST_F(SimulatedBus, TurnsNoMotorFasterThanItMayByItsOwnLoop) {
  const auto axes = default_simulated_axes();
  enable(kX);
  for (const int sign : {1, -1}) {
    std::int32_t before = 0;
    for (int i = 0; i < 600; ++i) {
      DriveCommand& command = commands_[kX];
      command.controlword =
          next_controlword(feedback_[kX].statusword, DriveWish::Operational, false, command.controlword);
      command.mode = DriveMode::CyclicSyncVelocity;
      command.target_velocity_rpm = sign * 20'000;
      before = feedback_[kX].position_counts;
      ASSERT_TRUE(bus_.exchange(commands_, feedback_));
    }
    const AxisPlantParameters parameters;
    const double rpm = (feedback_[kX].position_counts - before) / parameters.encoder.counts_per_revolution * 60 / 0.001;
    EXPECT_NEAR(rpm, sign * parameters.max_speed_rpm, 0.01 * parameters.max_speed_rpm);
  }
}

TEST_F(SimulatedBus, RefusesToStartWithoutAxes) {
  SimulatedInterface empty({}, 0.001);
  const auto started = empty.start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().message, "simulated bus: it has no axes; give it at least one");
}

TEST_F(SimulatedBus, ActsOnACommandFromTheNextSyncOn) {
  enable(kX);
  const std::int32_t start = feedback_[kX].position_counts;
  for (int i = 0; i < 2; ++i) {
    cycle(kX, DriveWish::Operational, 1000);
    EXPECT_EQ(bus_.plant(kX).angle_rad() > 0, i > 0);
    EXPECT_EQ(feedback_[kX].position_counts, start);
  }
  cycle(kX, DriveWish::Operational, 1000);
  EXPECT_GT(feedback_[kX].position_counts, start);
}

TEST_F(SimulatedBus, ActsOnACommandAtOnceWhereAnswersAreThoseOfTheCycleBefore) {
  bus_.set_answer_delay(1);
  enable(kX);
  cycle(kX, DriveWish::Operational, 1000);
  EXPECT_GT(bus_.plant(kX).angle_rad(), 0);
}

/// The parameter: cycles.
class SimulatedBusAnswersLate : public SimulatedBus, public testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Cycles, SimulatedBusAnswersLate, testing::Values(1, 3, kMostAnswerDelay));

TEST_P(SimulatedBusAnswersLate, AndTellsOfCyclesBefore) {
  SimulatedInterface late{default_simulated_axes(), 0.001};
  late.set_answer_delay(GetParam());
  EXPECT_EQ(late.answer_delay(kX), GetParam());
  std::vector<DriveFeedback> now(bus_.axis_count());
  // The other bus acts on its commands a cycle later.
  std::deque<DriveFeedback> before(static_cast<std::size_t>(GetParam() - 1));
  for (int i = 0; i < 50; ++i) {
    cycle(kX, DriveWish::Operational, i < 20 ? 1000 : -500);
    before.push_back(feedback_[kX]);
    // The same commands, whatever is told of them.
    ASSERT_TRUE(late.exchange(commands_, now));
    EXPECT_EQ(now[kX].online, i >= GetParam()) << i;
    if (i >= GetParam()) {
      EXPECT_EQ(now[kX].statusword, before.front().statusword) << i;
      EXPECT_EQ(now[kX].position_counts, before.front().position_counts) << i;
    }
    before.pop_front();
  }
  EXPECT_NE(feedback_[kX].position_counts, 0) << "it moved";
}

TEST_F(SimulatedBus, TellsNothingOfBeforeItWasStartedAgain) {
  bus_.set_answer_delay(1);
  ASSERT_TRUE(bus_.start());
  for (int i = 0; i < 20; ++i) cycle(kX, DriveWish::Operational);
  ASSERT_EQ(drive_state(feedback_[kX].statusword), DriveState::OperationEnabled);
  bus_.stop();
  ASSERT_TRUE(bus_.start());
  EXPECT_NE(cycle(kX, DriveWish::Off), DriveState::OperationEnabled);
  EXPECT_NE(cycle(kX, DriveWish::Off), DriveState::OperationEnabled);
}

TEST_F(SimulatedBus, CountsTheShaftInWholeEncoderCounts) {
  bus_.plant(kX).put_at(2 * M_PI * 1.5 / 131072);
  cycle(kX, DriveWish::Off);
  EXPECT_EQ(feedback_[kX].position_counts, 1);
  bus_.plant(kX).put_at(-2 * M_PI * 0.5 / 131072);
  cycle(kX, DriveWish::Off);
  EXPECT_EQ(feedback_[kX].position_counts, -1);
}

TEST_F(SimulatedBus, WrapsItsCountsAt32Bits) {
  bus_.plant(kX).put_at(2 * M_PI * (2147483648.0 + 10.5) / 131072);
  cycle(kX, DriveWish::Off);
  EXPECT_EQ(feedback_[kX].position_counts, -2147483648 + 10);
}

TEST_F(SimulatedBus, HoldsALoadedAxisByItsBrakeWhileDisabled) {
  for (int i = 0; i < 1000; ++i) cycle(kZ, DriveWish::Off);
  EXPECT_EQ(feedback_[kZ].position_counts, 0);
}

TEST_F(SimulatedBus, ReportsATripUntilItIsReset) {
  enable(kX);
  bus_.trip(kX, 0x2310);
  EXPECT_EQ(cycle(kX, DriveWish::Operational), DriveState::Fault);
  EXPECT_EQ(feedback_[kX].error_code, 0x2310);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(cycle(kX, DriveWish::Operational, 500), DriveState::Fault);
  for (int i = 0; i < 3; ++i) cycle(kX, DriveWish::Off, 0, true);
  EXPECT_EQ(drive_state(feedback_[kX].statusword), DriveState::SwitchOnDisabled);
  EXPECT_EQ(feedback_[kX].error_code, 0);
}

TEST_F(SimulatedBus, StopsADriveThatWasCutOff) {
  enable(kX);
  bus_.set_online(kX, false);
  cycle(kX, DriveWish::Operational, 500);
  EXPECT_TRUE(ok_);
  EXPECT_FALSE(feedback_[kX].online);
  bus_.set_online(kX, true);
  EXPECT_EQ(cycle(kX, DriveWish::Operational, 500), DriveState::Fault);
  EXPECT_EQ(feedback_[kX].error_code, 0x8130);
}

TEST_F(SimulatedBus, SaysWhenTheBusItselfFailed) {
  enable(kX);
  bus_.set_bus_failed(true);
  cycle(kX, DriveWish::Operational, 500);
  EXPECT_FALSE(ok_);
  bus_.set_bus_failed(false);
  EXPECT_EQ(cycle(kX, DriveWish::Operational, 500), DriveState::Fault);
  EXPECT_TRUE(ok_);
}

TEST_F(SimulatedBus, ShiftsAnEncoderWithoutMovingTheShaft) {
  bus_.shift_encoder(kX, 5000);
  cycle(kX, DriveWish::Off);
  EXPECT_EQ(feedback_[kX].position_counts, 5000);
  EXPECT_EQ(bus_.plant(kX).angle_rad(), 0);
}

TEST_F(SimulatedBus, TurnsTheSpindleByItsVelocityWordOnceEnabled) {
  commands_[kSpindle].target_velocity_rpm = 600;
  for (int i = 0; i < 100; ++i) cycle(kSpindle, DriveWish::Off);
  EXPECT_EQ(feedback_[kSpindle].velocity_rpm, 0);
  for (int i = 0; i < 1500; ++i) cycle(kSpindle, DriveWish::Operational);
  EXPECT_NEAR(feedback_[kSpindle].velocity_rpm, 600, 1);
}

TEST_F(SimulatedBus, HasAPlantWhereverItsDrivesAre) {
  EXPECT_EQ(bus_.axis_count(), 8U);
  EXPECT_EQ(bus_.spindle(kSpindle).speed_rpm(), 0);
}

TEST_F(SimulatedBus, FeelsThePartThatAnAxisPushesInto) {
  bus_.set_contact({.axis = kZ, .surface_mm = 1, .stiffness_n_mm = 500, .along = kX, .slope = 0.1});
  bus_.plant(kX).put_at(2 * M_PI);        // 5 mm: the surface is at 1.5
  bus_.plant(kZ).put_at(0.3 * 2 * M_PI);  // 1.5 mm
  cycle(kZ, DriveWish::Off);
  EXPECT_TRUE(feedback_[kZ].sensor_valid);
  EXPECT_NEAR(feedback_[kZ].sensor_counts, 0, 1);
  bus_.plant(kZ).put_at(0.29 * 2 * M_PI);  // 0.05 mm deeper: 25 N
  cycle(kZ, DriveWish::Off);
  EXPECT_NEAR(feedback_[kZ].sensor_counts, -2500, 1) << "it pushes towards smaller positions";
  bus_.plant(kZ).put_at(0.31 * 2 * M_PI);
  cycle(kZ, DriveWish::Off);
  EXPECT_EQ(feedback_[kZ].sensor_counts, 0) << "nothing pulls";
  bus_.set_sensor_lost(true);
  cycle(kZ, DriveWish::Off);
  EXPECT_FALSE(feedback_[kZ].sensor_valid);
}

TEST_F(SimulatedBus, LatchesWhereAnEdgeOfItsTouchProbeCame) {
  const double turn = 2 * M_PI;
  EXPECT_TRUE(bus_.latches(kX, TouchProbeEdge::FirstRising));
  EXPECT_FALSE(bus_.latches(kSpindle, TouchProbeEdge::FirstRising));
  bus_.touch(kX, TouchProbeEdge::FirstRising, turn);
  cycle(kX, DriveWish::Off);
  EXPECT_EQ(feedback_[kX].touch_probe, 0) << "nobody asked for it";
  commands_[kX].touch_probe = touch_probe::latch_once(TouchProbeEdge::FirstRising);
  for (int i = 0; i < 2; ++i) cycle(kX, DriveWish::Off);
  bus_.touch(kX, TouchProbeEdge::FirstFalling, 3 * turn);
  bus_.touch(kX, TouchProbeEdge::FirstRising, 1.5 * turn);
  bus_.touch(kX, TouchProbeEdge::FirstRising, 2 * turn);
  cycle(kX, DriveWish::Off);
  EXPECT_EQ(feedback_[kX].touch_probe, 3);
  EXPECT_EQ(feedback_[kX].latched_counts[0], 131072 * 3 / 2) << "the first edge";
  commands_[kX].touch_probe = 0;
  for (int i = 0; i < 3; ++i) cycle(kX, DriveWish::Off);
  EXPECT_EQ(feedback_[kX].touch_probe, 0);
  commands_[kX].touch_probe = touch_probe::latch_once(TouchProbeEdge::SecondFalling);
  for (int i = 0; i < 2; ++i) cycle(kX, DriveWish::Off);
  bus_.touch(kX, TouchProbeEdge::SecondFalling, -turn);
  cycle(kX, DriveWish::Off);
  EXPECT_EQ(feedback_[kX].touch_probe, 0x500);
  EXPECT_EQ(feedback_[kX].latched_counts[3], -131072);
}

TEST_F(SimulatedBus, KeepsALatchedPositionAsLongAsItsEdgeIsWantedAndNoLonger) {
  using enum TouchProbeEdge;
  constexpr std::array kOther{FirstFalling, FirstRising, SecondFalling, SecondRising};
  for (const TouchProbeEdge edge : {FirstRising, FirstFalling, SecondRising, SecondFalling}) {
    const TouchProbeEdge other = kOther.at(static_cast<std::size_t>(edge));
    commands_[kX].touch_probe = touch_probe::latch_once(edge) | touch_probe::latch_once(other);
    for (int i = 0; i < 3; ++i) cycle(kX, DriveWish::Off);
    bus_.touch(kX, edge, 1);
    for (int i = 0; i < 5; ++i) cycle(kX, DriveWish::Off);
    EXPECT_EQ(feedback_[kX].touch_probe, 1U << touch_probe::shift_of(edge) | touch_probe::latched(edge));
    commands_[kX].touch_probe = touch_probe::latch_once(other);
    for (int i = 0; i < 3; ++i) cycle(kX, DriveWish::Off);
    EXPECT_EQ(feedback_[kX].touch_probe, 1U << touch_probe::shift_of(edge)) << "it is on, and has nothing";
    commands_[kX].touch_probe = 0;
    for (int i = 0; i < 3; ++i) cycle(kX, DriveWish::Off);
    EXPECT_EQ(feedback_[kX].touch_probe, 0);
  }
}

TEST_F(SimulatedBus, TellsOfItsLimitSwitches) {
  AxisPlantParameters switched;
  switched.negative_switch_rad = -1;
  switched.positive_switch_rad = 2;
  SimulatedInterface bus({switched}, 0.001);
  std::vector<DriveCommand> commands(1);
  std::vector<DriveFeedback> feedback(1);
  const std::map<double, unsigned> on{{0.0, 0U},  {-0.99, 0U}, {-1.0, 1U}, {-1.01, 1U},
                                      {1.99, 0U}, {2.0, 2U},   {2.01, 2U}};
  for (const auto& [angle, inputs] : on) {
    bus.plant(0).put_at(angle);
    ASSERT_TRUE(bus.exchange(commands, feedback));
    EXPECT_EQ(feedback[0].inputs, inputs) << angle;
  }
  EXPECT_EQ(bus.input_bits(0), 3U);
}

TEST_F(SimulatedBus, QuickStopComesToRestUnderAHangingLoad) {
  enable(kZ);
  for (int i = 0; i < 50; ++i) cycle(kZ, DriveWish::Operational, -300);  // falling
  ASSERT_LT(bus_.plant(kZ).speed_rad_s(), -50);
  for (int i = 0; i < 1000; ++i) cycle(kZ, DriveWish::QuickStop);
  EXPECT_EQ(bus_.plant(kZ).speed_rad_s(), 0);
}

TEST_F(SimulatedBus, FreezesAnEncoderAndRunsAwayWhenToldTo) {
  enable(kX);
  bus_.freeze_encoder(kX, true);
  cycle(kX, DriveWish::Operational);
  const std::int32_t frozen = feedback_[kX].position_counts;
  bus_.run_away(kX, 0.2);
  for (int i = 0; i < 20; ++i) cycle(kX, DriveWish::Operational, 0);
  EXPECT_EQ(feedback_[kX].position_counts, frozen);
  EXPECT_GT(feedback_[kX].torque_permille, 500) << "nobody asked for it";
  EXPECT_GT(bus_.plant(kX).speed_rad_s(), 50);
  bus_.freeze_encoder(kX, false);
  cycle(kX, DriveWish::Operational);
  EXPECT_GT(feedback_[kX].position_counts, frozen);
}

TEST(SimulatedIo, PassesInputsInAndOutputsOut) {
  SimulatedIoInterface io;
  ASSERT_TRUE(io.start().has_value());
  io.set_inputs(0x5);
  std::uint64_t inputs = 0;
  EXPECT_TRUE(io.exchange(std::uint64_t{1} << 63, inputs));
  EXPECT_EQ(inputs, 0x5U);
  EXPECT_EQ(io.outputs(), std::uint64_t{1} << 63);
}

TEST(SimulatedIo, DropsItsOutputsWhenItFailsOrStops) {
  SimulatedIoInterface io;
  std::uint64_t inputs = 7;
  ASSERT_TRUE(io.exchange(0x3, inputs));
  io.set_failed(true);
  EXPECT_FALSE(io.exchange(0x3, inputs));
  EXPECT_EQ(io.outputs(), 0U);
  io.set_failed(false);
  ASSERT_TRUE(io.exchange(0x3, inputs));
  io.stop();
  EXPECT_EQ(io.outputs(), 0U);
}

}  // namespace
