#include "time_law/law_mend.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {
namespace {

/// Intervals on either side of one in excess that may give way to it.
constexpr std::size_t kReach = 48;
/// The square of a speed is capped by no less than this part of itself at a time: what goes beyond is not its doing.
constexpr double kLeastCap = 0.98;

/// As a part of the interval: cuts that are nearer say the same.
constexpr double kSamePart = 0.05;

template <typename T>
std::vector<T> slice(const std::vector<T>& all, std::size_t first, std::size_t last) {
  return {all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(last)};
}

std::vector<IntervalRange> around_excess(const std::vector<double>& excess) {
  std::vector<IntervalRange> ranges;
  for (std::size_t k = 0; k < excess.size(); ++k) {
    if (excess[k] <= 1) continue;
    const std::size_t first = k - std::min(k, kReach), last = std::min(k + kReach + 1, excess.size());
    if (!ranges.empty() && first <= ranges.back().last) {
      ranges.back().last = last;
    } else {
      ranges.push_back({first, last});
    }
  }
  return ranges;
}

PathState state_at(const LawProblem& problem, const std::vector<double>& coefficients, std::size_t node) {
  if (node == 0) return problem.begin;
  if (node == problem.intervals()) return problem.end;
  const SplineStart start = spline_start(problem, coefficients, node);
  return {problem.nodes[node], std::sqrt(start.q), start.dq / 2};
}

LawProblem part_of(const LawProblem& whole, const std::vector<double>& coefficients, const IntervalRange& range) {
  const auto [first, last] = range;
  const std::size_t each = 6 * whole.joint_count;
  LawProblem part;
  part.joint_count = whole.joint_count;
  part.work_left = whole.work_left;
  part.nodes = slice(whole.nodes, first, last + 1);
  part.derivatives = slice(whole.derivatives, first * each, last * each);
  part.speed_cap = slice(whole.speed_cap, first, last);
  part.rise = slice(whole.rise, first, last);
  part.fall = slice(whole.fall, first, last);
  part.tightening = slice(whole.tightening, first, last);
  for (const LawCut& cut : whole.cuts) {
    if (cut.interval < first || cut.interval >= last) continue;
    part.cuts.push_back(cut);
    part.cuts.back().interval -= first;
  }
  part.max_acceleration = whole.max_acceleration;
  part.max_jerk = whole.max_jerk;
  part.begin = state_at(whole, coefficients, first);
  part.end = state_at(whole, coefficients, last);
  return part;
}

}  // namespace

bool cut_at(LawProblem& problem, const PathView& path, std::size_t interval, double s) {
  const double part = (s - problem.nodes[interval]) / problem.step(interval);
  const auto says_it = [&](const LawCut& cut) {
    return cut.interval == interval && std::abs(cut.part - part) < kSamePart;
  };
  if (!(part > 0) || !(part < 1) || std::any_of(problem.cuts.begin(), problem.cuts.end(), says_it)) return false;
  JointPoint point;
  if (path.derivatives(s, 1, point) != KinematicsStatus::Ok) return false;
  LawCut& cut = problem.cuts.emplace_back(LawCut{interval, part, {}});
  for (std::size_t order = 1; order <= 3; ++order)
    cut.derivatives.insert(cut.derivatives.end(), point.d[order].begin(),
                           point.d[order].begin() + static_cast<std::ptrdiff_t>(problem.joint_count));
  return true;
}

std::vector<IntervalRange> mend_law(LawProblem& problem, const std::vector<double>& excess,
                                    std::vector<double>& coefficients) {
  const std::vector<IntervalRange> ranges = around_excess(excess);
  for (const IntervalRange& range : ranges) {
    for (std::size_t k = range.first; k < range.last; ++k) {
      if (excess[k] > 0.9999) problem.tightening[k] *= std::max(0.5, 0.9992 / excess[k]);
      // A joint may be faster between nodes than at both. Where the law begins, its speed is given.
      if (excess[k] > 1 && k > 1) problem.speed_cap[k] *= std::max(kLeastCap, std::pow(0.9992 / excess[k], 2));
    }
  }
  const std::vector<double> before = coefficients;
  for (const IntervalRange& range : ranges) {
    // The coefficients at both ends of the part say its end states, as they did in the whole (eq. 9).
    const LawSolution solution = solve_law(part_of(problem, before, range), slice(before, range.first, range.last + 2));
    if (!solution.converged) {
      const LawSolution whole = solve_law(problem, before);
      if (!whole.converged) return {};
      coefficients = whole.coefficients;
      return {{0, problem.intervals()}};
    }
    std::copy(solution.coefficients.begin() + 2, solution.coefficients.end() - 2,
              coefficients.begin() + static_cast<std::ptrdiff_t>(range.first) + 2);
  }
  return ranges;
}

}  // namespace rmac
