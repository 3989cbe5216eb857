#include "servo/setpoint/contact_effort.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {
namespace {

/// What joint and part swing by, from some 10 Hz to 200, the low-pass keeps from the loop. Where a cycle is longer than
/// a thousandth of a second, both are as much slower.
constexpr double kBandwidth_rad_s = 40, kLowPass_rad_s = 250, kCycle_s = 0.001;
/// The outer integral's reset time, in times that the loop takes.
constexpr double kOuterReset = 8;

/// Of what a short cycle allows.
double share(double period_s) noexcept {
  return std::min(1.0, kCycle_s / period_s);
}

}  // namespace

ContactEffort::ContactEffort(double period_s) noexcept
    : period_s_(period_s), part_a_cycle_(1 - std::exp(-share(period_s) * kLowPass_rad_s * period_s)) {}

double ContactEffort::step(double error, const Limits& limits) noexcept {
  smoothed_ += part_a_cycle_ * (error - smoothed_);
  smooth_ += part_a_cycle_ * (smoothed_ - smooth_);
  const double bandwidth = std::min(share(period_s_) * kBandwidth_rad_s, limits.bandwidth_rad_s);
  const double reset_s = std::max(kOuterReset / bandwidth, limits.reset_time_s);
  const double pushes = bandwidth * smooth_ + rate_;
  const auto bounded = [&limits](double way) { return way > 0 ? limits.no_more : limits.no_less; };
  if (!bounded(smooth_))
    rate_ += bandwidth / reset_s * std::clamp(smooth_, -limits.largest_error, limits.largest_error) * period_s_;
  if (!bounded(pushes)) effort_ += pushes * period_s_;
  return effort_;
}

}  // namespace rmac
