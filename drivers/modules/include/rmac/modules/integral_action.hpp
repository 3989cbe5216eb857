#pragma once

#include <algorithm>
#include <cmath>

namespace rmac::modules {

/// The part of a law's effort that does not follow from this cycle's input: ∫ Ki·e dt. It makes a law bumpless, because
/// it takes up whatever the rest of the law would have the output jump by; and it does not wind up, because it stands
/// still while the output is at its limit and the error would drive it further (conditional integration).
///
/// With Ki = 0 nothing would ever take such an offset out again, so then it fades with `kFadeS`.
class IntegralAction {
 public:
  static constexpr double kFadeS = 0.5;

  void set_gain(double ki) noexcept { ki_ = ki; }
  /// Lets the next output be `effort`, when the rest of the law then gives `others` and the error is `error`.
  void start(double effort, double others, double error, double period_s) noexcept {
    value_ = effort - others - ki_ * error * period_s;
  }
  /// False: its value only fades.
  [[nodiscard]] bool grows() const noexcept { return ki_ > 0; }
  [[nodiscard]] double value() const noexcept { return value_; }
  /// Takes up a change of the rest of the law by -`effort`.
  void shift(double effort) noexcept { value_ += effort; }

  /// One cycle: the law's output, within ±`limit`.
  [[nodiscard]] double output(double others, double error, double period_s, double limit) noexcept {
    const double grown = value_ + ki_ * error * period_s;
    const double wanted = others + grown;
    const bool winds_up = std::abs(wanted) > limit && wanted * error > 0;
    if (!winds_up) value_ = grown;
    if (ki_ == 0) value_ *= kFadeS / (kFadeS + period_s);
    return std::clamp(wanted, -limit, limit);
  }

 private:
  double ki_ = 0;
  double value_ = 0;  ///< effort
};

}  // namespace rmac::modules
