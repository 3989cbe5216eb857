#include "time_law/braking_law.hpp"

#include <algorithm>
#include <cmath>

#include "time_law/law_problem.hpp"
#include "time_law/window.hpp"

namespace rmac {
namespace {

/// A step takes this part of the time that coming to rest takes about; and no less than that, at full speed.
constexpr double kStepsToRest = 100;
constexpr double kShortestStep_s = 1e-4;
/// What is left is travelled in one piece where the geometry allows, or once it is so short.
constexpr double kNearlyAtRest_s = 4e-3;
/// Parts of the limits that may be used: what lies between the ends of a step goes a little beyond them.
constexpr double kMostAcceleration = 0.999, kMostJerk = 0.998;
/// And what braking aims at.
constexpr double kPart = 0.99;
/// What is left is travelled in one piece at a jerk that is this part of what is allowed, or more.
constexpr double kLettingGo = 0.9;
/// mm: nearer places are the same.
constexpr double kSame = 1e-9;

/// How steps are taken again that led to where no step keeps the limits.
struct Retreat {
  std::size_t steps = 0;  ///< so many
  double slowing = 0;     ///< by how much they may become slower than the law before, as Braking::most_slowing
  double jerk = 0;        ///< with which an acceleration is met that was needed there, as a part of what is allowed
};
/// One try after the other.
constexpr Retreat kRetreats[] = {{5, 0.5, 0.7}, {10, 0.5, 0.6}, {20, 0.2, 0.5}, {40, 0.2, 0.3}, {80, 0, 0.2}};
/// Braking stays gentle for so long behind the place.
constexpr double kPastTrouble_s = 0.012;

/// Range of one number.
struct Range {
  double low = -kInfinity, high = kInfinity;

  /// -most <= offset + slope·x <= most.
  void take(double slope, double offset, double most) {
    if (std::abs(slope) < 1e-9) {
      if (std::abs(offset) > most) low = kInfinity;
      return;
    }
    const double a = (-most - offset) / slope, b = (most - offset) / slope;
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
  [[nodiscard]] bool empty() const { return !(low <= high); }
};

/// The state of a piece of law at a path length.
PathState state_where(const LawPiece& piece, double s) {
  const double ds = s - piece.start.s;
  if (piece.kind == LawPiece::Kind::Linear) {
    const double a = piece.start.a + piece.slope * ds;
    return {s, std::sqrt(std::max(piece.start.v * piece.start.v + ds * (piece.start.a + a), 0.0)), a};
  }
  PathState at = piece.start;
  double t = 0;
  for (int i = 0; i < 3 && at.v > 0; ++i) {
    t += (s - at.s) / at.v;
    at = piece.at(t);
  }
  return at;
}

class Brake {
 public:
  Brake(const PathView& path, const std::vector<JointLimits>& joints, const Braking& braking)
      : path_(path), joints_(joints), braking_(braking), at_(braking.begin) {}

  [[nodiscard]] bool run(int& steps_left) {
    if (!enter_stretch()) return false;
    for (; steps_left > 0; --steps_left) {
      if (at_.s >= braking_.s_latest) return false;
      if (comes_to_rest()) return true;
      if (!go_on() && !retreat()) return false;
    }
    return false;
  }
  [[nodiscard]] std::vector<LawPiece>& law() { return law_; }

 private:
  /// The smooth stretch that begins where the state is.
  [[nodiscard]] bool enter_stretch() {
    index_ = path_.find(at_.s, 1);
    const PathSegment& segment = path_.segment(index_);
    const double local = at_.s - path_.start(index_);
    const auto breaks = segment.curve().breaks();
    const auto next = std::upper_bound(breaks.begin(), breaks.end(), local + kSame);
    border_ = path_.start(index_) + (next == breaks.end() ? segment.length() : *next);
    return path_.derivatives(just_inside(at_.s, border_), 1, here_) == KinematicsStatus::Ok;
  }

  /// Where no step keeps the limits, those before were wrong: the last ones are taken again, more gently, and more of
  /// them each time.
  [[nodiscard]] bool retreat() {
    if (law_.empty()) return false;
    tries_ = at_.s < gentle_until_ ? tries_ + 1 : 0;
    if (tries_ == std::size(kRetreats)) return false;
    retreat_ = kRetreats[tries_];
    gentle_until_ = std::max(gentle_until_, at_.s + kPastTrouble_s * at_.v);
    const LawPiece again = law_[law_.size() - std::min(law_.size(), retreat_.steps)];
    law_.resize(law_.size() - std::min(law_.size(), retreat_.steps));
    at_ = again.start;
    t_ = again.t0;
    last_jerk_ = law_.empty() ? 0 : law_.back().slope;
    piece_ = 0;
    return enter_stretch();
  }

  /// How far the geometry lets a step go: not over a narrower interval between its nodes.
  [[nodiscard]] double geometry_step() const {
    const auto nodes = path_.segment(index_).nodes();
    const double local = at_.s - path_.start(index_);
    const auto next = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, local + kSame);
    const double width = *next - *(next - 1);
    return next + 1 == nodes.end() ? width : std::min(width, *(next + 1) - local);
  }

  /// About the time that coming to rest takes from here.
  [[nodiscard]] double time_to_rest() const {
    double acceleration = kInfinity, jerk = kInfinity;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const double share = std::max(std::abs(here_.d[1][j]), 1e-9);
      acceleration = std::min(acceleration, joints_[j].max_acceleration / share);
      jerk = std::min(jerk, joints_[j].max_jerk / share);
    }
    const double rising = std::max(at_.a, 0.0), v = at_.v + 0.5 * rising * rising / jerk;
    const double ramp = ramp_time(v, acceleration, jerk);
    return rising / jerk + (at_.a < 0 ? std::min(ramp, 2 * at_.v / -at_.a) : ramp);
  }

  /// The path jerk that the joints' jerks allow at a place.
  [[nodiscard]] Range jerk_bounds(const JointPoint& point, const PathState& at, double part) const {
    Range bounds;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const double turning = at.v * (point.d[3][j] * at.v * at.v + 3 * point.d[2][j] * at.a);
      bounds.take(point.d[1][j], turning, part * joints_[j].max_jerk);
    }
    return bounds;
  }

  /// The path acceleration that the joints' accelerations and the move allow.
  [[nodiscard]] Range acceleration_bounds(const JointPoint& point, double v, double part) const {
    Range bounds;
    for (std::size_t j = 0; j < joints_.size(); ++j)
      bounds.take(point.d[1][j], point.d[2][j] * v * v, part * joints_[j].max_acceleration);
    const PathDemand& demand = path_.segment(index_).demand();
    if (demand.accel_rise_mm_s2 > 0) bounds.high = std::min(bounds.high, part * demand.accel_rise_mm_s2);
    if (demand.accel_fall_mm_s2 > 0) bounds.low = std::max(bounds.low, -part * demand.accel_fall_mm_s2);
    return bounds;
  }

  /// The acceleration at the end of a step from where this jerk just brings speed and acceleration to zero together,
  /// which is a² = 2 jerk v there (eq. 16).
  [[nodiscard]] double letting_go(double dt, double jerk) const {
    const double v = at_.v + 0.5 * at_.a * dt, most = jerk * dt;
    return 0.5 * (most - std::sqrt(std::max(most * most + 8 * jerk * v, 0.0)));
  }

  /// The least acceleration at path length s and speed v that is not slower than the law before by more than it may.
  [[nodiscard]] double gentle(const PathState& then) {
    const double slowing =
        then.s < gentle_until_ ? std::min(retreat_.slowing, braking_.most_slowing) : braking_.most_slowing;
    if (!std::isfinite(slowing)) return -kInfinity;
    const std::vector<LawPiece>& law = braking_.leaves;
    while (piece_ + 1 < law.size() && law[piece_ + 1].start.s <= then.s) ++piece_;
    const PathState before = state_where(law[piece_], then.s);
    if (!(before.v > 0)) return -kInfinity;
    return before.a * then.v * then.v / (before.v * before.v) - slowing * before.v;
  }

  /// The least acceleration from which the one can be reached that was needed further on.
  [[nodiscard]] double in_time(const PathState& then) const {
    if (then.s >= needed_.s) return -kInfinity;
    return needed_.a - retreat_.jerk * needed_.most_jerk * (needed_.s - then.s) / then.v;
  }

  [[nodiscard]] PathState after(double dt, double jerk) const {
    return LawPiece{0, at_, jerk, dt, LawPiece::Kind::Jerk}.at(dt);
  }

  /// The state after a step, which ends at the border where it would go beyond; false where it would not go on.
  [[nodiscard]] bool end_of_step(double jerk, double& dt, PathState& then, bool& at_border) const {
    then = after(dt, jerk);
    at_border = at_border || then.s > border_ - kSame;
    for (int i = 0; at_border && i < 6 && dt > 0; ++i) {
      dt -= (then.s - border_) / std::max(then.v, 1e-9);
      then = after(dt, jerk);
    }
    return dt > 0 && then.v > 0;
  }

  [[nodiscard]] bool go_on() {
    const double by_geometry = geometry_step() / at_.v;
    const Range begin = jerk_bounds(here_, at_, kMostJerk);
    if (begin.empty()) return false;
    for (double step = std::max(std::min(time_to_rest() / kStepsToRest, by_geometry), kShortestStep_s);
         step > 1e-9 * kShortestStep_s; step *= 0.5) {
      double dt = step, jerk = std::clamp(last_jerk_, begin.low, begin.high);
      PathState then;
      bool at_border = false;
      if (!end_of_step(jerk, dt, then, at_border)) continue;
      const double s = std::min(then.s, just_inside(border_, at_.s));
      if (path_.derivatives(s, -1, there_) != KinematicsStatus::Ok) return false;
      const auto chosen = jerk_of_step(begin, dt, then);
      if (!chosen) return false;
      jerk = *chosen;
      last_jerk_ = jerk;
      if (!end_of_step(jerk, dt, then, at_border)) continue;
      law_.push_back({t_, at_, jerk, dt, LawPiece::Kind::Jerk});
      t_ += dt;
      at_ = then;
      if (!at_border) {
        here_ = there_;
        return true;
      }
      at_.s = border_;
      return at_.s < braking_.s_latest && enter_stretch();
    }
    return false;
  }

  /// The jerk of a step of which the end is about `then`; nothing where no jerk keeps the limits.
  [[nodiscard]] std::optional<double> jerk_of_step(Range allowed, double dt, const PathState& then) {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const double d1 = there_.d[1][j], bend = 3 * there_.d[2][j] * then.v;
      allowed.take(bend * dt + d1, there_.d[3][j] * then.v * then.v * then.v + bend * at_.a,
                   kMostJerk * joints_[j].max_jerk);
    }
    const Range allowed_jerk = allowed;
    const Range most = acceleration_bounds(there_, then.v, kMostAcceleration);
    allowed.low = std::max(allowed.low, (most.low - at_.a) / dt);
    allowed.high = std::min(allowed.high, (most.high - at_.a) / dt);
    if (allowed.empty()) {
      if (const double most_jerk = allowed_jerk.high; (most.low - at_.a) / dt > most_jerk && most_jerk > 0)
        needed_ = {then.s, most.low, most_jerk};
      return std::nullopt;
    }
    const double hardest = std::min(acceleration_bounds(there_, then.v, kPart).low, 0.0);
    const Range release = jerk_bounds(there_, then, kPart);
    const double let_go = letting_go(dt, std::max(release.high, -1e-3 * release.low));
    const double wish = std::max({hardest, let_go, gentle(then), in_time(then)});
    return std::clamp((wish - at_.a) / dt, allowed.low, allowed.high);
  }

  /// Whether the last stretch, at constant jerk, can begin here; then it is in the law.
  [[nodiscard]] bool comes_to_rest() {
    if (!(at_.a < 0)) return false;
    const double jerk = at_.a * at_.a / (2 * at_.v), time = 2 * at_.v / -at_.a, length = at_.v * time / 3;
    const double end = at_.s + length;
    if (end > braking_.s_latest || end > border_) return false;
    // Who has hardly begun to brake could rest that way too, in a long time.
    const bool lets_go = jerk > kLettingGo * jerk_bounds(here_, at_, kPart).high;
    if ((length > geometry_step() || !lets_go) && time > kNearlyAtRest_s) return false;
    const auto allowed = [&](const JointPoint& point, const PathState& state) {
      return jerk <= jerk_bounds(point, state, kMostJerk).high;
    };
    if (!allowed(here_, at_)) return false;
    for (const double part : {0.5, 1.0}) {
      const PathState state = part < 1 ? after(part * time, jerk) : PathState{end, 0, 0};
      const double s = std::min(state.s, just_inside(end, at_.s));
      if (path_.derivatives(s, -1, there_) != KinematicsStatus::Ok || !allowed(there_, state)) return false;
    }
    law_.push_back({t_, at_, jerk, time, LawPiece::Kind::Jerk});
    return true;
  }

  const PathView& path_;
  const std::vector<JointLimits>& joints_;
  const Braking& braking_;
  PathState at_;
  double t_ = 0, last_jerk_ = 0;
  std::size_t index_ = 0;  ///< of the segment that the state is on
  double border_ = 0;      ///< where its smooth stretch ends
  std::size_t piece_ = 0;  ///< of the law before
  /// Where a step failed for want of an acceleration, and the jerk that was allowed on the way to it.
  struct Needed {
    double s = -kInfinity, a = 0, most_jerk = 0;
  };
  Needed needed_;
  Retreat retreat_;                   ///< the last one
  std::size_t tries_ = 0;             ///< from one place
  double gentle_until_ = -kInfinity;  ///< path length up to which steps are taken as it says
  JointPoint here_, there_;           ///< at the state, and where the step ends
  std::vector<LawPiece> law_;
};

}  // namespace

std::optional<std::vector<LawPiece>> braking_law(const PathView& path, const std::vector<JointLimits>& joints,
                                                 const Braking& braking, int& steps_left) {
  Brake brake(path, joints, braking);
  if (!(braking.begin.v > 0) || !brake.run(steps_left)) return std::nullopt;
  return std::move(brake.law());
}

}  // namespace rmac
