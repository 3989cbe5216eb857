#pragma once

#include <cstdint>
#include <optional>

#include "rmac/motion/servo/servo_command.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/joints/wiring.hpp"

namespace rmac {

/// Which state the loop is in, why it stopped, and how it stops: what it is told and what is found wrong, made into
/// Off, Enabling, Engaged, Homing, QuickStop or Faulted. It moves nothing itself. Real-time safe.
class LoopState final : public FaultSink {
 public:
  /// Both must outlive it.
  LoopState(const ServoLoopParts& parts, const Wiring& wiring) noexcept : parts_(parts), wiring_(wiring) {}

  /// The first step of a cycle.
  void begin_cycle() noexcept { follows_ = false; }
  /// What is asked for in this cycle. `braked`: a stop that keeps power has come to its end.
  void obey(const ServoCommand& command, bool braked) noexcept;
  /// The drives are to leave their faults.
  [[nodiscard]] bool resetting() const noexcept { return resetting_; }
  /// While resetting: `stands`, the machine has stopped; `clear`, nothing asks for a stop any more.
  void finish_reset(bool stands, bool clear) noexcept;
  /// Enabling or engaged: `all_live`, joints and spindles are under control. A cycle passes between engaging and
  /// following, in which the follower is put at where the joints hold.
  void arrive(bool all_live) noexcept;
  /// Where there are no drives: the plan is followed whenever engaged.
  void arrive_without_drives() noexcept { follows_ = state_ == ServoState::Engaged; }
  /// Another loop left joints under control.
  void take_over() noexcept { enable(); }
  /// Homing is over: drives take their setpoints again, and each joint's loop engages where it finds its joint.
  void homing_is_over() noexcept { enable(); }
  /// One cycle of enabling has passed; the drives have taken longer for it than they may.
  [[nodiscard]] bool enables_too_long() noexcept;
  void raise(const ServoFault& found) noexcept override;
  /// A stop has begun since this was asked last: its course is to begin too.
  [[nodiscard]] bool take_new_stop() noexcept;

  [[nodiscard]] ServoState state() const noexcept { return state_; }
  [[nodiscard]] const ServoFault& fault() const noexcept { return fault_; }
  /// The plan's setpoint counts in this cycle.
  [[nodiscard]] bool follows() const noexcept { return follows_; }
  /// Joints are on their way to being engaged, or are; a stop is none of it.
  [[nodiscard]] bool driving() const noexcept {
    return state_ == ServoState::Enabling || state_ == ServoState::Engaged || state_ == ServoState::Homing;
  }
  /// A stop that keeps power, or what it ended in.
  [[nodiscard]] bool braking() const noexcept { return braking_; }
  /// Joints are under control: to follow, or to brake and hold.
  [[nodiscard]] bool powered() const noexcept { return driving() || braking_; }
  /// The others brake without this drive, which is silent: should it come back, it is not enabled again.
  [[nodiscard]] bool given_up(ServoFault::Part part, std::size_t index) const noexcept;
  /// The actuator whose drive is.
  [[nodiscard]] std::optional<std::size_t> actuator_given_up() const noexcept;

 private:
  void enable() noexcept;
  void leave_engaged(const ServoCommand& command) noexcept;
  [[nodiscard]] StopCategory stop_category(const ServoFault& found) const noexcept;
  [[nodiscard]] StopCategory chosen_category(const ServoFault& found) const noexcept;
  [[nodiscard]] bool can_do_without(const ServoFault& found) const noexcept;

  const ServoLoopParts& parts_;
  const Wiring& wiring_;
  ServoState state_ = ServoState::Off;
  ServoFault fault_;
  bool follows_ = false;
  bool braking_ = false;
  bool new_stop_ = false;
  bool power_spent_ = false;   ///< power must fall before it counts again
  bool reset_before_ = false;  ///< for its edge, as the next
  bool home_before_ = false;
  bool resetting_ = false;
  std::int64_t enabling_cycles_ = 0;
  std::int64_t resetting_cycles_ = 0;
};

}  // namespace rmac
