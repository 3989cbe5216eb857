#pragma once

#include <array>
#include <limits>

#include "rmac/modules/feedforward_model.hpp"
#include "rmac/modules/pid_feedback.hpp"
#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac::modules {

/// Feedforward with feedback: the model gives the effort that the axis is known to need, a PID what is left. The gains
/// are those of the PID, then those of the model.
class FeedforwardFeedbackServoLaw final : public ServoLaw {
 public:
  FeedforwardFeedbackServoLaw(const ErrorSignal::Parameters& signal, const FeedforwardModel::Parameters& model) noexcept
      : feedback_(signal), model_(model) {}

  [[nodiscard]] std::span<const GainInfo> gains() const noexcept override { return kGains; }

  [[nodiscard]] bool set_gains(std::span<const double> values) noexcept override {
    if (values.size() != kGains.size()) return false;
    const std::span<const double, 3> pid = values.first<3>();
    const std::span<const double, 4> model = values.last<4>();
    if (!PidFeedback::takes(pid) || !FeedforwardModel::takes(model)) return false;
    const double before = model_.effort(last_);
    model_.set_gains(model);
    feedback_.shift(before - model_.effort(last_));
    feedback_.set_gains(pid);
    return true;
  }

  void set_effort_limit(double effort) noexcept override { limit_ = std::abs(effort); }

  [[nodiscard]] double resting_effort() const noexcept override { return model_.load(); }

  void engage(const ServoInput& input, double effort) noexcept override {
    last_ = input;
    feedback_.engage(input, model_.begin(input), std::clamp(effort, -limit_, limit_));
  }

  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    if (!is_finite(input)) return std::numeric_limits<double>::quiet_NaN();
    last_ = input;
    model_.step(input);
    const double effort = feedback_.update(input, model_.effort(input), limit_);
    feedback_.shift(-model_.settle(feedback_.gained_at_rest()));
    return effort;
  }

 private:
  static constexpr std::array<GainInfo, 7> kGains{{{"Kp", "N/mm"},
                                                   {"Ki", "N/(mm·s)"},
                                                   {"Kd", "N·s/mm"},
                                                   FeedforwardModel::kGains[0],
                                                   FeedforwardModel::kGains[1],
                                                   FeedforwardModel::kGains[2],
                                                   FeedforwardModel::kGains[3]}};

  PidFeedback feedback_;
  FeedforwardModel model_;
  ServoInput last_;
  double limit_ = 0;
};

/// Makes a `FeedforwardFeedbackServoLaw`; parameters `derivative_filter_s`, `rest_band`, `lead_s`,
/// `friction_speed`, `presliding`, `breakaway` and
/// `stribeck_speed`.
struct FeedforwardFeedbackServoLawFactory {
  static ServoLaw* create(sdk::Parameters parameters, char* error, std::size_t error_size) noexcept {
    if (!sdk::are_known_numbers(parameters,
                                {"derivative_filter_s", "rest_band", "lead_s", "friction_speed", "presliding",
                                 "breakaway", "stribeck_speed"},
                                error, error_size))
      return nullptr;
    ErrorSignal::Parameters signal;
    FeedforwardModel::Parameters model;
    if (!ErrorSignal::read(parameters, signal, error, error_size)) return nullptr;
    if (!FeedforwardModel::read(parameters, model, error, error_size)) return nullptr;
    return new FeedforwardFeedbackServoLaw(signal, model);
  }
};

}  // namespace rmac::modules
