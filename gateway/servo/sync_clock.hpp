#pragma once

#include <memory>
#include <string>

#include "gateway/servo/clock.hpp"
#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// The SYNC of a CAN bus (CiA 301, 7.2.5), which another node produces once a period: each begins a cycle. One that
/// does not come within one and a half periods counts as missed, and the cycle begins without it, so that the servo
/// loop goes on watching and braking. One that comes within nine tenths of a period begins none, or the machine would
/// move faster than it should, and counts as missed too. What too many missed cycles do, the configuration says.
class SyncClock final : public Clock {
 public:
  /// `port`: hears SYNC alone.
  SyncClock(std::unique_ptr<fieldbus::CanPort> port, double period_s) noexcept;
  /// The error says what is wrong with the interface and how to mend it.
  [[nodiscard]] static Expected<std::shared_ptr<Clock>> on(const std::string& interface, double period_s);

  std::uint64_t wait_for_cycle() noexcept override;
  [[nodiscard]] std::int64_t late_ns() const noexcept override { return late_.count(); }
  void restart() noexcept override {
    begun_ = port_->now();
    without_ = false;
  }

 private:
  std::unique_ptr<fieldbus::CanPort> port_;
  std::chrono::nanoseconds period_;
  std::chrono::nanoseconds begun_{0};  ///< when the last cycle was due
  bool without_ = false;               ///< the last cycle began without SYNC
  std::chrono::nanoseconds late_{0};
};

}  // namespace rmac::gateway
