#include "time_law/window_begin.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "time_law/speed_bound.hpp"

namespace rmac {
namespace {

/// What exceeds the feed by no more is as fast as it: squares of speeds of a state, and of a law that passed its check.
constexpr double kState = 1 + 1e-5, kLaw = 1.003;
/// Room that a bound leaves to what it gives way to.
constexpr double kGivesWay = 1.0002;
/// The margin that the law before left to the joints' bounds, speeds among them, and a window may use most of near its
/// begin.
constexpr double kRelaxed = 0.9997 / kLawMargin;

/// The square of the speed, and the acceleration, at the nodes of the problem's grid, up to rest.
struct BrakingAtNodes {
  std::vector<double> q, a;
};

/// Of who lets go of the acceleration at the begin and brakes with this part of the joints' bounds: first at constant
/// jerk, then at constant acceleration.
BrakingAtNodes braking_from_begin(const LawProblem& problem, double part) {
  double acceleration = kInfinity, jerk = kInfinity;
  for (std::size_t k = 0; k < std::min<std::size_t>(problem.intervals(), 40); ++k) {
    const JointDerivatives d = problem.at(k, false);
    for (std::size_t j = 0; j < problem.joint_count; ++j) {
      acceleration = std::min(acceleration, part * problem.max_acceleration[j] / std::max(std::abs(d.d1[j]), 1e-9));
      jerk = std::min(jerk, part * problem.max_jerk[j] / std::max(std::abs(d.d1[j]), 1e-9));
    }
    acceleration = std::min(acceleration, 2 * part * problem.fall[k]);
  }
  BrakingAtNodes braking;
  double s = problem.begin.s, v = problem.begin.v, a = problem.begin.a;
  const double dt = std::max(1e-4, v / acceleration / 4000);
  for (std::size_t k = 0; k < problem.intervals() && v > 0; ++k) {
    braking.q.push_back(v * v);
    braking.a.push_back(a);
    while (s < problem.nodes[k + 1] && v > 0) {
      a = std::max(a - jerk * dt, -acceleration);
      v += a * dt;
      s += std::max(v, 0.0) * dt;
    }
  }
  return braking;
}

/// Whether a square of a speed exceeds what the feed, not the joints, allows on an interval.
bool over_feed(const LawProblem& problem, std::size_t k, double q, double part) {
  return problem.feed_cap[k] < problem.fastest[k] && q > part * problem.feed_cap[k];
}

/// Whether a state that is not too fast yet becomes so whatever is done: braking that leaves half of the bounds to what
/// else there is to do is too fast somewhere.
bool overshoots(const LawProblem& problem) {
  const std::vector<double> q = braking_from_begin(problem, 0.5).q;
  for (std::size_t k = 0; k < q.size(); ++k) {
    if (over_feed(problem, k, q[k], kState)) return true;
  }
  return false;
}

/// The square of the speed along a piece of law, and its slopes: q, q'/2 and q''/2.
struct SquaredSpeed {
  double q = 0, a = 0, bend = 0;
  /// The largest that it may be on an interval h long about the place.
  [[nodiscard]] double most(double h) const { return q + h * std::abs(a) + h * h / 4 * std::abs(bend); }
};
using AlongIntervals = std::vector<std::optional<SquaredSpeed>>;

/// At path length s; nothing behind the end of the piece.
std::optional<SquaredSpeed> squared_speed(const LawPiece& piece, double s) {
  const PathState& begin = piece.start;
  if (piece.kind == LawPiece::Kind::Linear) {
    const double ds = s - begin.s;
    return SquaredSpeed{begin.v * begin.v + ds * (2 * begin.a + ds * piece.slope), begin.a + piece.slope * ds,
                        piece.slope};
  }
  if (s > piece.at(piece.duration).s) return std::nullopt;
  double low = 0, high = piece.duration;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (piece.at(middle).s < s ? low : high) = middle;
  }
  const PathState at = piece.at(high);
  return SquaredSpeed{at.v * at.v, at.a, 0};
}

/// The law before along the middles of the problem's intervals, where it was in motion.
AlongIntervals along_intervals(const LawProblem& problem, const std::vector<LawPiece>& before) {
  AlongIntervals along(problem.intervals());
  std::size_t piece = 0;
  for (std::size_t k = 0; k < problem.intervals(); ++k) {
    const double middle = problem.nodes[k] + problem.step(k) / 2;
    while (piece + 1 < before.size() && before[piece + 1].start.s <= middle) ++piece;
    if (piece + 1 < before.size()) along[k] = squared_speed(before[piece], middle);
  }
  return along;
}

/// Lets the feed give way as far as gentle braking (`Window::braking`) needs, but no further than the joints' speeds,
/// nor than the law before went; where that brakes already, for the same feed, than it had come until there and than
/// the feed that was programmed, up to a move that is slower.
void yield_to_begin(LawProblem& problem, const AlongIntervals& before, const Window& window) {
  const auto [q, a] = braking_from_begin(problem, window.braking);
  const double lowered = std::min(window.feed.override_factor, 1.0);
  double came_to = problem.begin.v * problem.begin.v;
  bool slower = false;
  for (std::size_t k = 0; k < q.size(); ++k) {
    const double h = problem.step(k);
    const double programmed = problem.feed_cap[k] / (lowered * lowered);
    double most = before[k] ? kGivesWay * before[k]->most(h) : problem.speed_cap[k];
    // Room upon room, window after window, would become much.
    if (before[k] && before[k]->q <= kLaw * programmed) most = std::min(most, programmed);
    if (before[k]) came_to = std::max(came_to, before[k]->q);
    slower = slower || problem.feed_cap[k] < (1 - 1e-9) * problem.feed_cap[0];
    if (window.same_feed && !slower) most = std::max(most, std::min(came_to, programmed));
    const double needed = std::min({q[k] * 1.02 + 2 * std::max(a[k], 0.0) * h, most, problem.fastest[k]});
    problem.speed_cap[k] = std::max(problem.speed_cap[k], needed);
  }
}

/// Lets the feed give way where the law before, which was made for it, is faster.
void yield_to_law(LawProblem& problem, const AlongIntervals& before) {
  for (std::size_t k = 0; k < problem.intervals(); ++k) {
    if (!before[k] || !over_feed(problem, k, before[k]->q, kState)) continue;
    const double most = std::min(before[k]->most(problem.step(k)), problem.fastest[k]);
    problem.speed_cap[k] = std::max(problem.speed_cap[k], most);
  }
}

/// The first guess is what the law before had (eq. 8). Its state lies at the edge of what is viable, so the first
/// stretch may use most of the margin that it left.
void resume_from(LawProblem& problem, const AlongIntervals& before) {
  constexpr double kEasing = 0.1;  ///< of the window
  const double span = problem.nodes.back() - problem.nodes.front();
  problem.travelled_before.assign(problem.intervals() + 2, 0.0);
  for (std::size_t k = 0; k < problem.intervals(); ++k) {
    if (problem.nodes[k] - problem.nodes.front() < 0.25 * span) {
      for (auto* bound : {&problem.tightening, &problem.rise, &problem.fall}) (*bound)[k] *= kRelaxed;
      const double relaxed = std::min(problem.feed_cap[k], problem.fastest[k] * kRelaxed * kRelaxed);
      problem.speed_cap[k] = std::max(problem.speed_cap[k], relaxed);
    }
    if (!before[k]) continue;
    const SquaredSpeed& at = *before[k];
    const double h = problem.step(k), middle = problem.nodes[k] + h / 2;
    // A little slower, which is inside the bounds; but not at once, which would be a jerk.
    const double into = std::min((middle - problem.nodes.front()) / (kEasing * span), 1.0);
    const double part = 1 - 0.005 * into * into * (3 - 2 * into);
    problem.travelled_before[k + 1] = std::max(0.0, part * (at.q - h * h / 4 * at.bend));
  }
}

}  // namespace

std::vector<double> nodes_kept(const std::vector<LawPiece>& before, double s_begin, double s_end, double step) {
  constexpr double kKeptPart = 0.03;  ///< of the window
  constexpr double kFinest = 0.05;    ///< of the first step; where that law came to rest, its steps are next to nothing
  std::vector<double> kept;
  for (const LawPiece& piece : before) {
    if (piece.start.s > s_begin + kKeptPart * (s_end - s_begin)) break;
    // Nor is the first one to be next to nothing.
    if (piece.start.s > s_begin + kFinest * step && piece.at(piece.duration).s - piece.start.s > kFinest * step)
      kept.push_back(piece.start.s);
  }
  return kept;
}

bool go_on_from(LawProblem& problem, const Window& window) {
  const AlongIntervals before = along_intervals(problem, *window.before);
  bool was_faster = false;
  for (std::size_t k = 0; k < before.size() && !was_faster; ++k)
    was_faster = before[k] && over_feed(problem, k, before[k]->q, kLaw);
  const bool too_fast = over_feed(problem, 0, problem.begin.v * problem.begin.v, kState);
  const bool yields = too_fast || (was_faster && (window.same_feed || overshoots(problem)));
  if (yields) yield_to_begin(problem, before, window);
  if (yields && window.same_feed) yield_to_law(problem, before);
  resume_from(problem, before);
  return yields;
}

}  // namespace rmac
