#include "servo/setpoint/contact_effort.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {
namespace {

/// rad a cycle: a third of a radian of delay stays for what else there is between effort and force.
constexpr double kBandwidth = 0.04, kLowPass = 0.25;
/// The outer integral's reset time, in times that the loop takes.
constexpr double kOuterReset = 8;

}  // namespace

ContactEffort::ContactEffort(double period_s) noexcept : period_s_(period_s), part_a_cycle_(1 - std::exp(-kLowPass)) {}

double ContactEffort::step(double error, const Limits& limits) noexcept {
  smoothed_ += part_a_cycle_ * (error - smoothed_);
  smooth_ += part_a_cycle_ * (smoothed_ - smooth_);
  const double bandwidth = std::min(kBandwidth / period_s_, limits.bandwidth_rad_s);
  const double reset_s = std::max(kOuterReset / bandwidth, limits.reset_time_s);
  const double pushes = bandwidth * smooth_ + rate_;
  if (pushes * limits.bounded > 0) return effort_;
  rate_ += bandwidth / reset_s * std::clamp(smooth_, -limits.largest_error, limits.largest_error) * period_s_;
  effort_ += pushes * period_s_;
  return effort_;
}

}  // namespace rmac
