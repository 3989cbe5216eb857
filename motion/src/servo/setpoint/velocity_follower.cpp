#include "servo/setpoint/velocity_follower.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {

namespace {

/// Share of the following-error bound that the joint may be behind its setpoint; and with the way that it goes until it
/// tells where it is, and that of the next cycle.
constexpr double kMostBehind = 0.5;
constexpr double kMostSeen = 0.9;

/// The largest speed from which `way` is enough to come to rest after one more cycle: v T + v² / 2a = way.
double speed_before_end(double way, double deceleration, double period_s) noexcept {
  if (way <= 0 || std::isinf(way)) return std::max(way, 0.0);
  const double braking = deceleration > 0 ? 2 * way / deceleration : 0;
  return 2 * way / (period_s + std::sqrt(period_s * period_s + braking));
}

}  // namespace

JointSetpoint VelocityFollower::step(const JointSetpoint& planned, double held, double measured) noexcept {
  const JointBounds& bounds = joint_->bounds;
  const double most = joint_->max_following_error;
  const double speed = std::abs(planned.velocity);
  const double behind = std::min(kMostBehind * most + speed * late_s_,
                                 std::max(kMostBehind * most, kMostSeen * most - speed * period_s_));
  const double from = std::clamp(held, measured - behind, measured + behind);
  const auto fastest = [&](double way) { return speed_before_end(way, bounds.stop_deceleration, period_s_); };
  const double velocity =
      std::clamp(planned.velocity, -fastest(from - bounds.min_position), fastest(bounds.max_position - from));
  const double acceleration = velocity == planned.velocity ? planned.acceleration : 0;
  if (from == held && velocity == planned.velocity) {
    return {planned.position + slip_, velocity, acceleration};
  }
  const double position = from + velocity * period_s_;
  slip_ = position - planned.position;
  return {position, velocity, acceleration};
}

}  // namespace rmac
