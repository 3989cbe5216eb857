#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "rmac/motion/force_control.hpp"
#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/move.hpp"
#include "rmac/motion/path_segment.hpp"
#include "rmac/motion/servo/servo_fault.hpp"
#include "rmac/motion/servo/servo_inputs.hpp"
#include "rmac/sdk/measuring.hpp"

namespace rmac::gateway {

enum class CycleState : std::uint8_t { Idle, Running, Holding, Stopping, Faulted, EmergencyStop };

[[nodiscard]] const char* to_string(CycleState state) noexcept;
/// Left by a reset alone.
[[nodiscard]] constexpr bool is_faulted(CycleState state) noexcept {
  return state == CycleState::Faulted || state == CycleState::EmergencyStop;
}

/// The cycle as the controller has it now; a sample is some cycles behind.
struct CycleNow {
  CycleState state = CycleState::Idle;
  const char* mode = "";  ///< Appendix IV's name of the mode of the cycle that is started; empty when none is
  double override_percent = 100;
};

/// Everything one servo cycle left behind, as the servo thread writes it and every other thread reads it. Plain data.
/// Joints 0 to joint_count-1 are the mechanism's; up to axis_count-1 follow the held ones. mm, deg, s, N, N·m; feed in
/// mm/s.
struct CycleSample {
  std::int64_t cycle = 0;
  double t_s = 0;
  std::uint32_t joint_count = 0;
  std::uint32_t axis_count = 0;
  std::uint32_t actuator_count = 0;
  CycleState state = CycleState::Idle;
  ServoState servo_state = ServoState::Off;
  bool moving = false;
  ServoFault fault;  ///< that the servo loop is in, from the cycle on in which it was found
  std::int64_t move_id = 0;
  double s_mm = 0;
  double feed_set_mm_s = 0;     ///< path speed of the setpoint
  double feed_actual_mm_s = 0;  ///< tool tip, from measured joints through the forward kinematics
  ToolPose pose_set;            ///< part frame
  ToolPose pose_actual;         ///< part frame
  std::array<double, kMaxJoints> position_set{}, velocity_set{}, acceleration_set{};
  std::array<double, kMaxJoints> position{}, velocity{}, effort{};
  std::array<double, kMaxJoints> force{};                    ///< as force sensors measure it; 0 where there is none
  std::array<ContactState, kMaxJoints> contact{};            ///< of joints under force control
  std::array<std::uint16_t, kMaxJoints> statusword{};        ///< one an actuator, as all that drives tell
  std::array<std::uint16_t, kMaxJoints> error_code{};        ///< CiA 402's 603Fh
  std::array<std::int16_t, kMaxJoints> torque_permille{};    ///< of the rated one, measured
  std::array<double, 4> spindle_rpm{}, spindle_torque_nm{};  ///< measured
  std::uint64_t inputs = 0, outputs = 0;
  ProbeReport probe;
  std::uint64_t moves_done = 0;  ///< since the mechanism went in
  std::uint64_t deadline_misses = 0;
  std::uint64_t samples_lost = 0;  ///< cycles that no listener heard of because the gateway was too slow
};

/// What happened, in order. Made off the servo thread from what its fault ring reports.
struct Event {
  enum class Kind : std::uint8_t {
    MoveStarted,
    MoveDone,
    Hit,
    Stopped,
    Fault,
    Authority,
    Mechanism,
    CycleStateChanged,
    FlightRecord,
    FlightRecordFailed,
    ToolWanted,
    ToolChanged,
    ToolChangeDropped
  };
  Kind kind = Kind::Stopped;
  double t_s = 0;
  std::int64_t move_id = 0;
  std::string message;               ///< for a person: what happened, where, what to do
  std::int64_t cycle = 0;            ///< in which it happened, or was noticed off the servo thread
  std::string record;                ///< name of the flight record that shows it; empty: none
  MinorCode code = MinorCode::None;  ///< the status that it leaves
  std::optional<sdk::Hit> hit{};     ///< of Kind::Hit
};

/// Hears of a move as it is queued, and of the curves it has become: none when there is nothing to move.
using QueueListener = std::function<void(const Move&, std::span<const std::shared_ptr<const PathSegment>>)>;

}  // namespace rmac::gateway
