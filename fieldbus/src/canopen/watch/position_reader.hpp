#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "rmac/fieldbus/canopen/sdo_client.hpp"

namespace rmac::fieldbus::canopen {

/// Reads positions (6064h) of one node's axes by SDO while it is operational, one at a time, for whoever cannot rely on
/// its PDOs. Frames go in, frames come out. Real-time safe.
class PositionReader {
 public:
  explicit PositionReader(std::uint8_t node) : sdo_(node) {}

  [[nodiscard]] bool busy() const noexcept { return busy_; }
  /// `axis`: whose position `object` is; `timeout`: for its answer.
  void begin(std::size_t axis, ObjectAddress object, std::chrono::nanoseconds timeout,
             std::chrono::nanoseconds now) noexcept {
    axis_ = axis;
    sdo_.set_timeout(timeout);
    bytes_.fill(0);
    sdo_.upload(object, bytes_, now);
    busy_ = true;
  }
  void receive(const CanFrame& frame, std::chrono::nanoseconds now) noexcept {
    if (busy_) sdo_.receive(frame, now);
  }
  [[nodiscard]] bool next_frame(std::chrono::nanoseconds now, CanFrame& frame) noexcept {
    return busy_ && sdo_.next_frame(now, frame);
  }
  struct Reading {
    std::size_t axis = 0;
    std::optional<std::int32_t> counts;  ///< nothing where the node refuses to tell
  };
  /// Once for each reading that is over; nothing of one that was not answered.
  [[nodiscard]] std::optional<Reading> take() noexcept {
    if (!busy_ || !sdo_.finished()) return {};
    busy_ = false;
    if (sdo_.state() == SdoClient::State::Refused) return Reading{axis_, {}};
    if (sdo_.state() != SdoClient::State::Done) return {};
    return Reading{axis_, static_cast<std::int32_t>(long_at(bytes_.data()))};
  }
  /// The node is away.
  void abandon() noexcept {
    busy_ = false;
    sdo_.abandon();
  }

 private:
  SdoClient sdo_;
  std::array<std::uint8_t, 4> bytes_{};
  std::size_t axis_ = 0;
  bool busy_ = false;
};

}  // namespace rmac::fieldbus::canopen
