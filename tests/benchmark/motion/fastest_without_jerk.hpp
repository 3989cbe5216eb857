#pragma once

#include <functional>
#include <vector>

#include "exact_nurbs.hpp"
#include "rmac/motion/limits.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::bench {

/// Joints (as many as limits) and, behind them, the tip's three coordinates, at a parameter of the path.
using PathFunction = std::function<void(Real u, Real* joints_and_tip)>;

/// Time of the fastest travel from rest to rest that keeps every joint's speed and acceleration and the feed, and no
/// jerk limit: a bound that no jerk-limited travel can pass. By the largest controllable speeds from the end backwards,
/// then as fast as they allow forwards (Pham & Pham 2018, reachability), over u itself, on `grid` intervals.
[[nodiscard]] double fastest_without_jerk_s(const PathFunction& path, Real begin, Real end,
                                            const std::vector<JointLimits>& joints, double feed_mm_s, int grid = 2000);

}  // namespace rmac::bench
