#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "gateway/servo/servo_link.hpp"

namespace rmac::gateway {

/// What the servo loop is to do beside following plans. A change is in force in the next cycle. One thread at a time:
/// the caller locks.
class StandingWishes {
 public:
  /// Spindles and outputs that were turned off together.
  struct TurnedOff {
    std::array<double, kMaxSpindles> spindle_rpm{};
    std::uint64_t outputs = 0;
  };

  explicit StandingWishes(LatestValue<ServoWishes>& servo) : servo_(servo) {}

  [[nodiscard]] const ServoWishes& now() const noexcept { return now_; }
  template <typename Change>
  void change(Change&& change) {
    std::forward<Change>(change)(now_);
    servo_.write(now_);
  }

  /// Stops the spindles, and switches `outputs` (the coolant) off; what was on, or was kept for later.
  TurnedOff turn_off(std::uint64_t outputs) {
    TurnedOff was{now_.spindle_rpm, now_.outputs & outputs};
    if (later_) was = {later_->spindle_rpm, was.outputs | later_->outputs};
    change([&](ServoWishes& wishes) {
      wishes.spindle_rpm.fill(0);
      wishes.outputs &= ~outputs;
    });
    return was;
  }
  /// What was turned off goes on again when `turn_on_again` is called.
  void keep_for_later(const TurnedOff& was) noexcept { later_ = was; }
  void forget_later() noexcept { later_.reset(); }
  /// True when something was kept for later, and now is on.
  bool turn_on_again() {
    if (!later_) return false;
    change([&](ServoWishes& wishes) {
      wishes.spindle_rpm = later_->spindle_rpm;
      wishes.outputs |= later_->outputs;
    });
    later_.reset();
    return true;
  }

 private:
  LatestValue<ServoWishes>& servo_;
  ServoWishes now_;
  std::optional<TurnedOff> later_;
};

}  // namespace rmac::gateway
