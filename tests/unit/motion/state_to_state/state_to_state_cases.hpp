#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "rmac/motion/state_to_state.hpp"

namespace rmac {

struct StateToStateCase {
  JointState from, to;
  MotionBounds bounds;
};

/// Bounds over two decades, distances that matter to them, states inside of the bounds and (one in five) outside.
inline StateToStateCase random_case(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto decades = [&](double low, double high) { return std::pow(10.0, uniform(low, high)); };
  StateToStateCase c;
  const bool symmetric = uniform(0, 1) < 0.5;
  c.bounds.max_velocity = decades(-1, 1);
  c.bounds.min_velocity = symmetric ? -c.bounds.max_velocity : -decades(-1, 1);
  c.bounds.max_acceleration = decades(-1, 1);
  c.bounds.min_acceleration = symmetric ? -c.bounds.max_acceleration : -decades(-1, 1);
  c.bounds.max_jerk = decades(-0.5, 1.5);
  const double reach = uniform(0, 1) < 0.2 ? 2 : 1;
  const auto state = [&] {
    JointState s{uniform(-1, 1) * decades(-2, 1), reach * uniform(c.bounds.min_velocity, c.bounds.max_velocity),
                 reach * uniform(c.bounds.min_acceleration, c.bounds.max_acceleration)};
    if (uniform(0, 1) < 0.15) s.acceleration = 0;
    if (uniform(0, 1) < 0.15) s.velocity = 0;
    return s;
  };
  c.from = state();
  c.to = state();
  return c;
}

/// Whether a state can be kept inside of the bounds for all time to come.
inline bool stays_inside(const JointState& s, const MotionBounds& b) {
  const double settled = s.velocity + s.acceleration * std::abs(s.acceleration) / (2 * b.max_jerk);
  return std::max(s.velocity, settled) <= b.max_velocity && std::min(s.velocity, settled) >= b.min_velocity &&
         s.acceleration <= b.max_acceleration && s.acceleration >= b.min_acceleration;
}

/// Whether a state can be the end of a motion inside of the bounds.
inline bool came_from_inside(const JointState& s, const MotionBounds& b) {
  return stays_inside({s.position, s.velocity, -s.acceleration},
                      {b.min_velocity, b.max_velocity, -b.max_acceleration, -b.min_acceleration, b.max_jerk});
}

/// What is wrong with a profile, or nothing. Bounds are looked at where velocity and acceleration have their extrema:
/// at the ends of phases and where the acceleration is zero inside of one.
inline std::string fault_of(const StateToStateCase& c, const JerkProfile& profile) {
  JointState peak{std::abs(c.to.position), std::abs(c.to.velocity), std::abs(c.to.acceleration)};
  const bool inside = stays_inside(c.from, c.bounds) && came_from_inside(c.to, c.bounds);
  constexpr double kRoom = 1 + 1e-9;
  std::string fault;
  const auto look = [&](const JointState& s) {
    peak.position = std::max(peak.position, std::abs(s.position));
    peak.velocity = std::max(peak.velocity, std::abs(s.velocity));
    peak.acceleration = std::max(peak.acceleration, std::abs(s.acceleration));
    if (!inside) return;
    if (s.velocity > c.bounds.max_velocity * kRoom || s.velocity < c.bounds.min_velocity * kRoom) fault = "velocity";
    if (s.acceleration > c.bounds.max_acceleration * kRoom || s.acceleration < c.bounds.min_acceleration * kRoom)
      fault = "acceleration";
  };
  const auto phases = profile.phases();
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const double end = i + 1 < phases.size() ? phases[i + 1].t0 : profile.duration();
    look(phases[i].start);
    if (std::abs(phases[i].jerk) > c.bounds.max_jerk * kRoom) fault = "jerk";
    if (phases[i].jerk == 0) continue;
    const double t = phases[i].t0 - phases[i].start.acceleration / phases[i].jerk;
    if (t > phases[i].t0 && t < end) look(profile.at(t));
  }
  look(profile.end());
  constexpr double kEnd = 1e-9;
  const JointState& end = profile.end();
  // A joint that waits days for a slow one ends only as well as the time is rounded.
  const double blur = 1e-15 * profile.duration();
  const double fastest_change = std::max(c.bounds.max_acceleration, -c.bounds.min_acceleration);
  const double fastest = std::max(c.bounds.max_velocity, -c.bounds.min_velocity);
  if (!(std::abs(end.position - c.to.position) <= kEnd * peak.position + 10 * blur * fastest)) fault = "end position";
  if (!(std::abs(end.velocity - c.to.velocity) <= kEnd * peak.velocity + blur * fastest_change)) fault = "end velocity";
  if (!(std::abs(end.acceleration - c.to.acceleration) <= kEnd * peak.acceleration)) fault = "end acceleration";
  return fault;
}

}  // namespace rmac
