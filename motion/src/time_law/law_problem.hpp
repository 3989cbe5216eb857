#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "rmac/motion/time_law.hpp"

namespace rmac {

/// Where nothing bounds.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Joints' first three derivatives by path length at one end of a grid interval; spans of joint_count values in
/// `LawProblem::derivatives`.
struct JointDerivatives {
  const double* d1;
  const double* d2;
  const double* d3;
};

/// A place within an interval where the joints' bounds of acceleration and jerk are kept as at both of its ends.
struct LawCut {
  std::size_t interval = 0;
  double part = 0;                  ///< of the way from its left node to the right one
  std::vector<double> derivatives;  ///< d1 d2 d3, each joint_count values
};

/// The optimisation that finds a time law (docs/derivations/time-law.md): q(s) = (ds/dt)² as a C1 quadratic spline over
/// a grid, fastest under linear bounds on q and q' (feed, joint speed and acceleration, path acceleration) and the
/// bound on joint jerk. Both end states are given: rest itself is not a spline (q grows like s^(4/3) there) and is
/// handled by `rest_ends`.
struct LawProblem {
  std::size_t joint_count = 0;
  std::vector<double> nodes;        ///< N + 1 ascending path lengths
  std::vector<double> derivatives;  ///< an interval: left d1 d2 d3, right d1 d2 d3, each joint_count values
  std::vector<double> speed_cap;    ///< an interval: bound of q, mm²/s²
  /// Of a window, an interval: what bounds q by the feed alone, and by the joints' speeds alone.
  std::vector<double> feed_cap, fastest;
  std::vector<double> rise,
      fall;  ///< an interval: bounds of path acceleration, mm/s²; infinity where the joints alone bound it
  std::vector<double> tightening;  ///< an interval: bounds of joints' acceleration and jerk are multiplied by it; about
                                   ///< 1 at first, less where the check found excess
  std::vector<LawCut> cuts;        ///< where a check found more between two nodes than at them
  std::vector<double> max_acceleration, max_jerk;  ///< a joint
  PathState begin, end;
  bool draft = false;  ///< of a path that is still being shaped: both end states are free, and jerk has its price told
  /// Work that may still be done on it: falls by the intervals, an iteration; none is begun once it is used up. Null:
  /// as much as it takes.
  long* work_left = nullptr;
  std::vector<double>
      travelled_before;  ///< empty, or a coefficient each: what an earlier law had here; 0 where it had nothing

  [[nodiscard]] std::size_t intervals() const noexcept { return nodes.size() - 1; }
  [[nodiscard]] double step(std::size_t interval) const noexcept { return nodes[interval + 1] - nodes[interval]; }
  [[nodiscard]] JointDerivatives at(std::size_t interval, bool right) const noexcept {
    const double* const first = derivatives.data() + (interval * 2 + (right ? 1U : 0U)) * 3 * joint_count;
    return {first, first + joint_count, first + 2 * joint_count};
  }
};

/// Result: the spline's coefficients (intervals + 2), see eq. 7.
struct LawSolution {
  bool converged = false;
  int iterations = 0;
  std::vector<double> coefficients;
  /// In a draft, how much travel time the bound of a joint's jerk costs, as a part of the bound; for each interval left
  /// and right, each joint_count values.
  std::vector<double> jerk_prices;
};

/// Solves by a primal-dual interior point method. `guess` may hold coefficients of an earlier solve of the same grid,
/// or be empty.
[[nodiscard]] LawSolution solve_law(const LawProblem& problem, const std::vector<double>& guess);

/// q, q' and q'' of the spline at the left end of an interval.
struct SplineStart {
  double q, dq, ddq;
};
[[nodiscard]] SplineStart spline_start(const LawProblem& problem, const std::vector<double>& coefficients,
                                       std::size_t interval) noexcept;

/// The law's pieces, the first one beginning at time `t0`.
[[nodiscard]] std::vector<LawPiece> law_pieces(const LawProblem& problem, const std::vector<double>& coefficients,
                                               double t0);

}  // namespace rmac
