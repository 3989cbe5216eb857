#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "rmac/modules/pid_feedback.hpp"
#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac::modules {

/// PID law of one joint: effort = load + Kp·e + Kd·ė + ∫ Ki·e dt, with e the following error, and ė the difference of
/// wanted and measured velocity behind a first-order low-pass. Gains act at the joint: N/mm, N/(mm·s), N·s/mm for a
/// linear one, N·m and deg for a rotary one.
class PidServoLaw final : public ServoLaw {
 public:
  PidServoLaw(const ErrorSignal::Parameters& signal, double load) noexcept : feedback_(signal), load_(load) {}

  [[nodiscard]] std::span<const GainInfo> gains() const noexcept override { return kGains; }

  [[nodiscard]] bool set_gains(std::span<const double> values) noexcept override {
    if (values.size() != kGains.size() || !PidFeedback::takes(values.first<3>())) return false;
    feedback_.set_gains(values.first<3>());
    return true;
  }

  void set_effort_limit(double effort) noexcept override { limit_ = std::abs(effort); }

  [[nodiscard]] double resting_effort() const noexcept override { return load_; }

  void engage(const ServoInput& input, double effort) noexcept override {
    feedback_.engage(input, load_, std::clamp(effort, -limit_, limit_));
  }

  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    if (!is_finite(input)) return std::numeric_limits<double>::quiet_NaN();
    return feedback_.update(input, load_, limit_);
  }

 private:
  static constexpr std::array<GainInfo, 3> kGains{{{"Kp", "N/mm"}, {"Ki", "N/(mm·s)"}, {"Kd", "N·s/mm"}}};

  PidFeedback feedback_;
  double load_;
  double limit_ = 0;
};

/// Makes a `PidServoLaw`; parameters `derivative_filter_s`, `rest_band` and `load`.
struct PidServoLawFactory {
  static ServoLaw* create(sdk::Parameters parameters, char* error, std::size_t error_size) noexcept {
    if (!sdk::are_known_numbers(parameters, {"derivative_filter_s", "rest_band", "load"}, error, error_size))
      return nullptr;
    ErrorSignal::Parameters signal;
    double load = 0;
    if (!ErrorSignal::read(parameters, signal, error, error_size)) return nullptr;
    if (!sdk::read_number(parameters, kLoad, load, error, error_size)) return nullptr;
    return new PidServoLaw(signal, load);
  }
};

}  // namespace rmac::modules
