#include "time_law/window_begin.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "time_law/speed_bound.hpp"

namespace rmac {
namespace {

/// A square of a speed that exceeds its bound by no more is not faster.
constexpr double kAsFast = 1 + 1e-5;

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

/// Whether a state that is not too fast yet becomes so whatever is done: braking that leaves half of the bounds to what
/// else there is to do is too fast somewhere.
bool overshoots(const LawProblem& problem) {
  const std::vector<double> q = braking_from_begin(problem, 0.5).q;
  return !std::equal(q.begin(), q.end(), problem.speed_cap.begin(),
                     [](double at, double cap) { return at <= kAsFast * cap; });
}

/// Lets the bounds of speed give way to the state at the begin, as far as gentle braking needs.
void yield_to_begin(LawProblem& problem) {
  const auto [q, a] = braking_from_begin(problem, 0.25);
  for (std::size_t k = 0; k < q.size(); ++k) {
    double& cap = problem.speed_cap[k];
    cap = std::max(cap, q[k] * 1.02 + 2 * std::max(a[k], 0.0) * problem.step(k));
  }
}

/// The square of the speed along a piece of law, and its slopes: q, q'/2 and q''/2.
struct SquaredSpeed {
  double q = 0, a = 0, bend = 0;
};

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
std::vector<std::optional<SquaredSpeed>> along_intervals(const LawProblem& problem,
                                                         const std::vector<LawPiece>& before) {
  std::vector<std::optional<SquaredSpeed>> along(problem.intervals());
  std::size_t piece = 0;
  for (std::size_t k = 0; k < problem.intervals(); ++k) {
    const double middle = problem.nodes[k] + problem.step(k) / 2;
    while (piece + 1 < before.size() && before[piece + 1].start.s <= middle) ++piece;
    if (piece + 1 < before.size()) along[k] = squared_speed(before[piece], middle);
  }
  return along;
}

/// Lets the next law start from the one before. Its state lies at the edge of what is viable, so the first stretch may
/// use most of the margin that the law before left; and what that law had is the first guess (eq. 8). Where a feed
/// gives way to that law (`yields`), it does so as far as the law went.
void resume_from(LawProblem& problem, const std::vector<std::optional<SquaredSpeed>>& before, bool yields) {
  constexpr double kRelaxed = 0.9997 / kLawMargin;
  constexpr double kEasing = 0.1;  ///< of the window
  const double span = problem.nodes.back() - problem.nodes.front();
  problem.travelled_before.assign(problem.intervals() + 2, 0.0);
  for (std::size_t k = 0; k < problem.intervals(); ++k) {
    if (problem.nodes[k] - problem.nodes.front() < 0.25 * span) {
      for (auto* bound : {&problem.tightening, &problem.rise, &problem.fall}) (*bound)[k] *= kRelaxed;
    }
    if (!before[k]) continue;
    const SquaredSpeed& at = *before[k];
    const double h = problem.step(k), middle = problem.nodes[k] + h / 2;
    // A little slower, which is inside the bounds; but not at once, which would be a jerk.
    const double into = std::min((middle - problem.nodes.front()) / (kEasing * span), 1.0);
    const double part = 1 - 0.005 * into * into * (3 - 2 * into);
    problem.travelled_before[k + 1] = std::max(0.0, part * (at.q - h * h / 4 * at.bend));
    const double most = at.q + h * std::abs(at.a) + h * h / 4 * std::abs(at.bend);
    if (yields) problem.speed_cap[k] = std::max(problem.speed_cap[k], 1.01 * most);
  }
}

}  // namespace

std::vector<double> nodes_kept(const std::vector<LawPiece>& before, double s_begin, double s_end, double step) {
  constexpr double kKeptPart = 0.03;  ///< of the window
  constexpr double kFinest = 0.05;    ///< of the first step; where that law came to rest, its steps are next to nothing
  std::vector<double> kept;
  for (const LawPiece& piece : before) {
    if (piece.start.s > s_begin + kKeptPart * (s_end - s_begin)) break;
    if (piece.start.s > s_begin && piece.at(piece.duration).s - piece.start.s > kFinest * step)
      kept.push_back(piece.start.s);
  }
  return kept;
}

bool go_on_from(LawProblem& problem, const Window& window) {
  const auto before = along_intervals(problem, *window.before);
  const bool too_fast = problem.begin.v * problem.begin.v > kAsFast * problem.speed_cap[0];
  const bool was_faster = !std::equal(before.begin(), before.end(), problem.speed_cap.begin(),
                                      [](const auto& at, double cap) { return !at || at->q <= kAsFast * cap; });
  const bool yields = too_fast || (was_faster && (window.same_feed || overshoots(problem)));
  if (yields) yield_to_begin(problem);
  resume_from(problem, before, yields && window.same_feed);
  return yields;
}

}  // namespace rmac
