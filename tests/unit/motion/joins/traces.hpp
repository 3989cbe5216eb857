#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "unit/motion/planner/planner_bench.hpp"

namespace rmac::test {

inline constexpr double kAtMost = 1.0005;

inline double distance(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

inline double distance_to_chord(const Vector& p, const Vector& a, const Vector& b) {
  double along = 0, length = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    along += (p[c] - a[c]) * (b[c] - a[c]);
    length += (b[c] - a[c]) * (b[c] - a[c]);
  }
  const double part = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
  return distance(p, {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])});
}

/// A chain of points so dense that its chords stand for the curve.
using Trace = std::vector<Vector>;

inline double distance_to_trace(const Vector& p, const Trace& trace) {
  double least = 1e9;
  for (std::size_t i = 0; i + 1 < trace.size(); ++i) {
    // A chord no nearer than its first point less its length needs no closer look.
    if (distance(p, trace[i]) - distance(trace[i], trace[i + 1]) < least)
      least = std::min(least, distance_to_chord(p, trace[i], trace[i + 1]));
  }
  return least;
}

inline Trace travelled(const PlannerBench& bench) {
  Trace trace;
  for (const Setpoint& setpoint : bench.record) {
    const Vector here{setpoint.position[0], setpoint.position[1], setpoint.position[2]};
    if (trace.empty() || distance(trace.back(), here) > 0) trace.push_back(here);
  }
  return trace;
}

/// What holds for every program: limits in every cycle, and moves told in their order.
inline void expect_limits_and_order(const PlannerBench& bench) {
  std::int64_t id = 0;
  for (const Setpoint& setpoint : bench.record) {
    EXPECT_GE(setpoint.move_id, id);
    id = setpoint.move_id;
  }
  const auto peaks = bench.peaks();
  EXPECT_LE(peaks.velocity, kAtMost);
  EXPECT_LE(peaks.acceleration, kAtMost);
  EXPECT_LE(peaks.jerk, kAtMost);
}

inline double seconds(const PlannerBench& bench) {
  std::size_t moving = 0;
  for (const Setpoint& setpoint : bench.record) moving += setpoint.moving ? 1U : 0U;
  return static_cast<double>(moving) * 1e-3;
}

}  // namespace rmac::test
