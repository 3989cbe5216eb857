#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// Recognises runs of short lines as the smooth curve they came from: a quintic spline within the tolerance of every
/// line (docs/derivations/joins.md, section 6). Streams: a run is fitted in windows, each going on smoothly from the
/// one before. What is no such run passes unchanged, in order. Planner thread.
class LineFit {
 public:
  using Segments = std::deque<std::shared_ptr<const PathSegment>>;

  explicit LineFit(std::vector<JointLimits> joints) : joints_(std::move(joints)) {}

  void add(std::shared_ptr<const PathSegment> segment) { waiting_.push_back(std::move(segment)); }
  void clear();
  [[nodiscard]] bool empty() const noexcept { return waiting_.empty(); }
  /// `advance` would give something without waiting for more lines.
  [[nodiscard]] bool ready() const noexcept { return !waiting_.empty() && (complete() || waiting_.size() > kWindow); }
  /// Appends the next segments; `finish`: the run ends with what is there.
  void advance(bool finish, Segments& out);

 private:
  static constexpr std::size_t kWindow = 240;  ///< lines in one fit
  static constexpr std::size_t kOverlap = 60;  ///< of which so many at its end are fitted again with what follows
  static constexpr std::size_t kShortest = 6;  ///< lines that are worth a fit
  static constexpr std::size_t kDegree = 5;

  /// A spline by chord length, counted from the start of the first waiting line, and the path that it makes.
  struct Fit {
    std::vector<double> knots;
    std::vector<Vector> points;
    std::vector<double> places;               ///< of the lines' ends, the first line's start in front
    std::shared_ptr<const PathSegment> head;  ///< final
    std::shared_ptr<const PathSegment> tail;  ///< to the end of the last line; what follows may find a better way
    std::size_t cut = 0;                      ///< knot between the two
    double deviation_mm = 0;                  ///< bound of its distance from the lines
  };

  [[nodiscard]] bool complete() const noexcept;
  [[nodiscard]] std::size_t run_length() const noexcept;
  [[nodiscard]] bool fit(std::size_t lines, bool ends, Fit& fit) const;
  [[nodiscard]] bool solve(const std::vector<Vector>& vertices, double step, Fit& fit) const;
  [[nodiscard]] bool make_segments(bool ends, Fit& fit) const;
  [[nodiscard]] std::shared_ptr<const PathSegment> segment(const Fit& fit, std::shared_ptr<const Curve> curve,
                                                           double from, double to) const;
  void take(Fit fit, Segments& out);
  void drop_lines(std::size_t count);

  std::vector<JointLimits> joints_;
  Segments waiting_;
  mutable std::size_t checked_ = 0;  ///< lines at the front of `waiting_` known to belong together
  /// The window before: its knots and control points from five before the cut on, and its tail.
  Fit before_;
  double step_ = 0;  ///< knot spacing that served last
};

}  // namespace rmac
