#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

namespace rmac::gateway {

/// How far joints were from where they were to be in one pass of a program, cycle by cycle, and where on its path that
/// was.
class Pass {
 public:
  /// One cycle, as a setpoint record has it.
  struct Row {
    std::int64_t cycle = 0, move_id = 0;
    double s_mm = 0;
    bool moving = false;
    std::span<const double> position_set;
    std::span<const double> following_error;  ///< as it is told in this cycle
  };
  /// A cycle in which the path was gone on.
  struct Step {
    std::size_t cycle = 0;  ///< of the pass
    std::int64_t move_id = 0;
    double s_mm = 0;
    double along_mm = 0;  ///< from the beginning of the first move
  };

  /// The following error of a joint that is told in a cycle is that of so many cycles before.
  explicit Pass(std::vector<int> answer_delays);

  void add(const Row& row);
  /// No cycle follows.
  void end();

  /// In order; standing still, and going back, is no step. Complete after `end`.
  [[nodiscard]] const std::vector<Step>& steps() const noexcept { return steps_; }
  [[nodiscard]] std::size_t joints() const noexcept { return delays_.size(); }
  /// Wanted minus measured, in a cycle of the pass; 0 where it is not known.
  [[nodiscard]] double error(std::size_t joint, std::size_t cycle) const noexcept {
    return cycle < errors_[joint].size() ? errors_[joint][cycle] : 0;
  }
  /// The joint moves in this cycle. What it does at rest is its friction's, and does not repeat.
  [[nodiscard]] bool moves(std::size_t joint, std::size_t cycle) const noexcept {
    return cycle < moves_[joint].size() && moves_[joint][cycle];
  }
  /// Root of the mean square, and the largest, of all steps in which the joint moves.
  [[nodiscard]] double rms(std::size_t joint) const;
  [[nodiscard]] double largest(std::size_t joint) const;
  /// Cycles that nobody told of: what was learned would be wrong.
  [[nodiscard]] std::int64_t missing() const noexcept { return missing_; }
  /// The path was retraced, or a move came twice.
  [[nodiscard]] bool went_back() const noexcept { return went_back_; }
  /// It ends where it began, so that it can be gone round again.
  [[nodiscard]] bool closed() const;

 private:
  void note_step(const Row& row);
  void lay_out();

  std::vector<int> delays_;
  std::vector<std::vector<double>> errors_;
  std::vector<std::vector<bool>> moves_;  ///< the setpoint, in each cycle
  std::vector<double> first_, last_;      ///< setpoints
  std::vector<Step> steps_;
  std::set<std::int64_t> passed_;  ///< moves that ended
  std::size_t cycles_ = 0;
  std::int64_t last_cycle_ = -1, missing_ = 0;
  bool went_back_ = false;
};

}  // namespace rmac::gateway
