#include "time_law/rest_end.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "time_law/speed_bound.hpp"

namespace rmac {
namespace {

/// Whether the joints can follow the stretch, which is asked at four instants of it; nothing where the path has no
/// joint values.
std::optional<bool> fits(const RestEnd& end, const PathView& path, const std::vector<JointLimits>& joints) {
  JointPoint point;
  // Mirrored at an end: t runs backwards, so speed and jerk keep their sign and the acceleration changes it (eq. 13).
  const double sign = end.direction;
  for (int i = 1; i <= 4; ++i) {
    const double t = end.time * i / 4;
    const double v = end.jerk * t * t / 2, a = end.jerk * t;
    const double s = end.s_rest + end.direction * end.jerk * t * t * t / 6;
    if (path.derivatives(s, end.direction, point) != KinematicsStatus::Ok) return std::nullopt;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const double jerk = point.d[3][j] * v * v * v + 3 * sign * point.d[2][j] * v * a + point.d[1][j] * end.jerk;
      const double acceleration = point.d[2][j] * v * v + sign * point.d[1][j] * a;
      const bool fit = std::abs(jerk) <= joints[j].max_jerk * kLawMargin &&
                       std::abs(acceleration) <= 0.5 * joints[j].max_acceleration;
      if (!fit) return false;
    }
  }
  return true;
}

}  // namespace

std::optional<RestEnd> rest_end(const PathView& path, const std::vector<JointLimits>& joints, double s_rest,
                                int direction, double longest, const FeedRule& feed) {
  JointPoint point;
  if (path.derivatives(s_rest, direction, point) != KinematicsStatus::Ok) return std::nullopt;
  const PathSegment& segment = path.segment(path.find(s_rest, direction));
  const PathDemand& demand = segment.demand();
  double jerk = std::numeric_limits<double>::infinity(),
         acceleration = or_unbounded(direction > 0 ? demand.accel_rise_mm_s2 : demand.accel_fall_mm_s2);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double d = std::max(std::abs(point.d[1][j]), 1e-12);
    jerk = std::min(jerk, joints[j].max_jerk * kLawMargin / d);
    acceleration = std::min(acceleration, joints[j].max_acceleration * kLawMargin / d);
  }
  const double speed = speed_bound(segment, point, joints, feed);
  RestEnd end;
  end.s_rest = s_rest;
  end.direction = direction;
  end.jerk = 0.97 * jerk;
  end.time =
      std::min({0.3 * acceleration / end.jerk, std::sqrt(0.2 * speed / end.jerk), std::cbrt(6 * longest / end.jerk)});
  for (int attempt = 0; attempt < 40; ++attempt, end.time *= 0.7, end.jerk = 0.9 * jerk) {
    end.length = end.jerk * end.time * end.time * end.time / 6;
    end.speed = end.jerk * end.time * end.time / 2;
    end.acceleration = end.jerk * end.time;
    const double room = s_rest + direction * end.length;
    if (path.find(room, -direction) != path.find(s_rest, direction)) continue;  // stay inside one segment
    const auto fitting = fits(end, path, joints);
    if (!fitting) return std::nullopt;
    if (*fitting) return end;
  }
  return std::nullopt;
}

}  // namespace rmac
