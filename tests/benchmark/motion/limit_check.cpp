#include "limit_check.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::bench {
namespace {

using Real = long double;

/// Differences are not taken over less than this: rounding of positions (3e-14 mm) would show as jerk.
constexpr Real kShortestStep_s = 60e-6L;
constexpr int kSamples = 16;

struct State {
  Real s, v;
};

/// Path length and speed t after a piece began: a = a0 + k (s - s0) integrated, or constant jerk.
State state_of(const LawPiece& piece, Real t) {
  const Real v0 = piece.start.v, a0 = piece.start.a, k = piece.slope;
  if (piece.kind == LawPiece::Kind::Jerk)
    return {piece.start.s + t * (v0 + t * (a0 / 2 + t * k / 6)), v0 + t * (a0 + t * k / 2)};
  const Real z = k * t * t;
  Real c, s, d;  // cosh w, sinh w / w, (cosh w - 1) / w², w² = z
  if (std::abs(z) < 1e-2L) {
    c = 1 + z / 2 * (1 + z / 12 * (1 + z / 30 * (1 + z / 56 * (1 + z / 90))));
    s = 1 + z / 6 * (1 + z / 20 * (1 + z / 42 * (1 + z / 72 * (1 + z / 110))));
    d = 0.5L * (1 + z / 12 * (1 + z / 30 * (1 + z / 56 * (1 + z / 90 * (1 + z / 132)))));
  } else {
    const Real w = std::sqrt(std::abs(z));
    c = z > 0 ? std::cosh(w) : std::cos(w);
    s = (z > 0 ? std::sinh(w) : std::sin(w)) / w;
    d = (c - 1) / z;
  }
  return {piece.start.s + v0 * t * s + a0 * t * t * d, v0 * c + a0 * t * s};
}

}  // namespace

void LimitCheck::joints_at(const Plan& plan, std::size_t segment, long double s, double* joints) const {
  const Real local = s - static_cast<Real>(plan.segment_start[segment]);
  const PathSegment& on = *plan.segments[segment];
  JointPoint point;
  const auto status = on.evaluate(std::clamp(static_cast<double>(local), 0.0, on.length()), 0, 1, point);
  for (std::size_t j = 0; j < joints_.size(); ++j)
    joints[j] = status == KinematicsStatus::Ok ? point.d[0][j] : std::nan("");
}

void LimitCheck::travelled(const Plan& plan, double from_s, double to_s, double override_factor) {
  std::vector<std::array<double, kMaxJoints>> samples;
  std::vector<Real> speeds;
  const auto raise = [](double& peak, double value) {
    if (!(value <= peak)) peak = std::isfinite(value) ? value : 1e300;
  };
  for (std::size_t i = 0; i < plan.law.size(); ++i) {
    const LawPiece& piece = plan.law[i];
    const Real begin = std::max<Real>(piece.t0, from_s),
               end = std::min<Real>(piece.t0 + static_cast<Real>(piece.duration), to_s);
    if (!(end > begin)) continue;
    // A piece shorter than differences need is looked at together with what lies around it.
    Real first = begin, last = end;
    if (last - first < 3 * kShortestStep_s) {
      const Real middle = (first + last) / 2;
      first = std::max<Real>(from_s, middle - 1.5L * kShortestStep_s);
      last = std::min<Real>(to_s, first + 3 * kShortestStep_s);
      first = std::max<Real>(from_s, last - 3 * kShortestStep_s);
      if (last - first < 2.9L * kShortestStep_s) continue;
    }
    const int steps = std::clamp(static_cast<int>((last - first) / kShortestStep_s + 1e-9L), 3, kSamples);
    const Real dt = (last - first) / steps;
    samples.resize(static_cast<std::size_t>(steps) + 1);
    std::size_t at = i;
    // The piece's own segment, so that both sides of a seam are seen from inside.
    const bool inside = first == begin && last == end;
    const Real s_middle = state_of(piece, (begin + end) / 2 - piece.t0).s;
    const auto segment_of = [&](Real s) {
      const auto above = std::upper_bound(plan.segment_start.begin(), plan.segment_start.end(), static_cast<double>(s));
      return above == plan.segment_start.begin() ? 0U
                                                 : static_cast<std::size_t>(above - plan.segment_start.begin()) - 1;
    };
    const std::size_t middle_segment = segment_of(s_middle);
    for (int n = 0; n <= steps; ++n) {
      const Real t = first + dt * n;
      if (!inside) {
        while (at > 0 && t < plan.law[at].t0) --at;
        while (at + 1 < plan.law.size() && t >= plan.law[at + 1].t0) ++at;
      }
      const LawPiece& on = plan.law[at];
      const State state = state_of(on, std::min<Real>(t - on.t0, on.duration));
      joints_at(plan, inside ? middle_segment : segment_of(state.s), state.s,
                samples[static_cast<std::size_t>(n)].data());
      const double programmed =
          std::min(plan.segments[middle_segment]->demand().feed_mm_s * override_factor, largest_feed_);
      if (!plan.segments[middle_segment]->curve().in_joint_space() && inside)
        raise(fine_.feed, static_cast<double>(state.v) / programmed);
    }
    const double step = static_cast<double>(dt);
    for (std::size_t n = 0; n < samples.size(); ++n) {
      for (std::size_t j = 0; j < joints_.size(); ++j) {
        const auto x = [&](std::size_t back) { return samples[n - back][j]; };
        if (n >= 1) raise(fine_.speed, std::abs(x(0) - x(1)) / step / joints_[j].max_speed);
        if (n >= 2)
          raise(fine_.acceleration, std::abs(x(0) - 2 * x(1) + x(2)) / (step * step) / joints_[j].max_acceleration);
        if (n >= 3) {
          const double before = fine_.jerk;
          raise(fine_.jerk, std::abs(x(0) - 3 * x(1) + 3 * x(2) - x(3)) / (step * step * step) / joints_[j].max_jerk);
          if (fine_.jerk > before) {
            jerk_at_t = static_cast<double>(first + dt * static_cast<Real>(n));
            jerk_at_s = static_cast<double>(s_middle);
            jerk_joint = j;
            jerk_plan = plan.id;
          }
        }
      }
    }
  }
}

void LimitCheck::setpoint(const Setpoint& setpoint) {
  constexpr double dt = 0.001;
  if (last_.size() == 4) last_.erase(last_.begin());
  const auto& d = setpoint.position;
  const std::size_t n = last_.size();
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const auto x = [&](std::size_t back) { return back == 0 ? d[j] : last_[n - back][j]; };
    if (n >= 1) coarse_.speed = std::max(coarse_.speed, std::abs(x(0) - x(1)) / dt / joints_[j].max_speed);
    if (n >= 2)
      coarse_.acceleration =
          std::max(coarse_.acceleration, std::abs(x(0) - 2 * x(1) + x(2)) / (dt * dt) / joints_[j].max_acceleration);
    if (n >= 3)
      coarse_.jerk =
          std::max(coarse_.jerk, std::abs(x(0) - 3 * x(1) + 3 * x(2) - x(3)) / (dt * dt * dt) / joints_[j].max_jerk);
  }
  last_.push_back(d);
}

}  // namespace rmac::bench
