#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "joins/tube_spline.hpp"
#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// Recognises runs of short lines as the smooth curve they came from: a quintic spline within the tolerance of every
/// line, found by least squares where the lines are dense, or as the smoothest in the tube of the tolerance where they
/// are coarse (docs/derivations/joins.md, sections 6 and 7). Streams: a run is fitted in windows, each going on
/// smoothly from the one before. What is no such run passes unchanged, in order. Planner thread.
class LineFit {
 public:
  using SegmentQueue = std::deque<std::shared_ptr<const PathSegment>>;

  explicit LineFit(std::vector<JointLimits> joints) : joints_(std::move(joints)) {}

  void add(std::shared_ptr<const PathSegment> segment) { waiting_.push_back(std::move(segment)); }
  void clear();
  [[nodiscard]] bool empty() const noexcept { return waiting_.empty(); }
  /// `advance` would give something without waiting for more lines.
  [[nodiscard]] bool ready() const noexcept {
    return !waiting_.empty() && (complete() || waiting_.size() > kDense.lines);
  }
  /// Appends the next segments; `finish`: the run ends with what is there.
  void advance(bool finish, SegmentQueue& out);

 private:
  /// Lines in one fit, and how many of these at its end are fitted again with what follows.
  struct Window {
    std::size_t lines, overlap;
  };
  static constexpr Window kDense{240, 60};
  static constexpr Window kTube{60, 24};       ///< more would hold the planner up for longer
  static constexpr std::size_t kShortest = 6;  ///< lines that are worth a fit

  /// A spline by chord length, counted from the start of the first waiting line, and the path that it makes.
  struct Fit {
    Polyline polyline;
    std::vector<double> knots;
    std::vector<Vector> points;
    std::vector<double> deviations_mm;        ///< bound of its distance from each line
    PathSegments heads;                       ///< final
    std::shared_ptr<const PathSegment> tail;  ///< to the end of the last line; what follows may find a better way
    std::size_t cut = 0;                      ///< knot between the two
    bool coarser_failed = false;              ///< wider spaced knots were tried in vain
  };

  [[nodiscard]] bool complete() const noexcept;
  [[nodiscard]] std::size_t run_length() const noexcept;
  [[nodiscard]] bool goes_on() const noexcept { return before_.tail != nullptr; }
  /// Parameter on the first waiting line where the spline begins.
  [[nodiscard]] double begin() const noexcept;
  [[nodiscard]] Polyline polyline(std::size_t lines) const;
  [[nodiscard]] bool fit(bool finish, Fit& fit) const;
  [[nodiscard]] bool fit_dense(std::size_t lines, bool ends, Fit& fit) const;
  [[nodiscard]] bool fit_tube(std::size_t lines, bool ends, Fit& fit) const;
  /// A spline in the tube becomes one that is faster to travel, where that is found.
  void make_faster(const std::vector<double>& widths, Fit& fit) const;
  [[nodiscard]] bool least_squares(double step, Fit& fit) const;
  /// The knots that the window before keeps, these, and the end's; false where there are too few.
  [[nodiscard]] bool set_knots(const std::vector<double>& inner, Fit& fit) const;
  [[nodiscard]] std::size_t kept_points() const noexcept;
  /// Cuts it at these knots, and at the last one into head and tail unless it `ends`.
  [[nodiscard]] bool make_segments(std::vector<std::size_t> cuts, std::size_t overlap, bool ends, Fit& fit) const;
  [[nodiscard]] std::shared_ptr<const PathSegment> segment(const Fit& fit, std::shared_ptr<const Curve> curve,
                                                           double from, double to) const;
  void take(Fit fit, SegmentQueue& out);
  void drop_lines(std::size_t count);

  std::vector<JointLimits> joints_;
  SegmentQueue waiting_;
  mutable std::size_t checked_ = 0;  ///< lines at the front of `waiting_` known to belong together
  /// The window before: its knots and control points from five before the cut on, and its tail.
  Fit before_;
  double step_ = 0;         ///< knot spacing that served last
  int no_coarser_for_ = 0;  ///< windows for which a wider one is not tried again
};

}  // namespace rmac
