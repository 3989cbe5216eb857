#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "joins/blend.hpp"
#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"
#include "short_lines/line_fit.hpp"

namespace rmac {

/// The stage between the moves as they were programmed and the path as it is travelled: runs of
/// short lines become the curves they came from, and corners are rounded, within tolerance (docs/derivations/joins.md).
/// It streams: how a segment ends is known only once the next one is there, so the last one is held back until then, or
/// until the machine would have to slow down for it. Planner thread.
class PathJoiner {
 public:
  explicit PathJoiner(std::vector<JointLimits> joints, double period_s);

  void add(std::shared_ptr<const PathSegment> segment) { lines_.add(std::move(segment)); }
  void clear();

  [[nodiscard]] std::uint64_t lines_merged() const noexcept { return lines_.merged(); }
  /// Nothing is held back or waits.
  [[nodiscard]] bool empty() const noexcept { return current_ == nullptr && incoming_.empty() && lines_.empty(); }
  /// Parts of fits of lines that were done: one is enough for a step of the planner.
  [[nodiscard]] std::uint64_t work() const noexcept { return lines_.work(); }
  /// `advance` has something to do.
  [[nodiscard]] bool ready() const noexcept;
  /// Appends the next piece of path for certain, or does a part of the work that it takes; call while `ready`.
  void advance(PathSegments& out);
  /// Appends a piece of what is held back without waiting for what follows: first the half that no join can touch, then
  /// the rest, to the exact end of the move. Where that takes work, `advance` goes on with it.
  void release(PathSegments& out);

 private:
  /// With what is in `incoming_`, or nothing follows.
  void go_on(PathSegments& out);
  void emit(double begin, double end, PathSegments& out);
  /// Lines that are next, too short for joins and meeting in corners, which a blend may pass over.
  [[nodiscard]] std::size_t lines_to_pass() const noexcept;
  /// All that is there is such lines: what comes behind them decides.
  [[nodiscard]] bool looks_further() const noexcept;
  /// With `incoming_[over]`, in place of what is before it.
  [[nodiscard]] Blend blend_over(std::size_t over) const;

  std::vector<JointLimits> joints_;
  double period_s_;
  LineFit lines_;
  std::deque<std::shared_ptr<const PathSegment>> incoming_;  ///< through with `lines_`
  std::shared_ptr<const PathSegment> current_;
  double begin_ = 0;  ///< up to here `current_` was given out, or replaced by a blend
};

}  // namespace rmac
