#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// Makes one line of a line shorter than half of its tolerance, which rounding and trimming leave in a program, and of
/// what follows it, until the two are that long: from where the first begins to where the last ends, no corner between
/// them further than half of the tolerance from it. Both ends are exact, so nothing accumulates. What is no such line
/// passes unchanged. Planner thread.
class LineMerger {
 public:
  using SegmentQueue = std::deque<std::shared_ptr<const PathSegment>>;

  /// Appends to `out` what this segment, and what waited for it, become; or it waits for the next one.
  void add(std::shared_ptr<const PathSegment> segment, const std::vector<JointLimits>& joints, SegmentQueue& out);
  /// Nothing follows: appends what waits.
  void flush(const std::vector<JointLimits>& joints, SegmentQueue& out);
  void clear() noexcept { chain_.clear(); }
  [[nodiscard]] bool empty() const noexcept { return chain_.empty(); }
  /// Lines that became part of another.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

 private:
  std::vector<std::shared_ptr<const PathSegment>> chain_;  ///< lines that ask for the same, together too short for one
  std::uint64_t count_ = 0;
};

}  // namespace rmac
