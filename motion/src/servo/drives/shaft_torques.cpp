#include "servo/drives/shaft_torques.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "rmac/motion/drive_scale.hpp"

namespace rmac {

namespace {

/// Cosine and sine of multiples of an angle, by products: a few of them cost less than the library's one.
class Multiples {
 public:
  Multiples(double angle, int highest) noexcept {
    doubled_[0] = {std::cos(angle), std::sin(angle)};
    for (std::size_t i = 1; (highest >> i) != 0; ++i) doubled_[i] = product(doubled_[i - 1], doubled_[i - 1]);
  }
  struct Wave {
    double cosine = 1, sine = 0;
  };
  /// 1 to `highest`.
  [[nodiscard]] Wave of(int order) const noexcept {
    const auto bits = static_cast<unsigned>(order);
    auto bit = static_cast<std::size_t>(std::countr_zero(bits));
    Wave wave = doubled_[bit];
    while ((bits >> ++bit) != 0) {
      if (((bits >> bit) & 1U) != 0) wave = product(wave, doubled_[bit]);
    }
    return wave;
  }

 private:
  static Wave product(const Wave& a, const Wave& b) noexcept {
    return {a.cosine * b.cosine - a.sine * b.sine, a.cosine * b.sine + a.sine * b.cosine};
  }
  std::array<Wave, std::bit_width(static_cast<unsigned>(ShaftTorques::kHighestOrder))>
      doubled_;  ///< of the angle, twice, four times … the angle
};

/// At the shaft, in its sense.
double cogging_nm(const ServoActuator& actuator, double shaft_rad) noexcept {
  const DriveScale& scale = actuator.scale;
  const double turn = shaft_counts(scale, shaft_rad) / scale.counts_per_revolution;
  const double angle = 2 * std::numbers::pi * (turn - std::floor(turn));
  int highest = 1;
  for (const Cogging::Harmonic& one : actuator.cogging.harmonics) highest = std::max(highest, one.order);
  const Multiples multiples(angle, highest);
  double torque = 0;
  for (const Cogging::Harmonic& one : actuator.cogging.harmonics) {
    const Multiples::Wave wave = multiples.of(one.order);
    torque += one.cosine_nm * wave.cosine + one.sine_nm * wave.sine;
  }
  return scale.direction * torque;
}

}  // namespace

ShaftTorques::ShaftTorques(const ActuatorMap& map, std::span<const ServoActuator> actuators, double period_s) noexcept
    : map_(map), actuators_(actuators), period_s_(period_s) {
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    if (!actuators[i].cogging.harmonics.empty()) cogging_ |= only(i);
  }
}

void ShaftTorques::make(std::span<const double> joints, std::span<const double> efforts, FaultSink& faults) noexcept {
  map_.actuator_efforts(joints, efforts, {torque_.data(), actuators_.size()});
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (std::isfinite(torque_[i])) continue;
    faults.raise(
        {ServoFault::Kind::NotANumber, ServoFault::Part::Actuator, static_cast<std::uint32_t>(i), torque_[i], 0});
    let_go();
    return;
  }
}

void ShaftTorques::cancel_cogging(std::span<const double> measured, std::span<const double> wanted,
                                  IndexSet followed) noexcept {
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (!has(cogging_ & followed, i) || !std::isfinite(wanted[i])) continue;
    const double way = has(followed_, i) ? wanted[i] - wanted_before_[i] : 0;
    torque_[i] -= cogging_nm(actuators_[i], measured[i] + way * actuators_[i].cogging.lead_s / period_s_);
    wanted_before_[i] = wanted[i];
  }
  followed_ = followed;
}

}  // namespace rmac
