#include "time_law/window.hpp"

#include <algorithm>
#include <cmath>

#include "gives_way.hpp"
#include "time_law/law_check.hpp"
#include "time_law/law_grid.hpp"
#include "time_law/law_mend.hpp"
#include "time_law/law_problem.hpp"
#include "time_law/rest_end.hpp"
#include "time_law/speed_bound.hpp"
#include "time_law/window_begin.hpp"

namespace rmac {
namespace {

constexpr int kTightenings = 6, kPatientTightenings = 12;
/// A stretch at constant jerk next to rest is at most this part of its segment: what it has used up of the limits, a
/// sharp blend behind a short line needs.
constexpr double kRestOfSegment = 0.01;

/// A place of rest that misses the border of two segments by rounding is meant to be that. Beside it, what is left of a
/// segment would be shorter than any step that changes s.
double on_border(const PathView& path, double s) {
  constexpr double kRounding_mm = 1e-9;
  const double border = path.start(path.find(s + kRounding_mm, 1));
  return std::abs(border - s) <= kRounding_mm ? border : s;
}

bool fill(LawProblem& problem, const PathView& path, const std::vector<JointLimits>& joints, const FeedRule& feed) {
  const std::size_t n = joints.size(), intervals = problem.intervals();
  problem.joint_count = n;
  problem.derivatives.resize(intervals * 6 * n);
  problem.speed_cap.resize(intervals);
  problem.feed_cap.resize(intervals);
  problem.fastest.resize(intervals);
  problem.rise.resize(intervals);
  problem.fall.resize(intervals);
  problem.tightening.assign(intervals, 1.0);
  for (const JointLimits& joint : joints) {
    problem.max_acceleration.push_back(joint.max_acceleration * kLawMargin);
    problem.max_jerk.push_back(joint.max_jerk * kLawMargin);
  }
  JointPoint point;
  for (std::size_t k = 0; k < intervals; ++k) {
    double* out = problem.derivatives.data() + k * 6 * n;
    const PathSegment& segment = path.segment(path.find(0.5 * (problem.nodes[k] + problem.nodes[k + 1]), 1));
    double feed_v = kInfinity, joints_v = kInfinity;
    const double left_s = problem.nodes[k], right_s = problem.nodes[k + 1];
    for (int right = 0; right < 2; ++right) {
      const double s = right != 0 ? just_inside(right_s, left_s) : just_inside(left_s, right_s);
      if (path.derivatives(s, right != 0 ? -1 : 1, point) != KinematicsStatus::Ok) return false;
      for (std::size_t d = 1; d <= 3; ++d) out = std::copy_n(point.d[d].begin(), n, out);
      feed_v = std::min(feed_v, feed_bound(segment, point, joints, feed));
      joints_v = std::min(joints_v, joint_speed_bound(point, joints));
    }
    problem.feed_cap[k] = feed_v * feed_v;
    problem.fastest[k] = joints_v * joints_v;
    problem.speed_cap[k] = std::min(problem.feed_cap[k], problem.fastest[k]);
    problem.rise[k] = or_unbounded(segment.demand().accel_rise_mm_s2) * kLawMargin;
    problem.fall[k] = or_unbounded(segment.demand().accel_fall_mm_s2) * kLawMargin;
  }
  return true;
}

/// Grid steps of this length resolve the ramps to full speed.
double coarsest_step(const PathView& path, const std::vector<JointLimits>& joints, const Window& window, double s_begin,
                     double s_end) {
  double acceleration = kInfinity, jerk = kInfinity, fastest = kInfinity;
  for (const JointLimits& joint : joints) {
    acceleration = std::min(acceleration, joint.max_acceleration);
    jerk = std::min(jerk, joint.max_jerk);
    fastest = std::min(fastest, 2 * joint.max_speed);
  }
  double speed = window.begin.v;
  for (std::size_t i = path.find(s_begin, 1); i <= path.find(s_end, -1); ++i)
    speed = std::max(speed, window.feed.bound(path.segment(i)));
  const double ramp = ramp_length(std::min(speed, fastest), acceleration, jerk);
  return std::min((s_end - s_begin) / (window.from_rest() ? 12 : 40), std::max(ramp / 8, 0.01));
}

/// The first grid step of a window that begins in motion, which is graded too. Its first spline coefficients are fixed
/// by its state, which may lie at the edge of what the limits allow: on a coarse grid most such states have no way to a
/// stop. Nor may they reach over the feed.
double moving_start_step(const PathView& path, const std::vector<JointLimits>& joints, const Window& window,
                         double coarsest) {
  constexpr double kFinerAtStart = 48;
  const PathState& begin = window.begin;
  JointPoint point;
  double jerk = kInfinity;
  for (const JointLimits& joint : joints) jerk = std::min(jerk, joint.max_jerk);
  // Whoever creeps becomes much faster within hardly any length.
  const double creeping = std::max(begin.v * std::sqrt(0.2 * begin.v / jerk), 1e-4);
  const double step = std::min(coarsest / kFinerAtStart, creeping);
  if (!(begin.a > 0) || path.evaluate(begin.s, 1, 1, point) != KinematicsStatus::Ok) return step;
  const double cap = speed_bound(path.segment(path.find(begin.s, 1)), point, joints, window.feed);
  const double room = cap * cap - begin.v * begin.v;
  // Without room, the feed gives way.
  return room > 0 ? std::clamp(0.5 * room / begin.a, std::min(1e-4, step), step) : step;
}

/// The excess of a piece that got a cut: it is solved again, and bounds at its nodes hardly need to be tighter.
constexpr double kCut = 1 + 1e-9;

/// Solves the problem, and cuts and tightens it where the law is found in excess, until it passes its check. The law
/// begins at time `t0`.
std::optional<std::vector<LawPiece>> checked_law(LawProblem& problem, const PathView& path,
                                                 const std::vector<JointLimits>& joints, const FeedRule* feed,
                                                 double t0, int tightenings) {
  const LawSolution solution = solve_law(problem, {});
  if (!solution.converged) return std::nullopt;
  std::vector<double> coefficients = solution.coefficients;
  std::vector<LawPiece> law = law_pieces(problem, coefficients, t0);
  std::vector<double> excess(law.size());
  std::vector<IntervalRange> changed{{0, law.size()}};
  for (int round = 0; round < tightenings && !gives_way(); ++round) {
    for (const auto& [begin, end] : changed) {
      const auto from = static_cast<std::ptrdiff_t>(begin), to = static_cast<std::ptrdiff_t>(end);
      const LawExcess found = check_law(path, joints, {law.begin() + from, law.begin() + to}, feed);
      if (!std::isfinite(found.worst)) return std::nullopt;
      std::copy(found.by_piece.begin(), found.by_piece.end(), excess.begin() + from);
      for (std::size_t i = 0; i < found.peaks.size(); ++i) {
        if (found.peaks[i] && cut_at(problem, path, begin + i, *found.peaks[i])) excess[begin + i] = kCut;
      }
    }
    if (*std::max_element(excess.begin(), excess.end()) <= 1.0) return law;
    changed = mend_law(problem, excess, coefficients);
    if (changed.empty()) return std::nullopt;
    law = law_pieces(problem, coefficients, t0);
  }
  return std::nullopt;
}

/// As `plan_window`, with this part of the longest stretches at constant jerk that may lead from and to rest.
std::optional<std::vector<LawPiece>> law_of_window(const PathView& path, const std::vector<JointLimits>& joints,
                                                   const Window& window, double rest_part) {
  const bool from_rest = window.from_rest();
  const double s_begin = from_rest ? on_border(path, window.begin.s) : window.begin.s;
  const double s_end = on_border(path, window.s_end);
  const double length = s_end - s_begin;
  if (!(length > 0)) return std::nullopt;

  const double coarsest = coarsest_step(path, joints, window, s_begin, s_end);
  const auto end_at = [&](double s_rest, int direction) {
    const std::size_t segment = path.find(s_rest, direction);
    const double longest = std::min({coarsest, length / 40, kRestOfSegment * path.segment(segment).length()});
    return rest_end(path, joints, s_rest, direction, rest_part * longest, window.feed);
  };
  std::optional<RestEnd> first;
  if (from_rest) {
    first = end_at(s_begin, 1);
    if (!first) return std::nullopt;
  }
  const std::optional<RestEnd> last = end_at(s_end, -1);
  if (!last) return std::nullopt;

  LawProblem problem;
  problem.begin = first ? first->inner() : window.begin;
  problem.end = last->inner();
  if (!(problem.end.s > problem.begin.s)) return std::nullopt;
  const double start_step = first ? first->length : moving_start_step(path, joints, window, coarsest);
  std::vector<double> kept;
  if (window.before != nullptr && !from_rest)
    kept = nodes_kept(*window.before, problem.begin.s, problem.end.s, start_step);
  problem.nodes =
      law_grid(path, {problem.begin.s, s_begin, start_step}, {problem.end.s, s_end, last->length}, coarsest, kept);
  if (!fill(problem, path, joints, window.feed)) return std::nullopt;
  problem.work_left = window.work_left;
  const bool yields = window.before != nullptr && !from_rest && go_on_from(problem, window);
  const FeedRule* const programmed = yields ? nullptr : &window.feed;
  std::vector<LawPiece> ends{last->piece()};
  if (first) ends.push_back(first->piece());
  if (check_law(path, joints, ends, programmed).worst > 1) return std::nullopt;
  auto law = checked_law(problem, path, joints, programmed, first ? first->time : 0,
                         window.patient ? kPatientTightenings : kTightenings);
  if (!law) return std::nullopt;
  LawPiece stop = last->piece();
  stop.t0 = law->back().t0 + law->back().duration;
  law->push_back(stop);
  if (first) law->insert(law->begin(), first->piece());
  return law;
}

}  // namespace

double ramp_time(double v, double a, double j) noexcept {
  return v * j >= a * a ? v / a + a / j : 2 * std::sqrt(v / j);
}

double ramp_length(double v, double a, double j) noexcept {
  // Jerk up, constant acceleration, jerk down; the mean speed is v/2 whether or not the acceleration limit is reached.
  return 0.5 * v * ramp_time(v, a, j);
}

std::optional<std::vector<LawPiece>> plan_window(const PathView& path, const std::vector<JointLimits>& joints,
                                                 const Window& window) {
  // What jerk a stretch next to rest has used up, the path behind it may need: where it bends to and fro within a few
  // of its lengths, no law follows it, and one follows a shorter stretch.
  for (const double rest_part : {1.0, 0.1, 0.01}) {
    if (auto law = law_of_window(path, joints, window, rest_part)) return law;
    if (!window.patient || gives_way() || (window.work_left != nullptr && *window.work_left <= 0)) break;
  }
  return std::nullopt;
}

}  // namespace rmac
