#pragma once

#include <cstddef>
#include <optional>

#include "rmac/motion/force_control.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/watch/cycles_beyond.hpp"
#include "servo/watch/jump_watch.hpp"
#include "servo/watch/oscillation_watch.hpp"
#include "servo/watch/response_watch.hpp"

namespace rmac {

/// What the watch over a joint looks at in one cycle: mm or degrees and s, N or N·m.
struct JointSeen {
  JumpSeen position{};
  bool answered = true;        ///< its drives did in this cycle
  double velocity = 0;         ///< measured
  double following_error = 0;  ///< of the cycle in which the drives were where they say
  double position_set = 0, velocity_set = 0;
  double force = 0;  ///< measured
  ContactState contact = ContactState::None;
  double searched = 0;       ///< way without contact
  bool force_hangs = false;  ///< it stays the same, however the joint is pushed
  double commanded = 0;      ///< effort that its loop asks for
  bool bounces = false;      ///< off the part that it comes upon: it swings, and its loop does not
  OscillationSeen loop{};
};

/// Watches one joint under control. Real-time safe.
class JointWatch {
 public:
  /// `joint` must outlive it; `index` names it in faults.
  JointWatch(const ServoJoint& joint, std::size_t index, double period_s) noexcept
      : joint_(&joint),
        index_(static_cast<std::uint32_t>(index)),
        jumps_(joint, index_),
        oscillation_(joint, index, period_s),
        response_(joint, index, period_s) {}

  void step(const JointSeen& seen, FaultSink& faults) noexcept;
  [[nodiscard]] bool doubts_position() const noexcept { return jumps_.doubts(); }
  /// The joint is not under control; `position`: where its encoder has it meanwhile, where it tells that.
  void rest(std::optional<double> position = std::nullopt) noexcept {
    too_fast_.restart();
    jumps_.rest();
    oscillation_.rest();
    response_.rest(position);
  }

 private:
  /// Who swings more and more changes its speed by more than it may, and with all its effort becomes faster than is
  /// believed. A reading that jumps makes a joint swing afterwards.
  [[nodiscard]] bool comes_of_swing(const JumpSeen& jump) const noexcept;
  void watch_sensor(FaultSink& faults) const noexcept;
  void watch_contact(const JointSeen& seen, FaultSink& faults) const noexcept;
  void raise(ServoFault::Kind kind, double value, double bound, FaultSink& faults) const noexcept;

  const ServoJoint* joint_;
  std::uint32_t index_;
  CyclesBeyond too_fast_;
  JumpWatch jumps_;
  OscillationWatch oscillation_;
  ResponseWatch response_;
};

}  // namespace rmac
