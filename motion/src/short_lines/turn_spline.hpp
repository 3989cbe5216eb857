#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"
#include "short_lines/dense_spline.hpp"
#include "splines/line_spline.hpp"

namespace rmac {

/// Where the rotary joints turn the tool as these kinematics do, and three slides bring the tip along: there joints can
/// be told apart from the tip's path.
[[nodiscard]] bool turns_lead(const Kinematics& kinematics);

/// The tip's path along a window of lines: curves end to end, the first of which begins at `from` of the polyline.
struct TipPath {
  std::vector<std::shared_ptr<const Curve>> pieces;
  std::vector<double> starts;  ///< path lengths at which they begin
  double length = 0;
  double from = 0;

  void add(std::shared_ptr<const Curve> piece);
  [[nodiscard]] Vector at(double s) const;
};

/// Rotary joints along the lines of a window, by the length of the tip's path.
struct TurningLines {
  Polyline joints;                    ///< what the programmed axes ask for at the lines' ends
  std::vector<SplineSample> samples;  ///< and on them
  std::vector<Vector> axes;           ///< programmed, at the samples, in the part frame
  std::vector<Vector> rates;          ///< |d(axis) / d(joint)| there, 1 for one that turns it all
  std::shared_ptr<const PoseToJoints> map;
};

/// Where the joints are led straight over the pole although the lines pass beside it.
struct OverPole {
  double place = 0;  ///< of the tip's path
  Vector beside{};   ///< from the pole to where the lines pass it
};

/// What is known of a window of lines before its joints are.
struct TurnWindow {
  std::span<const std::shared_ptr<const PathSegment>> lines;
  const Polyline& polyline;
  const TipPath& tip;
  std::span<const JointLimits> joints;
  const LineSpline& before;  ///< from which the joints' spline goes on; may be empty
};

/// What the lines ask of the rotary joints. `overs`: poles that were led over before, and then those that are now.
/// Nothing where the tip's path does not follow the lines in their order, or joints would have to jump.
[[nodiscard]] std::optional<TurningLines> turning_lines(const TurnWindow& window, std::vector<OverPole>& overs);

/// Where a joint turns the axis by a smaller part than this, the lines hardly know where it stands.
inline constexpr double kUnknownRate = 1e-3;

/// What a window of turning lines may do.
struct TurnBounds {
  double tolerance_rad = 0;
  double overlap_mm = 0;
  double start_corner_mm = 0, end_corner_mm = 0;  ///< as of `DenseLines`
  std::optional<double> knot_at = std::nullopt;   ///< where the window is cut
};

/// The rotary joints' spline that is as smooth as the tolerance of the tool axis lets it be (docs/derivations/joins.md,
/// section 8); it goes on from `before`. Its points have a coordinate for each rotary joint, in degrees, its parameter
/// is the length of the tip's path.
[[nodiscard]] std::optional<LineSpline> smoothest_turns(const TurningLines& lines, const TurnBounds& bounds,
                                                        const LineSpline& before);

/// What a spline of rotary joints that rest, as they do where a line begins, leaves to the next window.
[[nodiscard]] LineSpline resting_turns(const PathSegment& line);

}  // namespace rmac
