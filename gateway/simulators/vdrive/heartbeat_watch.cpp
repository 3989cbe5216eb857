#include "gateway/simulators/vdrive/heartbeat_watch.hpp"

namespace rmac::vdrive {

void HeartbeatWatch::configure(std::uint8_t sub, std::int64_t value) {
  Watched& watched = watched_.at(sub - 1U);
  watched = {.node = static_cast<std::uint8_t>(value >> 16), .limit = std::chrono::milliseconds(value & 0xFFFF)};
  if (watched.node == 0) watched.limit = Time{0};
}

void HeartbeatWatch::hear(const CanFrame& heartbeat, Time now) noexcept {
  if (heartbeat.size != 1) return;
  for (Watched& watched : watched_) {
    if (watched.limit.count() == 0 || heartbeat.id != 0x700 + watched.node) continue;
    watched.heard = now;
    watched.runs = true;
  }
}

int HeartbeatWatch::lost(Time now) noexcept {
  int lost = 0;
  for (Watched& watched : watched_) {
    if (!watched.runs || now - watched.heard <= watched.limit) continue;
    watched.runs = false;
    ++lost;
  }
  return lost;
}

}  // namespace rmac::vdrive
