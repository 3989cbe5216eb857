#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "rmac/modules/error_signal.hpp"
#include "rmac/modules/integral_action.hpp"
#include "rmac/sdk/parameters.hpp"

namespace rmac::modules {

/// Kp·e + Kd·ė + ∫ Ki·e dt on top of an effort that is known beforehand, within one limit for the sum.
class PidFeedback {
 public:
  explicit PidFeedback(const ErrorSignal::Parameters& parameters) noexcept : signal_(parameters) {}

  /// Kp above 0, Ki and Kd at least 0.
  [[nodiscard]] static bool takes(std::span<const double, 3> gains) noexcept {
    return std::all_of(gains.begin(), gains.end(), [](double v) { return std::isfinite(v) && v >= 0; }) && gains[0] > 0;
  }
  void set_gains(std::span<const double, 3> gains) noexcept {
    integral_.shift((kp_ - gains[0]) * signal_.error() + (kd_ - gains[2]) * signal_.rate());
    kp_ = gains[0];
    kd_ = gains[2];
    integral_.set_gain(gains[1]);
  }
  /// Takes up a change of the known effort by -`effort`.
  void shift(double effort) noexcept { integral_.shift(effort); }

  void engage(const ServoInput& input, double known, double effort) noexcept {
    signal_.engage(input);
    integral_.start(effort, known + proportional(), integrated(), input.period_s);
  }
  [[nodiscard]] double update(const ServoInput& input, double known, double limit) noexcept {
    signal_.update(input);
    const double before = integral_.value();
    const double effort = integral_.output(known + proportional(), integrated(), input.period_s, limit);
    gained_ = signal_.stands() && integral_.grows() ? integral_.value() - before : 0;
    return effort;
  }
  /// What the integral gained in the last cycle of a joint that is to stand.
  [[nodiscard]] double gained_at_rest() const noexcept { return gained_; }

 private:
  [[nodiscard]] double proportional() const noexcept { return kp_ * signal_.error() + kd_ * signal_.rate(); }

  [[nodiscard]] double integrated() const noexcept { return signal_.rests() ? 0 : signal_.error(); }

  ErrorSignal signal_;
  IntegralAction integral_;
  double kp_ = 0, kd_ = 0;
  double gained_ = 0;  ///< effort
};

/// The parameter of the laws whose gains have none: the weight that hangs on the joint, as the effort that holds it.
inline constexpr sdk::NumberParameter kLoad{"load", 0, -1e7, 1e7, "N or N·m"};

}  // namespace rmac::modules
