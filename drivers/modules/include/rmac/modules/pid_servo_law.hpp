#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "rmac/modules/feedforward_model.hpp"
#include "rmac/modules/pid_feedback.hpp"
#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac::modules {

/// PID law of one joint: effort = known + Kp·e + Kd·ė + ∫ Ki·e dt, with e the following error, and ė the difference of
/// wanted and measured velocity behind a first-order low-pass. Known is what its parameters say that the axis needs,
/// its load at least. Gains act at the joint: N/mm, N/(mm·s), N·s/mm for a linear one, N·m and deg for a rotary one.
class PidServoLaw final : public ServoLaw {
 public:
  PidServoLaw(const ErrorSignal::Parameters& signal, const FeedforwardModel& known) noexcept
      : feedback_(signal), known_(known) {}

  [[nodiscard]] std::span<const GainInfo> gains() const noexcept override { return kGains; }

  [[nodiscard]] bool set_gains(std::span<const double> values) noexcept override {
    if (values.size() != kGains.size() || !PidFeedback::takes(values.first<3>())) return false;
    feedback_.set_gains(values.first<3>());
    return true;
  }

  void set_effort_limit(double effort) noexcept override { limit_ = std::abs(effort); }

  [[nodiscard]] double resting_effort() const noexcept override { return known_.load(); }

  void engage(const ServoInput& input, double effort) noexcept override {
    feedback_.engage(input, known_.begin(input), std::clamp(effort, -limit_, limit_));
  }

  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    if (!is_finite(input)) return std::numeric_limits<double>::quiet_NaN();
    known_.step(input);
    const double effort = feedback_.update(input, known_.effort(input), limit_);
    feedback_.shift(-known_.settle(feedback_.gained_at_rest()));
    return effort;
  }

 private:
  static constexpr std::array<GainInfo, 3> kGains{{{"Kp", "N/mm"}, {"Ki", "N/(mm·s)"}, {"Kd", "N·s/mm"}}};

  PidFeedback feedback_;
  FeedforwardModel known_;
  double limit_ = 0;
};

/// Makes a `PidServoLaw`; parameters `derivative_filter_s`, `rest_band`, `load`, and of the other laws' model
/// `viscous`, `mass`, `friction`, `lead_s`, `friction_speed`, `presliding`, `breakaway` and `stribeck_speed`.
struct PidServoLawFactory {
  static ServoLaw* create(sdk::Parameters parameters, char* error, std::size_t error_size) noexcept {
    if (!sdk::are_known_numbers(parameters,
                                {"derivative_filter_s", "rest_band", "load", "viscous", "mass", "friction", "lead_s",
                                 "friction_speed", "presliding", "breakaway", "stribeck_speed"},
                                error, error_size))
      return nullptr;
    ErrorSignal::Parameters signal;
    FeedforwardModel::Parameters model;
    std::array<double, 4> known{};
    if (!ErrorSignal::read(parameters, signal, error, error_size)) return nullptr;
    if (!FeedforwardModel::read(parameters, model, error, error_size)) return nullptr;
    if (!read_known(parameters, known, error, error_size)) return nullptr;
    FeedforwardModel feedforward(model);
    feedforward.set_gains(known);
    return new PidServoLaw(signal, feedforward);
  }

 private:
  /// The model's gains, in its order.
  static bool read_known(sdk::Parameters parameters, std::array<double, 4>& known, char* error,
                         std::size_t error_size) noexcept {
    return sdk::read_number(parameters, {"viscous", 0, 0, 1e7, "N·s/mm or N·m·s/deg"}, known[0], error, error_size) &&
           sdk::read_number(parameters, {"mass", 0, 0, 1e7, "N·s²/mm or N·m·s²/deg"}, known[1], error, error_size) &&
           sdk::read_number(parameters, {"friction", 0, 0, 1e7, "N or N·m"}, known[2], error, error_size) &&
           sdk::read_number(parameters, kLoad, known[3], error, error_size);
  }
};

}  // namespace rmac::modules
