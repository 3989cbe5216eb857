#include "planner/stop_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "time_law/law_problem.hpp"
#include "time_law/window.hpp"

namespace rmac {
namespace {

constexpr double kStep_s = 1e-3;
/// Who takes longer to brake is judged on a line: where the path leaves hardly any braking, a speed next to nothing
/// would be followed without end.
constexpr int kMostBrakingSteps = 20'000;

/// What the joints allow at a place and speed.
struct Allowed {
  double least_acceleration = -std::numeric_limits<double>::infinity();
  double least_jerk = -std::numeric_limits<double>::infinity();
  double most_jerk = std::numeric_limits<double>::infinity();
};

Allowed allowed_at(const JointPoint& p, const std::vector<JointLimits>& joints, const PathState& at, double part) {
  Allowed allowed;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double share = std::abs(p.d[1][j]), sign = p.d[1][j] < 0 ? -1 : 1;
    if (share < 1e-6) continue;
    const double bend = sign * p.d[2][j] * at.v * at.v;
    const double most = part * joints[j].max_acceleration;
    allowed.least_acceleration = std::max(allowed.least_acceleration, (-most - bend) / share);
    // Joint jerk without what the path jerk adds (docs/derivations/time-law.md, eq. 3).
    const double turning = sign * (p.d[3][j] * at.v * at.v * at.v + 3 * p.d[2][j] * at.v * at.a);
    allowed.least_jerk = std::max(allowed.least_jerk, (-joints[j].max_jerk - turning) / share);
    allowed.most_jerk = std::min(allowed.most_jerk, (joints[j].max_jerk - turning) / share);
  }
  return allowed;
}

double braking_distance(const PathView& path, const std::vector<JointLimits>& joints, const PathState& from,
                        double part) {
  PathState at = from;
  JointPoint point;
  for (int step = 0; step < kMostBrakingSteps; ++step) {
    if (!(at.s < path.end()) || path.derivatives(at.s, 1, point) != KinematicsStatus::Ok) break;
    const Allowed allowed = allowed_at(point, joints, at, part);
    // The last ramp takes the acceleration back to zero just when the speed is zero.
    const double release = std::max(allowed.most_jerk, 1e-9);
    if (at.a < 0 && at.v <= at.a * at.a / (2 * release)) return at.s - from.s - at.v * at.v / (1.5 * at.a);
    if (!(at.v > 0)) return at.s - from.s;
    const double to_least = (allowed.least_acceleration - at.a) / kStep_s;
    const double jerk = std::max(allowed.least_jerk, std::min(to_least, allowed.most_jerk));
    at.s += kStep_s * (at.v + kStep_s * (at.a / 2 + kStep_s * jerk / 6));
    at.v += kStep_s * (at.a + kStep_s * jerk / 2);
    at.a += kStep_s * jerk;
  }
  return std::numeric_limits<double>::infinity();
}

/// As if the path went straight on.
double on_a_line(const PathView& path, const std::vector<JointLimits>& joints, const PathState& from) {
  JointPoint point;
  if (path.evaluate(from.s, 1, 1, point) != KinematicsStatus::Ok) return kInfinity;
  double acceleration = kInfinity, jerk = kInfinity;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double share = std::max(std::abs(point.d[1][j]), 1e-9);
    acceleration = std::min(acceleration, joints[j].max_acceleration / share);
    jerk = std::min(jerk, joints[j].max_jerk / share);
  }
  // First the acceleration has to be taken back to zero; then a ramp down.
  const double rising = std::max(from.a, 0.0), time = rising / jerk;
  return from.v * time + rising * time * time / 3 + ramp_length(from.v + 0.5 * rising * time, acceleration, jerk);
}

}  // namespace

double stop_distance(const PathView& path, const std::vector<JointLimits>& joints, const PathState& from) {
  // Who brakes as hard as he can may find no way through the next bend; with less there is one.
  for (const double part : {0.95, 0.7, 0.45, 0.2}) {
    const double distance = braking_distance(path, joints, from, part);
    if (std::isfinite(distance)) return distance;
  }
  return on_a_line(path, joints, from);
}

}  // namespace rmac
