#pragma once

#include <chrono>
#include <deque>
#include <utility>
#include <vector>

#include "gateway/simulators/vdrive/objects/sdo_server.hpp"

namespace rmac::vdrive {

using Time = std::chrono::nanoseconds;

/// What a node sends, on its way to the bus; a fault may hold it back or swallow it.
class Outlet {
 public:
  void send(const CanFrame& frame) { frames_.push_back(frame); }
  void send(std::uint16_t id, const Bytes& data);
  /// For those who make several.
  [[nodiscard]] std::vector<CanFrame>& frames() noexcept { return frames_; }
  /// What reaches the bus by now, in order.
  [[nodiscard]] std::vector<CanFrame> take(Time now);
  void clear();

  // Faults
  void set_mute(bool mute) noexcept { mute_ = mute; }      ///< nothing reaches the bus
  void set_delay(Time delay) noexcept { delay_ = delay; }  ///< everything reaches it so much later

 private:
  std::vector<CanFrame> frames_;
  std::deque<std::pair<Time, CanFrame>> delayed_;
  bool mute_ = false;
  Time delay_{0};
};

}  // namespace rmac::vdrive
