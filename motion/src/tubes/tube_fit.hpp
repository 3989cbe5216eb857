#pragma once

#include <memory>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "splines/line_spline.hpp"
#include "tubes/draft_law.hpp"
#include "tubes/faster_in_tube.hpp"

namespace rmac {

/// Coarse lines that become one spline.
struct TubeWindow {
  Polyline polyline;
  LineSpline before;  ///< what the spline goes on from, or an empty one
  double tolerance_mm = 0;
  std::vector<double> widths_mm;   ///< of the tube, about each line
  std::vector<LineLimits> limits;  ///< of each line; empty where the spline is not made faster
  std::vector<JointLimits> joints;
};

/// The spline along a window of coarse lines: the smoothest in the tube of the tolerance, and from it one that is
/// faster to travel (docs/derivations/joins.md, section 7). A part of it a step, for all of it takes longer than the
/// planner may be held up. Planner thread.
class TubeFit {
 public:
  enum class Progress { InWork, Found, None };

  explicit TubeFit(TubeWindow window);
  [[nodiscard]] Progress step();
  [[nodiscard]] const Polyline& polyline() const noexcept { return window_.polyline; }
  /// What was found.
  [[nodiscard]] const LineSpline& spline() const noexcept { return spline_; }

 private:
  [[nodiscard]] std::vector<double> inner_knots() const;
  [[nodiscard]] Progress smoothest();
  void make_faster();

  TubeWindow window_;
  LineSpline spline_;
  bool laid_ = false;  ///< its knots are
  int trials_ = 0;     ///< tubes, each narrower than the one before
  std::unique_ptr<FasterInTube> faster_;
};

}  // namespace rmac
