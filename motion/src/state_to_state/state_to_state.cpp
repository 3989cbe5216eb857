#include "rmac/motion/state_to_state.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "state_to_state/border.hpp"

namespace rmac {
namespace {

/// Durations and distances that differ by this part of themselves are the same: some thousand roundings.
constexpr double kSame = 1e-12;

/// Distance that phases cover from v, a; both move on.
double travel(const Phases& phases, double& v, double& a) noexcept {
  double distance = 0;
  for (std::size_t i = 0; i < phases.count; ++i) {
    const auto [t, j] = phases.phase[i];
    distance += t * (v + t * (a / 2 + t * j / 6));
    v += t * (a + t * j / 2);
    a += t * j;
  }
  return distance;
}

double duration_of(const Phases& phases) noexcept {
  double duration = 0;
  for (std::size_t i = 0; i < phases.count; ++i) duration += phases.phase[i].duration;
  return duration;
}

/// Phases of which the jerk is `share` of the one's and the rest of the other's: what is allowed for both is allowed
/// for it (eq. 13).
Phases mixed(const Phases& one, const Phases& other, double share) noexcept {
  Phases result;
  std::size_t i = 0, k = 0;
  double left_i = one.count > 0 ? one.phase[0].duration : 0, left_k = other.count > 0 ? other.phase[0].duration : 0;
  // Rounding may leave a trace of one when the other has ended: it still belongs to the acceleration.
  while (i < one.count || k < other.count) {
    const double step = i == one.count ? left_k : k == other.count ? left_i : std::min(left_i, left_k);
    const double jerk_i = i < one.count ? one.phase[i].jerk : 0, jerk_k = k < other.count ? other.phase[k].jerk : 0;
    result.add(step, share * jerk_i + (1 - share) * jerk_k);
    left_i -= step, left_k -= step;
    if (i < one.count && left_i <= 0 && ++i < one.count) left_i = one.phase[i].duration;
    if (k < other.count && left_k <= 0 && ++k < other.count) left_k = other.phase[k].duration;
  }
  return result;
}

/// One joint's way from state to state, in units in which its jerk limit is 1.
class JointWay {
 public:
  JointWay() = default;
  JointWay(const JointState& from, const JointState& to, const MotionBounds& bounds) noexcept;

  /// The shortest duration.
  [[nodiscard]] double fastest() noexcept;
  /// The shortest duration not below `duration` that this joint can take.
  [[nodiscard]] double next(double duration) noexcept;
  [[nodiscard]] JerkProfile profile(double duration) noexcept;
  [[nodiscard]] JerkProfile fastest_profile() noexcept;

 private:
  /// A duration, and where on the border it was found, if it was.
  struct Found {
    double duration;
    std::optional<Phases> phases;
  };
  [[nodiscard]] std::optional<Found> find(Border::Part part, double from) const noexcept;
  [[nodiscard]] Found find_all(double from) const noexcept;
  [[nodiscard]] JerkProfile assemble(const Phases& main) const noexcept;

  JointState from_;
  double jerk_ = 1;
  Phases before_, after_;  ///< into the bounds, and out of them
  double around_ = 0;      ///< duration of both
  Transfer transfer_{};
  double distance_ = 0;  ///< of the transfer
  Durations durations_{Transfer{0, 0, 0, 0, 1, 1, 1, 1}};
  double fastest_ = -1;
  Phases fastest_phases_;
};

JointWay::JointWay(const JointState& from, const JointState& to, const MotionBounds& bounds) noexcept
    : from_(from), jerk_(bounds.max_jerk) {
  const double unit = 1 / jerk_;
  transfer_ = {from.velocity * unit,           from.acceleration * unit,       to.velocity * unit,
               to.acceleration * unit,         bounds.max_velocity * unit,     -bounds.min_velocity * unit,
               bounds.max_acceleration * unit, -bounds.min_acceleration * unit};
  Transfer& x = transfer_;
  distance_ = (to.position - from.position) * unit;
  double v = x.v0, a = x.a0;
  before_ = bring_inside(x.v0, x.a0, x);
  distance_ -= travel(before_, v, a);
  Transfer back = x.reversed();
  v = back.v0, a = back.a0;
  after_ = bring_inside(back.v0, back.a0, back);
  distance_ -= travel(after_, v, a);
  after_.reverse();
  x.v1 = back.v0, x.a1 = -back.a0;
  around_ = duration_of(before_) + duration_of(after_);
  // What rounding left outside.
  const double settled_0 = settled_velocity(x.v0, x.a0), settled_1 = settled_velocity(x.v1, -x.a1);
  x.v_top = std::max({x.v_top, settled_0, settled_1});
  x.v_bottom = std::max({x.v_bottom, -settled_0, -settled_1});
  durations_ = Durations(x);
}

std::optional<JointWay::Found> JointWay::find(Border::Part part, double from) const noexcept {
  const double begin = part == Border::Part::Behind && durations_.gap() ? durations_.gap_end : durations_.shortest;
  const double duration = std::max(from, begin);
  const Border far(transfer_, durations_, part);
  const bool at_begin = from <= begin;
  const Border::Place far_place = at_begin ? far.begin() : far.at_duration(duration);
  const double farthest = far.distance(far_place);
  // The shortest duration may be a lonely one: rounding must not send a joint on the detour behind it.
  const double tolerance = kSame * (std::abs(distance_) + (std::abs(transfer_.v0) + std::abs(transfer_.v1)) * duration);
  if (at_begin && std::abs(distance_ - farthest) <= tolerance) return Found{duration, far.phases(far_place)};
  if (distance_ > farthest + tolerance) {
    const auto place = far.first_reaching(distance_, far_place);
    if (!place) return std::nullopt;
    return Found{far.duration(*place), far.phases(*place)};
  }
  const Border near(transfer_.mirrored(), durations_, part);
  const Border::Place near_place = at_begin ? near.begin() : near.at_duration(duration);
  if (!at_begin && -distance_ <= near.distance(near_place) + tolerance) return Found{duration, std::nullopt};
  const auto place = near.first_reaching(-distance_, near_place);
  if (!place) return std::nullopt;
  Found found{near.duration(*place), near.phases(*place)};
  found.phases->mirror();
  return found;
}

JointWay::Found JointWay::find_all(double from) const noexcept {
  if (durations_.gap() && from <= durations_.gap_begin) {
    if (auto found = find(Border::Part::BeforeGap, from)) return *found;
  }
  // Behind the gap every distance is reached in time: cruising has no end.
  return *find(Border::Part::Behind, from);
}

double JointWay::fastest() noexcept {
  if (fastest_ < 0) {
    Found found = find_all(0);
    fastest_ = found.duration;
    fastest_phases_ = *found.phases;
  }
  return fastest_ + around_;
}

double JointWay::next(double duration) noexcept {
  const double main = duration - around_;
  if (main <= fastest() - around_) return fastest_ + around_;
  return std::max(find_all(main).duration + around_, duration);
}

JerkProfile JointWay::assemble(const Phases& main) const noexcept {
  JerkProfile profile(from_);
  for (const Phases* phases : {&before_, &main, &after_}) {
    for (std::size_t i = 0; i < phases->count; ++i) {
      profile.append(phases->phase[i].duration, phases->phase[i].jerk * jerk_);
    }
  }
  return profile;
}

JerkProfile JointWay::fastest_profile() noexcept {
  (void)fastest();
  return assemble(fastest_phases_);
}

JerkProfile JointWay::profile(double duration) noexcept {
  const double main = duration - around_;
  if (main <= fastest() - around_ + kSame * duration) return fastest_profile();
  const auto part = durations_.gap() && main <= durations_.gap_begin ? Border::Part::BeforeGap : Border::Part::Behind;
  const Border far(transfer_, durations_, part), near(transfer_.mirrored(), durations_, part);
  const Border::Place far_place = far.at_duration(main), near_place = near.at_duration(main);
  const double high = far.distance(far_place), low = -near.distance(near_place);
  const double share = high > low ? std::clamp((distance_ - low) / (high - low), 0.0, 1.0) : 0.5;
  Phases nearest = near.phases(near_place);
  nearest.mirror();
  return assemble(mixed(far.phases(far_place), nearest, share));
}

}  // namespace

JerkProfile fastest_profile(const JointState& from, const JointState& to, const MotionBounds& bounds) noexcept {
  return JointWay(from, to, bounds).fastest_profile();
}

JerkProfile velocity_profile(const JointState& from, double velocity, const MotionBounds& bounds) noexcept {
  const double unit = 1 / bounds.max_jerk;
  Transfer x{from.velocity * unit,
             from.acceleration * unit,
             velocity * unit,
             0,
             bounds.max_velocity * unit,
             -bounds.min_velocity * unit,
             bounds.max_acceleration * unit,
             -bounds.min_acceleration * unit};
  const Phases before = bring_inside(x.v0, x.a0, x);
  const Phases change = fastest_change(x);
  JerkProfile profile(from);
  for (const Phases* phases : {&before, &change}) {
    for (std::size_t i = 0; i < phases->count; ++i) {
      profile.append(phases->phase[i].duration, phases->phase[i].jerk * bounds.max_jerk);
    }
  }
  return profile;
}

double synchronise(std::span<const JointState> from, std::span<const JointState> to,
                   std::span<const MotionBounds> bounds, std::span<JerkProfile> profiles) noexcept {
  constexpr std::size_t kMostJoints = 32;
  std::array<JointWay, kMostJoints> ways;
  const std::size_t count = std::min({from.size(), to.size(), bounds.size(), profiles.size(), kMostJoints});
  double duration = 0;
  for (std::size_t i = 0; i < count; ++i) {
    ways[i] = JointWay(from[i], to[i], bounds[i]);
    duration = std::max(duration, ways[i].fastest());
  }
  // A joint lengthens the duration past an interval that it cannot take; each has two of them at most, so this ends.
  for (bool longer = true; longer;) {
    longer = false;
    for (std::size_t i = 0; i < count; ++i) {
      const double next = ways[i].next(duration);
      if (next <= duration * (1 + kSame)) continue;
      duration = next;
      longer = true;
    }
  }
  for (std::size_t i = 0; i < count; ++i) profiles[i] = ways[i].profile(duration);
  return duration;
}

}  // namespace rmac
