#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "rmac/motion/drive_power.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac::conformance {

/// What every control interface must keep, with a drive in torque mode as axis `axis`: it starts disabled, ignores
/// torque until enabled, comes up by CiA 402's state machine, moves in the sense of its torque, brakes on a quick stop,
/// and is disabled by `stop`.
class ControlInterfaceConformance {
 public:
  ControlInterfaceConformance(DigitalControlInterface& bus, std::size_t axis)
      : bus_(bus), axis_(axis), commands_(bus.axis_count()), feedback_(bus.axis_count()) {}

  void check() {
    ASSERT_LT(axis_, bus_.axis_count());
    ASSERT_TRUE(bus_.start().has_value());
    check_disabled();
    if (!testing::Test::HasFailure()) check_enabled();
    if (!testing::Test::HasFailure()) check_quick_stop();
    if (!testing::Test::HasFailure()) check_stop();
  }

 private:
  DriveState cycle(DriveWish wish, std::int16_t torque_permille) {
    DriveCommand& command = commands_[axis_];
    command.controlword = next_controlword(feedback_[axis_].statusword, wish, false, command.controlword);
    command.mode = DriveMode::CyclicSyncTorque;
    command.target_torque_permille = torque_permille;
    EXPECT_TRUE(bus_.exchange(commands_, feedback_));
    EXPECT_TRUE(feedback_[axis_].online);
    return drive_state(feedback_[axis_].statusword);
  }
  [[nodiscard]] std::int32_t counts() const { return feedback_[axis_].position_counts; }

  void check_disabled() {
    cycle(DriveWish::Off, 0);
    const std::int32_t start = counts();
    for (int i = 0; i < 100; ++i) {
      EXPECT_NE(cycle(DriveWish::Off, 500), DriveState::OperationEnabled);
    }
    EXPECT_EQ(counts(), start) << "a disabled drive moved";
  }

  void check_enabled() {
    int cycles = 0;
    while (cycle(DriveWish::Operational, 0) != DriveState::OperationEnabled) {
      ASSERT_LT(++cycles, 5000) << "the drive does not come up";
    }
    const std::int32_t start = counts();
    for (int i = 0; i < 50; ++i) cycle(DriveWish::Operational, 500);
    EXPECT_GT(counts(), start) << "half the rated torque moves the axis towards positive counts";
  }

  void check_quick_stop() {
    int cycles = 0;
    while (cycle(DriveWish::QuickStop, 500) == DriveState::OperationEnabled) ASSERT_LT(++cycles, 10);
    for (int i = 0; i < 1000; ++i) cycle(DriveWish::QuickStop, 500);
    const std::int32_t start = counts();
    for (int i = 0; i < 100; ++i) cycle(DriveWish::QuickStop, 500);
    EXPECT_EQ(counts(), start) << "the axis moves a second after a quick stop";
  }

  void check_stop() {
    for (int i = 0; i < 100; ++i) cycle(DriveWish::Operational, 0);
    EXPECT_EQ(cycle(DriveWish::Operational, 0), DriveState::OperationEnabled) << "no way back from the quick stop";
    bus_.stop();
    commands_[axis_] = {};
    EXPECT_TRUE(bus_.exchange(commands_, feedback_));
    EXPECT_NE(drive_state(feedback_[axis_].statusword), DriveState::OperationEnabled);
  }

  DigitalControlInterface& bus_;
  std::size_t axis_;
  std::vector<DriveCommand> commands_;
  std::vector<DriveFeedback> feedback_;
};

}  // namespace rmac::conformance
