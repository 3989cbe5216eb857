#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "rmac/motion/force_control.hpp"
#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/pose.hpp"
#include "rmac/motion/servo/servo_fault.hpp"
#include "rmac/motion/servo/servo_inputs.hpp"

namespace rmac {

/// What one cycle found and did. Arrays count joints (held ones included) or actuators; mm, deg, s, N, N·m.
struct ServoReport {
  ServoState state = ServoState::Off;
  bool follows = false;  ///< the command's setpoint was used; where not, hold the follower at `hold_position()`
  ServoFault fault;
  std::array<double, kMaxJoints> position_set{}, velocity_set{}, acceleration_set{};
  std::array<double, kMaxJoints> position{}, velocity{};
  std::array<std::uint8_t, kMaxJoints> answer_delay{};  ///< so many cycles before was a joint at `position`
  /// Where it was wanted then, minus `position`: what its bound and its law are about.
  std::array<double, kMaxJoints> following_error{};
  /// Positions at the loads, whatever encoders say, for who judges the loop: it sees nothing of them. None where a
  /// drive does not tell (`DigitalControlInterface::tells_load`).
  std::optional<std::array<double, kMaxJoints>> truth;
  std::array<double, kMaxJoints> effort{};  ///< at the joint, as commanded
  std::array<double, kMaxJoints> force{};   ///< as the joint's force sensor measures it; 0 where there is none
  std::array<ContactState, kMaxJoints> contact{};
  std::array<std::uint16_t, kMaxJoints> statusword{};
  std::array<std::uint16_t, kMaxJoints> error_code{};
  std::array<std::int16_t, kMaxJoints> torque_permille{};  ///< measured by the drives
  std::array<double, kMaxJoints> ahead{};  ///< of its joint, where several motors move it side by side: mm or degrees
  std::array<std::int32_t, kMaxJoints> counts{};  ///< where the motors are, as the drives tell
  std::array<double, kMaxSpindles> spindle_rpm{};
  std::array<double, kMaxSpindles> spindle_torque_nm{};  ///< measured; 0 where the drive does not tell
  std::array<std::uint16_t, kMaxSpindles> spindle_statusword{};
  ToolPose pose;         ///< measured, part frame
  double feed_mm_s = 0;  ///< tool tip, from measured joints
  std::uint64_t inputs = 0;
  std::uint32_t homings = 0;         ///< that were completed
  std::uint32_t reference_lost = 0;  ///< bit j: joint j's position is not to be relied on before it found home again
  std::int64_t exchange_ns = 0;      ///< of the cycle's time, that the exchange with buses and I/O took
  ProbeReport probe;
};

}  // namespace rmac
