#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/joints/index_set.hpp"
#include "servo/laws/effort_filter.hpp"

namespace rmac {

/// Servo laws of all joints with the filters behind them: what each joint is to be pushed with, in N or N·m. Real-time
/// safe but for its making, which gives each law its effort limit.
class JointLaws {
 public:
  /// `joints` must outlive it.
  JointLaws(std::span<const ServoJoint> joints, double period_s);

  /// Effort that holds the joint, as far as its law knows, within the joint's bound.
  [[nodiscard]] double resting_effort(std::size_t joint) const noexcept;
  /// The law goes on from this effort.
  void engage(std::size_t joint, const ServoInput& input, double from_effort) noexcept;

  /// A law beside a drive that closes the joint's loop itself: it begins anew, as it has nothing to go on from.
  void engage_beside(std::size_t joint, double from_effort) noexcept;

  /// One cycle of a joint under control. False when its law gives no number, which is a fault: then no joint has an
  /// effort. `beside`: what is added to the law's, where that is not all; where that begins or ends, the law goes on
  /// from the effort there is.
  [[nodiscard]] bool run(std::size_t joint, const ServoInput& input, std::optional<double> beside,
                         FaultSink& faults) noexcept;
  /// A joint whose drive is about to be enabled: it acts on the torque beside the word that enables it, before any
  /// position of it could be controlled.
  void rest(std::size_t joint) noexcept { effort_[joint] = resting_effort(joint); }
  void let_go(std::size_t joint) noexcept { effort_[joint] = 0; }
  void let_go() noexcept { effort_.fill(0); }
  /// As another loop left it.
  void take_over(std::size_t joint, double effort) noexcept { effort_[joint] = effort; }

  [[nodiscard]] bool has_law(std::size_t joint) const noexcept { return joints_[joint].law != nullptr; }
  [[nodiscard]] const std::array<double, kMaxJoints>& effort() const noexcept { return effort_; }

 private:
  std::span<const ServoJoint> joints_;
  std::vector<EffortFilter> filters_;
  IndexSet pushed_ = 0;  ///< joints whose law was not all in the cycle before
  std::array<double, kMaxJoints> effort_{};
};

}  // namespace rmac
