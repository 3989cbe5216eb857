#include "servo/spindles/overload_watch.hpp"

#include <cmath>

namespace rmac {

namespace {

constexpr double kOverloadS = 0.1;
/// A drive that gives all that it may measures it but for rounding.
constexpr double kAtBound = 0.999;

}  // namespace

bool OverloadWatch::step(double wanted_rpm, double rpm, double torque_nm, double bound_nm) noexcept {
  if (wanted_rpm != wanted_rpm_) {
    wanted_rpm_ = wanted_rpm;
    since_change_s_ = 0;
    arrived_ = false;
  }
  since_change_s_ += period_s_;
  arrived_ = arrived_ || since_change_s_ > timeout_s_ || std::abs(rpm - wanted_rpm) <= tolerance_rpm_;
  const bool over = bound_nm > 0 && arrived_ && std::abs(torque_nm) >= kAtBound * bound_nm;
  over_s_ = over ? over_s_ + period_s_ : 0;
  return over_s_ >= kOverloadS;
}

}  // namespace rmac
