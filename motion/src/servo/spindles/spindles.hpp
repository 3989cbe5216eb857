#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rmac/motion/servo/servo_command.hpp"
#include "rmac/motion/servo/servo_report.hpp"
#include "rmac/motion/servo/servo_spindle.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/spindles/spindle_loop.hpp"
#include "servo/state/loop_state.hpp"

namespace rmac {

/// All spindles of the mechanism, cycle by cycle. Real-time safe but for its making.
class Spindles {
 public:
  /// Both must outlive it. What is found wrong is raised at `state`.
  Spindles(std::span<const ServoSpindle> spindles, double period_s, LoopState& state);

  /// Takes what the drives measured.
  void read() noexcept;
  void watch(const ServoCommand& command) noexcept;
  /// Speeds and torques of spindles whose drives operate; none without power. A stop that keeps power ends with
  /// spindles at rest too.
  void run(const ServoCommand& command) noexcept;
  /// The setpoints of one drive; its controlword is not theirs.
  void write(std::size_t spindle, DriveCommand& words) const noexcept { loops_[spindle].command(words); }
  void fill(ServoReport& report) const noexcept;

  [[nodiscard]] std::size_t size() const noexcept { return loops_.size(); }
  [[nodiscard]] const SpindleLoop& operator[](std::size_t spindle) const noexcept { return loops_[spindle]; }
  [[nodiscard]] const DriveFeedback& told(std::size_t spindle) const noexcept;

 private:
  [[nodiscard]] double wanted_rpm(std::size_t spindle, const ServoCommand& command) const noexcept;
  [[nodiscard]] bool operable(std::size_t spindle) const noexcept;
  void raise(ServoFault::Kind kind, std::size_t spindle, double value, double bound) noexcept;

  std::span<const ServoSpindle> spindles_;
  LoopState& state_;
  std::vector<SpindleLoop> loops_;
};

}  // namespace rmac
