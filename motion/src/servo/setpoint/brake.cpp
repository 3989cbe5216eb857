#include "servo/setpoint/brake.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {

void Brake::begin(std::span<const double> velocities, std::span<const double> decelerations) noexcept {
  takes_s_ = braked_s_ = 0;
  for (std::size_t j = 0; j < velocities.size(); ++j) {
    from_[j] = velocities[j];
    if (decelerations[j] > 0) takes_s_ = std::max(takes_s_, std::abs(from_[j]) / decelerations[j]);
  }
}

void Brake::step(double period_s) noexcept {
  braked_s_ = std::min(braked_s_ + period_s, takes_s_);
}

}  // namespace rmac
