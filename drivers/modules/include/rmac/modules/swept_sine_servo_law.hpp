#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "rmac/modules/filter_inverse.hpp"
#include "rmac/modules/pid_feedback.hpp"
#include "rmac/modules/swept_sine.hpp"
#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac::modules {

/// The PID law with a swept sine on top of its effort, for measuring what a joint answers (`rmac tune`). Without
/// `sweep_effort` it is the PID law. The sum stays within the effort limit. The sine goes before the filters that it is
/// told of as they would have it, so that their drive gets it whole also where they keep the feedback from a resonance.
class SweptSineServoLaw final : public ServoLaw {
 public:
  SweptSineServoLaw(const ErrorSignal::Parameters& signal, const SweptSine::Parameters& sweep,
                    const FilterInverse::Parameters& filters, double load)
      : feedback_(signal), sweep_(sweep), inverse_(filters), load_(load), effort_(sweep.effort) {}

  [[nodiscard]] std::span<const GainInfo> gains() const noexcept override { return kGains; }

  [[nodiscard]] bool set_gains(std::span<const double> values) noexcept override {
    if (values.size() != kGains.size() || !PidFeedback::takes(values.first<3>())) return false;
    feedback_.set_gains(values.first<3>());
    return true;
  }

  void set_effort_limit(double effort) noexcept override {
    limit_ = std::abs(effort);
    const double most = effort_ > 0 ? kSineShare * limit_ / effort_ : 1;
    larger_ = std::clamp((most - 1) / (FilterInverse::kMost - 1), 0.0, 1.0);
  }

  [[nodiscard]] double resting_effort() const noexcept override { return load_; }

  void engage(const ServoInput& input, double effort) noexcept override {
    feedback_.engage(input, load_, std::clamp(effort, -limit_, limit_));
  }

  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    if (!is_finite(input)) return std::numeric_limits<double>::quiet_NaN();
    const double sine = sweep_.step(input);
    const double larger = inverse_.step(sine, input.period_s);
    return feedback_.update(input, load_ + sine + larger_ * (larger - sine), limit_);
  }

 private:
  static constexpr std::array<GainInfo, 3> kGains{{{"Kp", "N/mm"}, {"Ki", "N/(mm·s)"}, {"Kd", "N·s/mm"}}};

  /// Of the effort limit; the rest is the feedback's, which would be lost where the sine alone reaches the limit.
  static constexpr double kSineShare = 0.5;

  PidFeedback feedback_;
  SweptSine sweep_;
  FilterInverse inverse_;
  double load_;
  double effort_;  ///< of the sine
  double limit_ = 0;
  double larger_ = 0;  ///< how much of what the inverse adds fits into `kSineShare`, 0 to 1
};

/// Makes a `SweptSineServoLaw`; parameters of `PidServoLawFactory`, and `sweep_effort`, `sweep_from_hz`, `sweep_to_hz`,
/// `sweep_full_hz`, `sweep_period_s`, `sweep_periods`, `sweep_stretches`, `sweep_notches` and `sweep_low_pass_hz`.
struct SweptSineServoLawFactory {
  static ServoLaw* create(sdk::Parameters parameters, char* error, std::size_t error_size) noexcept {
    if (!sdk::are_known_numbers(parameters,
                                {"derivative_filter_s", "rest_band", "load", "sweep_effort", "sweep_from_hz",
                                 "sweep_to_hz", "sweep_full_hz", "sweep_period_s", "sweep_periods", "sweep_stretches",
                                 "sweep_notches", "sweep_low_pass_hz"},
                                error, error_size))
      return nullptr;
    ErrorSignal::Parameters signal;
    SweptSine::Parameters sweep;
    FilterInverse::Parameters filters;
    double load = 0;
    if (!ErrorSignal::read(parameters, signal, error, error_size)) return nullptr;
    if (!SweptSine::read(parameters, sweep, error, error_size)) return nullptr;
    if (!FilterInverse::read(parameters, filters, error, error_size)) return nullptr;
    if (!sdk::read_number(parameters, kLoad, load, error, error_size)) return nullptr;
    return new SweptSineServoLaw(signal, sweep, filters, load);
  }
};

}  // namespace rmac::modules
