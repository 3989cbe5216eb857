#pragma once

#include <algorithm>
#include <chrono>

namespace rmac::fieldbus::canopen {

/// Tells when heartbeats of one node come as often as two nodes make them. A quarter more than agreed, one that is late
/// and one that a change of state adds are no evidence; nor is one that comes at once behind another, which gateways
/// make. Real-time safe.
class HeartbeatRate {
 public:
  using Time = std::chrono::nanoseconds;

  /// `period` as the node tells it (1017h); 0: it makes none, and nothing is counted. `echo`: so soon behind another it
  /// is a copy.
  void restart(Time now, Time period, Time echo) noexcept {
    last_ = now;
    period_ = period;
    echo_ = std::min(echo, period / 4);
    due_ = kMostDue;
  }
  /// A heartbeat has come. True when there were more than one node makes.
  [[nodiscard]] bool take(Time now) noexcept {
    if (period_.count() <= 0 || now - last_ <= echo_) return false;
    constexpr double kTolerance = 1.25;
    const double passed = static_cast<double>((now - last_).count()) / static_cast<double>(period_.count());
    due_ = std::min(due_ + kTolerance * passed, kMostDue) - 1;
    last_ = now;
    return due_ < 0;
  }

 private:
  static constexpr double kMostDue = 2;

  Time last_{0}, period_{0}, echo_{0};
  double due_ = kMostDue;
};

}  // namespace rmac::fieldbus::canopen
