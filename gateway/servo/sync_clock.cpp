#include "gateway/servo/sync_clock.hpp"

#include <algorithm>
#include <array>
#include <chrono>

#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"

namespace rmac::gateway {

namespace {

/// How long ago the kernel took the frame. Its stamps are of a clock that may be set, which must not move a cycle.
std::chrono::nanoseconds age(const fieldbus::CanFrame& frame, std::chrono::nanoseconds at_most) noexcept {
  if (frame.stamp.count() == 0) return {};
  const std::chrono::nanoseconds now = std::chrono::system_clock::now().time_since_epoch();
  return std::clamp(now - frame.stamp, std::chrono::nanoseconds(0), at_most);
}

}  // namespace

SyncClock::SyncClock(std::unique_ptr<fieldbus::CanPort> port, double period_s) noexcept
    : port_(std::move(port)),
      period_(std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(period_s))) {
  restart();
}

Expected<std::shared_ptr<Clock>> SyncClock::on(const std::string& interface, double period_s) {
  const std::array wanted{fieldbus::canopen::kSyncId};
  return fieldbus::SocketCanPort::open(interface, wanted, 0).map([period_s](auto port) -> std::shared_ptr<Clock> {
    return std::make_shared<SyncClock>(std::move(port), period_s);
  });
}

std::uint64_t SyncClock::wait_for_cycle() noexcept {
  std::uint64_t missed = 0;
  // The one after a cycle that began without SYNC, half a period late, is due half a period earlier.
  const auto soonest = begun_ + (without_ ? period_ * 2 / 5 : period_ * 9 / 10);
  const auto overdue = begun_ + period_ * 3 / 2;
  for (bool heard = false;;) {
    // Where several wait, the last one begins the cycle.
    for (fieldbus::CanFrame sync; port_->receive(sync);) {
      const auto came = port_->now() - age(sync, 4 * period_);
      if (heard || came < soonest) ++missed;
      if (came < soonest) continue;
      heard = true;
      without_ = false;
      begun_ = came;
    }
    const auto now = port_->now();
    if (!heard && now >= overdue) {
      heard = without_ = true;
      begun_ = overdue;
      ++missed;
    }
    if (heard) {
      late_ = now - begun_;
      return missed;
    }
    port_->wait(overdue - now);
  }
}

}  // namespace rmac::gateway
