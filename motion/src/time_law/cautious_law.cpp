#include <cmath>

#include "time_law/law_problem.hpp"
#include "time_law/window.hpp"

namespace rmac {
namespace {

struct ConstantBounds {
  double speed, acceleration, jerk;
};

/// Constant path bounds under which each of the three terms of a joint's jerk has a third of its limit, and each of the
/// two terms of its acceleration a half (docs/derivations/time-law.md, eq. 14).
ConstantBounds constant_bounds(const PathView& path, const std::vector<JointLimits>& joints, double s_begin,
                               double s_end, const FeedRule& feed) {
  ConstantBounds bounds{kInfinity, kInfinity, kInfinity};
  std::vector<double> d1(joints.size()), d2(joints.size()), d3(joints.size());
  JointPoint point;
  const auto take = [&](double s, int side) {
    if (s < s_begin || s > s_end || path.derivatives(s, side, point) != KinematicsStatus::Ok) return;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      d1[j] = std::max(d1[j], std::abs(point.d[1][j]));
      d2[j] = std::max(d2[j], std::abs(point.d[2][j]));
      d3[j] = std::max(d3[j], std::abs(point.d[3][j]));
    }
  };
  take(s_begin, 1);
  take(s_end, -1);
  for (std::size_t i = path.find(s_begin, 1); i <= path.find(s_end, -1); ++i) {
    const PathDemand& demand = path.segment(i).demand();
    bounds.speed = std::min(bounds.speed, feed.bound(path.segment(i)));
    if (demand.accel_rise_mm_s2 > 0) bounds.acceleration = std::min(bounds.acceleration, demand.accel_rise_mm_s2);
    if (demand.accel_fall_mm_s2 > 0) bounds.acceleration = std::min(bounds.acceleration, demand.accel_fall_mm_s2);
    const auto nodes = path.segment(i).nodes();
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      take(path.start(i) + nodes[k], k == 0 ? 1 : -1);
      if (k + 1 < nodes.size()) {
        take(path.start(i) + nodes[k], 1);
        for (const double part : {0.25, 0.5, 0.75})
          take(path.start(i) + nodes[k] + part * (nodes[k + 1] - nodes[k]), 1);
      }
    }
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    // A fifth is added to what was sampled, for what lies between the samples.
    const double x1 = std::max(1.2 * d1[j], 1e-12), x2 = 1.2 * d2[j], x3 = 1.2 * d3[j];
    const double jerk = joints[j].max_jerk / 3, acceleration = joints[j].max_acceleration / 2;
    bounds.speed = std::min(bounds.speed, joints[j].max_speed / x1);
    if (x2 > 0) bounds.speed = std::min(bounds.speed, std::sqrt(acceleration / x2));
    if (x3 > 0) bounds.speed = std::min(bounds.speed, std::cbrt(jerk / x3));
    bounds.acceleration = std::min(bounds.acceleration, acceleration / x1);
    bounds.jerk = std::min(bounds.jerk, jerk / x1);
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double x2 = 1.2 * d2[j];
    if (x2 > 0) bounds.acceleration = std::min(bounds.acceleration, joints[j].max_jerk / 3 / (3 * x2 * bounds.speed));
  }
  return bounds;
}

}  // namespace

std::vector<LawPiece> cautious_law(const PathView& path, const std::vector<JointLimits>& joints, double s_begin,
                                   double s_end, const FeedRule& feed) {
  ConstantBounds b = constant_bounds(path, joints, s_begin, s_end, feed);
  const double length = s_end - s_begin;
  // Largest speed whose two ramps fit into the length; the ramp's length grows with the speed.
  if (2 * ramp_length(b.speed, b.acceleration, b.jerk) > length) {
    double low = 0, high = b.speed;
    for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
      const double middle = 0.5 * (low + high);
      (2 * ramp_length(middle, b.acceleration, b.jerk) > length ? high : low) = middle;
    }
    b.speed = low;
  }
  const bool reaches_acceleration = b.speed * b.jerk >= b.acceleration * b.acceleration;
  const double t_jerk = reaches_acceleration ? b.acceleration / b.jerk : std::sqrt(b.speed / b.jerk);
  const double t_constant = reaches_acceleration ? b.speed / b.acceleration - t_jerk : 0;
  const double t_cruise = std::max(0.0, (length - 2 * ramp_length(b.speed, b.acceleration, b.jerk)) / b.speed);
  const double phases[7][2] = {{b.jerk, t_jerk},  {0, t_constant}, {-b.jerk, t_jerk}, {0, t_cruise},
                               {-b.jerk, t_jerk}, {0, t_constant}, {b.jerk, t_jerk}};
  std::vector<LawPiece> law;
  PathState state{s_begin, 0, 0};
  double t = 0;
  for (const auto& [jerk, duration] : phases) {
    if (duration <= 0) continue;
    law.push_back({t, state, jerk, duration, LawPiece::Kind::Jerk});
    state = law.back().at(duration);
    t += duration;
  }
  return law;
}

}  // namespace rmac
