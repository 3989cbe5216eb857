#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "gateway/state/cycle_state.hpp"
#include "rmac/motion/follower/horizon.hpp"
#include "rmac/motion/force_control.hpp"
#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/pose.hpp"
#include "rmac/motion/servo/servo_fault.hpp"
#include "rmac/motion/servo/servo_inputs.hpp"

namespace rmac::gateway {

/// Everything one servo cycle left behind, as the servo thread writes it and every other thread reads it. Plain data.
/// Joints 0 to joint_count-1 are the mechanism's; those that it holds follow. Actuators count by themselves: a joint
/// may have several. mm, deg, s, N, N·m; feed in mm/s.
struct CycleSample {
  std::int64_t cycle = 0;
  double t_s = 0;
  std::uint32_t joint_count = 0;
  std::uint32_t joint_count_with_held = 0;
  std::uint32_t actuator_count = 0;
  CycleState state = CycleState::Idle;
  ServoState servo_state = ServoState::Off;
  bool moving = false;
  ServoFault fault;  ///< that the servo loop is in, from the cycle on in which it was found
  std::int64_t move_id = 0;
  double s_mm = 0;
  double feed_set_mm_s = 0;     ///< path speed of the setpoint
  double feed_actual_mm_s = 0;  ///< tool tip, from measured joints through the forward kinematics
  Horizon horizon;              ///< none while the joints follow no plan
  ToolPose pose_set;            ///< part frame
  ToolPose pose_actual;         ///< part frame
  std::array<double, kMaxJoints> position_set{}, velocity_set{}, acceleration_set{};
  std::array<double, kMaxJoints> position{}, velocity{}, effort{};
  std::array<std::uint8_t, kMaxJoints> answer_delay{};       ///< so many cycles before was a joint at `position`
  std::array<double, kMaxJoints> following_error{};          ///< where it was wanted then, minus `position`
  std::optional<std::array<double, kMaxJoints>> truth;       ///< where joints really are; simulated axes alone tell it
  std::array<double, kMaxJoints> force{};                    ///< as force sensors measure it; 0 where there is none
  std::array<ContactState, kMaxJoints> contact{};            ///< what joints under force control touch
  std::array<std::uint16_t, kMaxJoints> statusword{};        ///< one an actuator, as all that drives tell
  std::array<std::uint16_t, kMaxJoints> error_code{};        ///< CiA 402's 603Fh
  std::array<std::int16_t, kMaxJoints> torque_permille{};    ///< measured, of the rated torque
  std::array<double, kMaxJoints> ahead{};                    ///< how far the motor is ahead of its joint, mm or degrees
  std::array<std::int32_t, kMaxJoints> counts{};             ///< 6064h: where the motor is
  std::array<double, 4> spindle_rpm{}, spindle_torque_nm{};  ///< measured
  std::uint64_t inputs = 0, outputs = 0;
  ProbeReport probe;
  std::uint64_t moves_done = 0;  ///< since the mechanism went in
  std::uint64_t deadline_misses = 0;
  std::uint64_t samples_lost = 0;  ///< cycles that no listener heard of because the gateway was too slow
};

}  // namespace rmac::gateway
