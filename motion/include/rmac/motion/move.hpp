#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "rmac/motion/nurbs.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac {

/// Straight line of the tool tip in the part frame; the axis turns on the great circle in step with the arc length.
struct LineGeometry {
  ToolPose start, end;
};

/// Circular arc about an axis, and where its end differs from its start in height along the axis, a helix of even
/// pitch. `closed` makes a full circle, whose end is its start, seen along the axis; `turns` whole turns are added;
/// `rotation` is +1 counter-clockwise about `normal`, -1 clockwise. Start and end may differ in radius about the axis
/// by 3 µm, or half of the tolerance, and a millionth of the radius.
struct ArcGeometry {
  static constexpr int kMostTurns = 1000;

  Vector center{};
  Vector normal{0, 0, 1};
  int rotation = 1;
  bool closed = false;
  ToolPose start, end;
  int turns = 0;
};

/// Circular arc from start through a point to the end.
struct Arc3Geometry {
  Vector via{};
  ToolPose start, end;
};

enum class NurbsSpace { Tip, Pose, Joint };

/// Tip: 3 coordinates, the tool axis stays as it is. Pose: x y z i j k, the axis normalised at evaluation. Joint: one a
/// joint.
struct NurbsGeometry {
  NurbsSpace space = NurbsSpace::Tip;
  Nurbs curve;
};

/// Positioning on a line of the tool tip from wherever the queue ends; starts and ends at rest.
struct PathTargetGeometry {
  ToolPose target;
};

/// Positioning of all joints together; starts and ends at rest.
struct JointTargetGeometry {
  std::vector<double> joints;
};

using Geometry =
    std::variant<LineGeometry, ArcGeometry, Arc3Geometry, NurbsGeometry, PathTargetGeometry, JointTargetGeometry>;

/// Whether a move goes along the joints instead of the tool; its speed follows from the joints' then.
[[nodiscard]] inline bool is_joint_move(const Geometry& geometry) noexcept {
  const auto* nurbs = std::get_if<NurbsGeometry>(&geometry);
  return std::holds_alternative<JointTargetGeometry>(geometry) ||
         (nurbs != nullptr && nurbs->space == NurbsSpace::Joint);
}

/// How far the tool axis may be from what was programmed, unless a move says otherwise.
inline constexpr double kOrientationTolerance_deg = 0.1;

/// One move with everything that was in force when it was queued.
struct Move {
  std::int64_t id = 0;      ///< the client's number
  Geometry geometry;        ///< in the part frame
  double feed_mm_s = 0;     ///< path feed; joint moves use `joint_speed_fraction`
  double tolerance_mm = 0;  ///< how far the corner before this move may be rounded; 0: exact stop
  /// How far the tool axis may turn from the programmed one there; 0: not at all.
  double orientation_tolerance_deg = kOrientationTolerance_deg;
  double accel_rise_mm_s2 = 0;      ///< path acceleration while the feed rises; 0: bounded by the joints alone
  double accel_fall_mm_s2 = 0;      ///< path acceleration while the feed falls; 0: bounded by the joints alone
  double joint_speed_fraction = 1;  ///< of each joint's speed limit, for joint moves
};

}  // namespace rmac
