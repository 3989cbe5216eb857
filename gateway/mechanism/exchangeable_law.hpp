#pragma once

#include <memory>

#include "rmac/motion/ports/servo_law.hpp"

namespace rmac::gateway {

/// The law of a joint, which another one may take the place of between two cycles, in motion too: the other one goes on
/// from the effort that the first one ended with. `exchange`, `engage` and `update` are the servo thread's.
class ExchangeableLaw final : public ServoLaw {
 public:
  explicit ExchangeableLaw(std::shared_ptr<ServoLaw> law) noexcept : law_(std::move(law)) {}

  /// `law` has its gains and its effort limit, and is left with the law of before. Real-time safe.
  void exchange(std::shared_ptr<ServoLaw>& law) noexcept {
    law_.swap(law);
    exchanged_ = true;
  }

  [[nodiscard]] std::span<const GainInfo> gains() const noexcept override { return law_->gains(); }
  [[nodiscard]] bool set_gains(std::span<const double> values) noexcept override { return law_->set_gains(values); }
  void set_effort_limit(double effort) noexcept override { law_->set_effort_limit(effort); }
  [[nodiscard]] double resting_effort() const noexcept override { return law_->resting_effort(); }
  void engage(const ServoInput& input, double effort) noexcept override {
    exchanged_ = false;
    law_->engage(input, effort);
  }
  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    // On the setpoint of this cycle: to that of the cycle before, a joint in motion is a cycle's way ahead.
    if (exchanged_) engage(input, effort_);
    effort_ = law_->update(input);
    return effort_;
  }

 private:
  std::shared_ptr<ServoLaw> law_;
  double effort_ = 0;  ///< what the last cycle gave
  bool exchanged_ = false;
};

}  // namespace rmac::gateway
