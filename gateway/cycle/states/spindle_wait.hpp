#pragma once

#include <optional>

namespace rmac::gateway {

/// Motion that has not begun waits for a spindle that was told another speed, and not for ever. A pure state machine.
class SpindleWait {
 public:
  /// A spindle was told another speed, and has so long for it, from when motion waits.
  void begin(double timeout_s) noexcept { waiting_ = Waiting{timeout_s, {}}; }
  void end() noexcept { waiting_.reset(); }
  /// Its time begins anew.
  void restart() noexcept {
    if (waiting_) waiting_->since_s.reset();
  }
  [[nodiscard]] bool waiting() const noexcept { return waiting_.has_value(); }
  /// Motion waits now. True when it has waited for too long; then the wait is over.
  [[nodiscard]] bool too_long(double t_s) noexcept {
    if (!waiting_) return false;
    if (!waiting_->since_s) waiting_->since_s = t_s;
    if (t_s - *waiting_->since_s <= waiting_->timeout_s) return false;
    end();
    return true;
  }

 private:
  struct Waiting {
    double timeout_s = 0;
    std::optional<double> since_s;
  };
  std::optional<Waiting> waiting_;
};

}  // namespace rmac::gateway
