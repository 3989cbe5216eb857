#pragma once

#include <limits>

#include "rmac/modules/feedforward_model.hpp"
#include "rmac/modules/integral_action.hpp"
#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac::modules {

/// Feedforward alone: the effort of the model, whatever is measured. An open loop: what the model misses adds up to a
/// following error, whose bound stops the machine. For axes whose model is exact, for finding the gains of
/// `FeedforwardFeedbackServoLaw`, and for comparison. An offset that engaging or new gains leave fades.
class FeedforwardServoLaw final : public ServoLaw {
 public:
  explicit FeedforwardServoLaw(const FeedforwardModel::Parameters& parameters) noexcept : model_(parameters) {}

  [[nodiscard]] std::span<const GainInfo> gains() const noexcept override { return FeedforwardModel::kGains; }

  [[nodiscard]] bool set_gains(std::span<const double> values) noexcept override {
    if (values.size() != FeedforwardModel::kGains.size() || !FeedforwardModel::takes(values.first<4>())) return false;
    const double before = model_.effort(last_);
    model_.set_gains(values.first<4>());
    offset_.shift(before - model_.effort(last_));
    return true;
  }

  void set_effort_limit(double effort) noexcept override { limit_ = std::abs(effort); }

  [[nodiscard]] double resting_effort() const noexcept override { return model_.load(); }

  void engage(const ServoInput& input, double effort) noexcept override {
    last_ = input;
    offset_.start(std::clamp(effort, -limit_, limit_), model_.begin(input), 0, input.period_s);
  }

  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    if (!is_finite(input)) return std::numeric_limits<double>::quiet_NaN();
    last_ = input;
    model_.step(input);
    return offset_.output(model_.effort(input), 0, input.period_s, limit_);
  }

 private:
  FeedforwardModel model_;
  IntegralAction offset_;  ///< its gain stays 0
  ServoInput last_;
  double limit_ = 0;
};

/// Makes a `FeedforwardServoLaw`; parameters `lead_s`, `friction_speed`, `presliding`, `breakaway` and
/// `stribeck_speed`.
struct FeedforwardServoLawFactory {
  static ServoLaw* create(sdk::Parameters parameters, char* error, std::size_t error_size) noexcept {
    if (!sdk::are_known_numbers(parameters, {"lead_s", "friction_speed", "presliding", "breakaway", "stribeck_speed"},
                                error, error_size))
      return nullptr;
    FeedforwardModel::Parameters model;
    if (!FeedforwardModel::read(parameters, model, error, error_size)) return nullptr;
    return new FeedforwardServoLaw(model);
  }
};

}  // namespace rmac::modules
