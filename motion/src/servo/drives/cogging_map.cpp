#include "servo/drives/cogging_map.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

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
  std::array<Wave, std::bit_width(static_cast<unsigned>(CoggingMap::kHighestOrder))>
      doubled_;  ///< of the angle, twice, four times … the angle
};

}  // namespace

CoggingMap::CoggingMap(const Cogging& cogging) : harmonics_(cogging.harmonics) {
  if (harmonics_.empty()) return;
  base_ = std::accumulate(harmonics_.begin(), harmonics_.end(), 0,
                          [](int base, const Cogging::Harmonic& one) { return std::gcd(base, one.order); });
  for (Cogging::Harmonic& one : harmonics_) highest_ = std::max(highest_, one.order /= base_);
}

double CoggingMap::torque_nm(double turns) const noexcept {
  const double along = base_ * turns;
  const Multiples multiples(2 * std::numbers::pi * (along - std::floor(along)), highest_);
  double torque = 0;
  for (const Cogging::Harmonic& one : harmonics_) {
    const Multiples::Wave wave = multiples.of(one.order);
    torque += one.cosine_nm * wave.cosine + one.sine_nm * wave.sine;
  }
  return torque;
}

}  // namespace rmac
