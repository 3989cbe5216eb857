#pragma once

#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"
#include "short_lines/line_merger.hpp"
#include "short_lines/turn_spline.hpp"
#include "splines/line_spline.hpp"
#include "tubes/tube_fit.hpp"

namespace rmac {

/// Recognises runs of short lines as the smooth curve they came from: a quintic spline within the tolerance of every
/// line, found by least squares where the lines are dense, or as the smoothest in the tube of the tolerance where they
/// are coarse (docs/derivations/joins.md, sections 6 and 7), with a spline of the rotary joints where the tool axis
/// turns (section 8). Streams: a run is fitted in windows, each going on smoothly from the one before. What is no such
/// run passes unchanged, in order. Planner thread.
class LineFit {
 public:
  using SegmentQueue = std::deque<std::shared_ptr<const PathSegment>>;

  explicit LineFit(std::vector<JointLimits> joints) : joints_(std::move(joints)) {}

  void add(std::shared_ptr<const PathSegment> segment) { merger_.add(std::move(segment), joints_, waiting_); }
  void clear();
  [[nodiscard]] bool empty() const noexcept { return waiting_.empty() && merger_.empty(); }
  /// Lines that were too short for a place of their own, and became part of another.
  [[nodiscard]] std::uint64_t merged() const noexcept { return merger_.count(); }
  /// `advance` would do something without waiting for more lines.
  [[nodiscard]] bool ready() const noexcept {
    return tube_ || (!waiting_.empty() && (complete() || checked_ > window_));
  }
  /// Appends the next segments, or goes on with the fit that they take; `finish`: the run ends with what is there.
  void advance(bool finish, SegmentQueue& out);
  /// Parts of fits that were done: one is enough for a step of the planner.
  [[nodiscard]] std::uint64_t work() const noexcept { return work_; }

 private:
  /// The window of coarse lines, and how many of these at its end are fitted again with what follows; more would hold
  /// the planner up for longer.
  static constexpr std::size_t kTubeLines = 60, kTubeOverlap = 24;
  /// The window of dense lines: this long, but as many as that at least, and so many at most. A third of it is fitted
  /// again with what follows.
  static constexpr double kWindow_mm = 24;
  static constexpr std::size_t kMostLines = 2400;
  static constexpr std::size_t kShortest = 6;  ///< lines that are worth a fit
  /// Where no spline follows a window, a corner ends the run, and what is left of it is tried again, so often.
  static constexpr int kMostCorners = 3;
  static constexpr std::size_t kBeforeCoarse = 3;  ///< lines between a dense fit and one that is too coarse
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  /// A spline along the waiting lines, and the path that it makes.
  struct Fit {
    Polyline polyline;
    LineSpline spline;
    LineSpline turns;                         ///< of the rotary joints; empty where the tool axis stays
    PathSegments heads;                       ///< final
    std::shared_ptr<const PathSegment> tail;  ///< to the end of the last line; what follows may find a better way
    std::size_t cut = 0;                      ///< knot between the two
    double cut_mm = 0;                        ///< length of the heads
    std::vector<OverPole> overs;              ///< by the length of the tip's path
  };

  [[nodiscard]] bool complete() const noexcept;
  /// Lines at the front that belong together: up to one more than the window.
  [[nodiscard]] std::size_t run_length() const noexcept;
  void count_line() const noexcept;
  [[nodiscard]] bool goes_on() const noexcept { return before_.tail != nullptr; }
  [[nodiscard]] Polyline polyline(std::size_t lines) const;
  /// Whether a fit was found; false too where one is in work now.
  [[nodiscard]] bool fit(bool finish, Fit& fit);
  /// Lines of the run to try a dense fit of: the window, or less before lines that were too coarse for one.
  [[nodiscard]] std::size_t dense_lines(std::size_t run) const noexcept;
  [[nodiscard]] bool fit_dense(std::size_t lines, bool ends, Fit& fit);
  void begin_tube(std::size_t lines, bool ends);
  /// What `tube_` has found.
  [[nodiscard]] bool take_tube(Fit& fit);
  /// The first lines, or what goes on from before, turn the tool axis.
  [[nodiscard]] bool turns(std::size_t lines) const;
  /// Puts the rotary joints' spline along the tip's path into its pieces.
  [[nodiscard]] bool turn(TipPath& tip, bool ends, Fit& fit) const;
  /// Cuts it at these knots, and before this place into head and tail unless it `ends`.
  [[nodiscard]] bool make_segments(std::vector<std::size_t> cuts, double tail, bool ends, Fit& fit) const;
  [[nodiscard]] std::shared_ptr<const PathSegment> segment(const Fit& fit, std::shared_ptr<const Curve> curve,
                                                           double from, double to) const;
  /// The run ends where it turns most, near the lines that were too coarse, as at a corner that was meant. False where
  /// that was tried often enough.
  [[nodiscard]] bool end_at_corner() noexcept;
  void take(Fit fit, SegmentQueue& out);
  void drop_lines(std::size_t count);

  /// A fit of coarse lines at the front that is in work.
  struct Tube {
    TubeFit fit;
    bool ends = false;
  };

  std::vector<JointLimits> joints_;
  LineMerger merger_;
  SegmentQueue waiting_;
  mutable std::size_t checked_ = 0;          ///< lines at the front of `waiting_` known to belong together
  mutable double checked_mm_ = 0;            ///< their length
  mutable std::size_t window_ = kMostLines;  ///< lines that fill the window, once so many are there
  std::size_t coarse_ = kNone;               ///< the first line that was found too coarse for a dense fit
  std::size_t corner_ = kNone;               ///< lines at the front, behind which a corner ends the run
  int corners_made_ = 0;                     ///< since a spline was found, or lines were given up
  int given_up_ = 0;                         ///< how often lines were, since a spline was found
  bool begins_at_join_ = false;              ///< something was given out that the first waiting line meets
  /// The window before: what its spline leaves, and its tail.
  Fit before_;
  std::optional<Tube> tube_;
  std::uint64_t work_ = 0;
};

}  // namespace rmac
