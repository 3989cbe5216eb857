#include "time_law/window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "time_law/law_check.hpp"
#include "time_law/law_mend.hpp"
#include "time_law/law_problem.hpp"

namespace rmac {
namespace {

/// Planning stays this part inside the limits, so that what a check finds between grid points still keeps the limits
/// themselves.
constexpr double kMargin = 0.9985;
constexpr int kTightenings = 6, kPatientTightenings = 12;
constexpr double kGrading = 0.35;  ///< grid steps grow by this part of the distance from a point of rest
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Speed bound at a point of the path: feed and joint speeds.
double speed_bound(const PathSegment& segment, const JointPoint& point, const std::vector<JointLimits>& joints,
                   const FeedRule& feed) {
  const PathDemand& demand = segment.demand();
  double v = feed.bound(segment);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double d = std::abs(point.d[1][j]);
    if (d * v > joints[j].max_speed * kMargin) v = joints[j].max_speed * kMargin / d;
    if (segment.curve().in_joint_space())
      v = std::min(
          v, joints[j].max_speed * kMargin * demand.joint_speed_fraction * feed.override_factor / std::max(d, 1e-12));
  }
  return v;
}

/// The stretch next to a point of rest, travelled at constant jerk: q ~ s^(4/3) there, which no spline follows (eq.
/// 12).
struct RestEnd {
  double length = 0, time = 0, speed = 0, acceleration = 0, jerk = 0;
};

std::optional<RestEnd> rest_end(const PathView& path, const std::vector<JointLimits>& joints, double s_rest,
                                int direction, double available, double longest, const FeedRule& feed) {
  JointPoint point;
  if (path.derivatives(s_rest, direction, point) != KinematicsStatus::Ok) return std::nullopt;
  const PathSegment& segment = path.segment(path.find(s_rest, direction));
  const PathDemand& demand = segment.demand();
  double jerk = kInfinity,
         acceleration = or_unbounded(direction > 0 ? demand.accel_rise_mm_s2 : demand.accel_fall_mm_s2);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double d = std::max(std::abs(point.d[1][j]), 1e-12);
    jerk = std::min(jerk, joints[j].max_jerk * kMargin / d);
    acceleration = std::min(acceleration, joints[j].max_acceleration * kMargin / d);
  }
  RestEnd end;
  end.jerk = 0.97 * jerk;
  const double speed = speed_bound(segment, point, joints, feed);
  const double step = std::min(longest, available / 40);
  end.time =
      std::min({0.3 * acceleration / end.jerk, std::sqrt(0.2 * speed / end.jerk), std::cbrt(6 * step / end.jerk)});
  for (int attempt = 0; attempt < 40; ++attempt, end.time *= 0.7, end.jerk = 0.9 * jerk) {
    end.length = end.jerk * end.time * end.time * end.time / 6;
    end.speed = end.jerk * end.time * end.time / 2;
    end.acceleration = end.jerk * end.time;
    const double room = s_rest + direction * end.length;
    if (path.find(room, -direction) != path.find(s_rest, direction)) continue;  // stay inside one segment
    bool fits = true;
    for (int i = 1; i <= 4 && fits; ++i) {
      const double t = end.time * i / 4;
      const double v = end.jerk * t * t / 2, a = end.jerk * t;
      if (path.derivatives(s_rest + direction * end.jerk * t * t * t / 6, direction, point) != KinematicsStatus::Ok)
        return std::nullopt;
      for (std::size_t j = 0; j < joints.size() && fits; ++j) {
        // Mirrored at an end: t runs backwards, so speed and jerk keep their sign and the acceleration changes it (eq.
        // 13).
        const double sign = direction;
        fits = std::abs(point.d[3][j] * v * v * v + 3 * sign * point.d[2][j] * v * a + point.d[1][j] * end.jerk) <=
                   joints[j].max_jerk * kMargin &&
               std::abs(point.d[2][j] * v * v + sign * point.d[1][j] * a) <= 0.5 * joints[j].max_acceleration;
      }
    }
    if (fits) return end;
  }
  return std::nullopt;
}

/// A place of rest that misses the border of two segments by rounding is meant to be that. Beside it, what is left of a
/// segment would be shorter than any step that changes s.
double on_border(const PathView& path, double s) {
  constexpr double kRounding_mm = 1e-9;
  const double border = path.start(path.find(s + kRounding_mm, 1));
  return std::abs(border - s) <= kRounding_mm ? border : s;
}

double rounding(double s) {
  return 1e-12 * (1 + std::abs(s));
}

/// Whether s lies behind `before` by more than rounding.
bool apart(double before, double s) {
  return s > before + rounding(s);
}

/// Grid from a to b: segment ends and breaks on it, as fine as the geometry asks and no coarser than `coarsest`, graded
/// towards the window's ends at rest_a and rest_b.
std::vector<double> make_grid(const PathView& path, double a, double b, double rest_a, double rest_b, double finest_a,
                              double finest_b, double coarsest) {
  std::vector<double> fixed{a};
  std::vector<double> asked;  // the nodes of the geometry
  for (std::size_t i = path.find(a, 1); i <= path.find(b, -1); ++i) {
    const double start = path.start(i);
    const auto keep = [&](double s) {
      if (apart(fixed.back(), s) && s < b) fixed.push_back(s);
    };
    keep(start);
    for (const double s : path.segment(i).curve().breaks()) keep(start + s);
    for (const double s : path.segment(i).curve().nodes()) asked.push_back(start + s);
  }
  fixed.push_back(b);
  // A step into an interval between the geometry's nodes is no longer than that interval, and steps grow with the
  // distance from it: a sharp bend is never stepped over, and next to one the speed changes as fast as next to a rest.
  std::vector<double> finest(asked.size(), coarsest);
  for (std::size_t i = 0; i + 1 < asked.size(); ++i) {
    const double width = asked[i + 1] - asked[i];
    // Where segments meet, the last node of one and the first of the next differ by rounding.
    if (!apart(asked[i], asked[i + 1])) continue;
    finest[i] = std::min(finest[i], width);
    finest[i + 1] = std::min(finest[i + 1], width);
  }
  for (std::size_t i = 1; i < asked.size(); ++i)
    finest[i] = std::min(finest[i], finest[i - 1] + kGrading * (asked[i] - asked[i - 1]));
  for (std::size_t i = asked.size() - 1; i-- > 0;)
    finest[i] = std::min(finest[i], finest[i + 1] + kGrading * (asked[i + 1] - asked[i]));
  std::size_t node = 0;  // the last one at or before the place
  const auto step_from = [&](double s) {
    while (node + 1 < asked.size() && asked[node + 1] <= s) ++node;
    double h = std::min({coarsest, finest_a + kGrading * (s - rest_a), finest_b + kGrading * (rest_b - s)});
    h = std::min(h, finest[node] + kGrading * std::abs(s - asked[node]));
    if (node + 1 < asked.size()) h = std::min(h, finest[node + 1] + kGrading * (asked[node + 1] - s));
    return h;
  };
  std::vector<double> nodes{a};
  std::vector<double> stretch;
  for (std::size_t i = 0; i + 1 < fixed.size(); ++i) {
    const double from = fixed[i], to = fixed[i + 1];
    stretch.clear();
    for (double s = from; s < to;) {
      s += std::max(step_from(s), rounding(s));  // a shorter step would not get on
      stretch.push_back(s);
    }
    // The last step is cut short; were it much shorter than the one before, the two share their length.
    stretch.back() = to;
    if (const std::size_t n = stretch.size(); n >= 2) {
      const double before = n >= 3 ? stretch[n - 3] : from;
      if (to - stretch[n - 2] < 0.5 * (stretch[n - 2] - before)) stretch[n - 2] = before + 0.5 * (to - before);
    }
    nodes.insert(nodes.end(), stretch.begin(), stretch.end());
  }
  // The spline's end coefficients are fixed by the end states; a law needs some that are free.
  while (nodes.size() < 6) {
    std::vector<double> finer{nodes.front()};
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      finer.push_back(0.5 * (nodes[i] + nodes[i + 1]));
      finer.push_back(nodes[i + 1]);
    }
    nodes = std::move(finer);
  }
  return nodes;
}

bool fill(LawProblem& problem, const PathView& path, const std::vector<JointLimits>& joints, const FeedRule& feed) {
  const std::size_t n = joints.size(), intervals = problem.intervals();
  problem.joint_count = n;
  problem.derivatives.resize(intervals * 6 * n);
  problem.speed_cap.resize(intervals);
  problem.rise.resize(intervals);
  problem.fall.resize(intervals);
  problem.tightening.assign(intervals, 1.0);
  for (const JointLimits& joint : joints) {
    problem.max_acceleration.push_back(joint.max_acceleration * kMargin);
    problem.max_jerk.push_back(joint.max_jerk * kMargin);
  }
  JointPoint point;
  for (std::size_t k = 0; k < intervals; ++k) {
    double* out = problem.derivatives.data() + k * 6 * n;
    const PathSegment& segment = path.segment(path.find(0.5 * (problem.nodes[k] + problem.nodes[k + 1]), 1));
    double v = kInfinity;
    const double left_s = problem.nodes[k], right_s = problem.nodes[k + 1];
    for (int right = 0; right < 2; ++right) {
      const double s = right != 0 ? just_inside(right_s, left_s) : just_inside(left_s, right_s);
      if (path.derivatives(s, right != 0 ? -1 : 1, point) != KinematicsStatus::Ok) return false;
      for (std::size_t d = 1; d <= 3; ++d) out = std::copy_n(point.d[d].begin(), n, out);
      v = std::min(v, speed_bound(segment, point, joints, feed));
    }
    problem.speed_cap[k] = v * v;
    problem.rise[k] = or_unbounded(segment.demand().accel_rise_mm_s2);
    problem.fall[k] = or_unbounded(segment.demand().accel_fall_mm_s2);
  }
  return true;
}

/// Where the state at the beginning is faster than the bounds (an override was lowered), they give way as far as
/// braking needs.
void yield_to_begin(LawProblem& problem) {
  double acceleration = kInfinity, jerk = kInfinity;
  for (std::size_t k = 0; k < std::min<std::size_t>(problem.intervals(), 40); ++k) {
    const JointDerivatives d = problem.at(k, false);
    for (std::size_t j = 0; j < problem.joint_count; ++j) {
      acceleration = std::min(acceleration, 0.25 * problem.max_acceleration[j] / std::max(std::abs(d.d1[j]), 1e-9));
      jerk = std::min(jerk, 0.25 * problem.max_jerk[j] / std::max(std::abs(d.d1[j]), 1e-9));
    }
    acceleration = std::min(acceleration, 0.5 * problem.fall[k]);
  }
  // First the acceleration is taken back to zero and to braking at constant jerk, then it is kept.
  PathState state = problem.begin;
  const double dt = std::max(1e-4, problem.begin.v / acceleration / 4000);
  double s = state.s, v = state.v, a = state.a;
  for (std::size_t k = 0; k < problem.intervals() && v > 0; ++k) {
    problem.speed_cap[k] = std::max(problem.speed_cap[k], v * v * 1.02 + 2 * std::max(a, 0.0) * problem.step(k));
    while (s < problem.nodes[k + 1] && v > 0) {
      a = std::max(a - jerk * dt, -acceleration);
      v += a * dt;
      s += std::max(v, 0.0) * dt;
    }
  }
}

/// Lets the next law start from the one before. Its state lies at the edge of what is viable, so the first stretch may
/// use most of the margin that the law before left; and what that law had is the first guess (eq. 8). Where a feed
/// gives way to that law (`yields`), it does so as far as the law went.
void resume_from(LawProblem& problem, const std::vector<LawPiece>& before, bool yields) {
  constexpr double kRelaxed = 0.9997 / kMargin;
  constexpr double kEasing = 0.1;  ///< of the window
  const double span = problem.nodes.back() - problem.nodes.front();
  problem.travelled_before.assign(problem.intervals() + 2, 0.0);
  std::size_t piece = 0;
  for (std::size_t k = 0; k < problem.intervals(); ++k) {
    if (problem.nodes[k] - problem.nodes.front() < 0.25 * span) problem.tightening[k] = kRelaxed;
    const double h = problem.step(k), middle = problem.nodes[k] + h / 2;
    while (piece + 1 < before.size() && before[piece + 1].start.s <= middle) ++piece;
    const LawPiece& at = before[piece];
    if (at.kind != LawPiece::Kind::Linear || piece + 1 == before.size()) continue;
    const double ds = middle - at.start.s;
    const double q = at.start.v * at.start.v + 2 * at.start.a * ds + at.slope * ds * ds;
    // A little slower, which is inside the bounds; but not at once, which would be a jerk.
    const double into = std::min((middle - problem.nodes.front()) / (kEasing * span), 1.0);
    const double part = 1 - 0.005 * into * into * (3 - 2 * into);
    problem.travelled_before[k + 1] = std::max(0.0, part * (q - h * h / 4 * at.slope));
    const double most = q + h * std::abs(at.start.a + at.slope * ds) + h * h / 4 * std::abs(at.slope);
    if (yields) problem.speed_cap[k] = std::max(problem.speed_cap[k], 1.01 * most);
  }
}

/// The law of the grid with the stretches next to rest.
std::vector<LawPiece> with_rest_ends(std::vector<LawPiece> law, const std::optional<LawPiece>& first, LawPiece last) {
  last.t0 = law.back().t0 + law.back().duration;
  law.push_back(last);
  if (first) law.insert(law.begin(), *first);
  return law;
}

/// As `plan_window`, with this part of the longest stretches at constant jerk that may lead from and to rest.
std::optional<std::vector<LawPiece>> law_of_window(const PathView& path, const std::vector<JointLimits>& joints,
                                                   const Window& window, double rest_part) {
  const bool from_rest = window.begin.v == 0 && window.begin.a == 0;
  const double s_begin = from_rest ? on_border(path, window.begin.s) : window.begin.s;
  const double s_end = on_border(path, window.s_end);
  const double length = s_end - s_begin;
  const FeedRule& feed = window.feed;
  if (!(length > 0)) return std::nullopt;

  double coarsest = length / (from_rest ? 12 : 40);
  {  // grid steps resolve the ramps to full speed
    double a = kInfinity, j = kInfinity;
    for (const JointLimits& joint : joints) a = std::min(a, joint.max_acceleration), j = std::min(j, joint.max_jerk);
    double v = window.begin.v;
    for (std::size_t i = path.find(s_begin, 1); i <= path.find(s_end, -1); ++i)
      v = std::max(v, feed.bound(path.segment(i)));
    for (const JointLimits& joint : joints) v = std::min(v, 2 * joint.max_speed);
    coarsest = std::min(coarsest, std::max(ramp_length(v, a, j) / 8, 0.01));
  }
  double a = s_begin, b = s_end;
  std::optional<RestEnd> first, last;
  if (from_rest) {
    first = rest_end(path, joints, a, 1, rest_part * length, rest_part * coarsest, feed);
    if (!first) return std::nullopt;
    a += first->length;
  }
  last = rest_end(path, joints, b, -1, rest_part * length, rest_part * coarsest, feed);
  if (!last) return std::nullopt;
  b -= last->length;
  if (!(b > a)) return std::nullopt;

  LawProblem problem;
  problem.begin = first ? PathState{a, first->speed, first->acceleration} : window.begin;
  problem.end = {b, last->speed, -last->acceleration};
  // A moving start is graded too. Its first spline coefficients are fixed by its state, which may lie at the edge of
  // what the limits allow: on a coarse grid most such states have no way to a stop. Nor may they reach over the feed.
  constexpr double kFinerAtStart = 48;
  double start_step = first ? first->length : coarsest / kFinerAtStart;
  if (JointPoint point; !first && window.begin.a > 0 && path.evaluate(a, 1, 1, point) == KinematicsStatus::Ok) {
    const double cap = speed_bound(path.segment(path.find(a, 1)), point, joints, feed);
    const double room = cap * cap - window.begin.v * window.begin.v;
    // Without room, the feed gives way.
    if (room > 0) start_step = std::clamp(0.5 * room / window.begin.a, std::min(1e-4, start_step), start_step);
  }
  problem.nodes = make_grid(path, a, b, s_begin, s_end, start_step, last->length, coarsest);
  if (!fill(problem, path, joints, feed)) return std::nullopt;
  const bool yields = problem.begin.v * problem.begin.v > problem.speed_cap[0] * (1 + 1e-5);
  if (yields) yield_to_begin(problem);
  if (window.before != nullptr && !from_rest) resume_from(problem, *window.before, yields && window.same_feed);

  std::optional<LawPiece> from_standing;
  if (first) from_standing = {0, {s_begin, 0, 0}, first->jerk, first->time, LawPiece::Kind::Jerk};
  const LawPiece to_standing{0, problem.end, last->jerk, last->time, LawPiece::Kind::Jerk};
  const FeedRule* const programmed = yields ? nullptr : &feed;
  std::vector<LawPiece> ends{to_standing};
  if (from_standing) ends.push_back(*from_standing);
  if (check_law(path, joints, ends, programmed).worst > 1) return std::nullopt;

  const LawSolution solution = solve_law(problem, {});
  if (!solution.converged) return std::nullopt;
  std::vector<double> coefficients = solution.coefficients;
  const double t_first = first ? first->time : 0;
  std::vector<LawPiece> law = law_pieces(problem, coefficients, t_first);
  std::vector<double> excess(law.size());
  std::vector<IntervalRange> changed{{0, law.size()}};
  for (int round = 0; round < (window.patient ? kPatientTightenings : kTightenings); ++round) {
    for (const auto& [begin, end] : changed) {
      const auto from = static_cast<std::ptrdiff_t>(begin), to = static_cast<std::ptrdiff_t>(end);
      const LawExcess found = check_law(path, joints, {law.begin() + from, law.begin() + to}, programmed);
      if (!std::isfinite(found.worst)) return std::nullopt;
      std::copy(found.by_piece.begin(), found.by_piece.end(), excess.begin() + from);
    }
    if (*std::max_element(excess.begin(), excess.end()) <= 1.0)
      return with_rest_ends(std::move(law), from_standing, to_standing);
    changed = mend_law(problem, excess, coefficients);
    if (changed.empty()) return std::nullopt;
    law = law_pieces(problem, coefficients, t_first);
  }
  return std::nullopt;
}

}  // namespace

double ramp_length(double v, double a, double j) noexcept {
  // Jerk up, constant acceleration, jerk down; the mean speed is v/2 whether or not the acceleration limit is reached.
  const double time = v * j >= a * a ? v / a + a / j : 2 * std::sqrt(v / j);
  return 0.5 * v * time;
}

std::optional<std::vector<LawPiece>> plan_window(const PathView& path, const std::vector<JointLimits>& joints,
                                                 const Window& window) {
  // What jerk a stretch next to rest has used up, the path behind it may need: where it bends to and fro within a few
  // of its lengths, no law follows it, and one follows a shorter stretch.
  for (const double rest_part : {1.0, 0.1, 0.01}) {
    if (auto law = law_of_window(path, joints, window, rest_part)) return law;
    if (!window.patient) break;
  }
  return std::nullopt;
}

}  // namespace rmac
