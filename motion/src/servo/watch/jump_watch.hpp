#pragma once

#include <cstdint>
#include <optional>

#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"

namespace rmac {

/// What it looks at in one cycle: mm or degrees.
struct JumpSeen {
  double jump = 0;               ///< change of the position's step; 0 where it is not known
  std::optional<double> step{};  ///< since the cycle before, where drives answered in both and no cycle was late
  bool may_stop = false;         ///< it is no faster than a moment before
  bool trembles = false;         ///< its effort turns round again and again
  bool shakes = false;           ///< by half of all that it may be
  bool refused = false;          ///< its reading was not believed
};

/// Finds a position that jumps within a cycle. What meets something hard, or swings with all its effort, changes its
/// speed within a cycle as well, but is no faster then; a reading that jumped goes on as before, in the cycle behind or
/// some later. Real-time safe.
class JumpWatch {
 public:
  /// `joint` must outlive it; `index` names it in faults.
  JumpWatch(const ServoJoint& joint, std::uint32_t index) noexcept : joint_(&joint), index_(index) {}

  void step(const JumpSeen& seen, FaultSink& faults) noexcept;
  /// Its position jumped, or may have: that is told apart from a stop within some cycles.
  [[nodiscard]] bool doubts() const noexcept { return jumped_ || suspicion_; }
  /// The joint is not under control.
  void rest() noexcept {
    jumped_ = false;
    suspicion_.reset();
    steady_ = true;
  }

 private:
  /// A jump that may have been a stop.
  struct Suspicion {
    double jump = 0;
    double step_before = 0;
    int steps_left = 0;  ///< in which it may be found to be none
  };
  void raise(double jump, FaultSink& faults) noexcept;
  void look_again(double step, FaultSink& faults) noexcept;

  const ServoJoint* joint_;
  std::uint32_t index_;
  std::optional<Suspicion> suspicion_{};
  bool jumped_ = false;
  bool steady_ = true;  ///< there was no jump of half the bound in the cycle before
};

}  // namespace rmac
