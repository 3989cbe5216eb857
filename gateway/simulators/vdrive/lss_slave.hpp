#pragma once

#include <array>
#include <chrono>
#include <optional>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::vdrive {

using fieldbus::CanFrame;

/// The slave's side of layer setting services (CiA 305): node id and bit rate over the bus, for nodes that have no
/// switches. It knows frames and time, and what it was told; what follows from that is the node's.
class LssSlave {
 public:
  using Time = std::chrono::nanoseconds;
  /// Vendor, product, revision, serial number.
  using Identity = std::array<std::uint32_t, 4>;
  static constexpr std::uint8_t kUnconfigured = 0xFF;
  static constexpr std::uint16_t kMasterId = 0x7E5, kSlaveId = 0x7E4;

  explicit LssSlave(std::uint8_t node) : active_(node), pending_(node), stored_(node) {}

  /// A frame of the master's identifier; what is answered.
  [[nodiscard]] std::optional<CanFrame> receive(const CanFrame& frame, const Identity& identity, Time now);
  /// What was not stored is forgotten.
  void power_on();
  /// The node id becomes what it was told to be, as by a reset of the communication. Returns it.
  std::uint8_t adopt() { return active_ = pending_; }
  [[nodiscard]] std::uint8_t node() const { return active_; }
  /// A node without an id that was given one, and may go on.
  [[nodiscard]] bool may_begin() const { return active_ == kUnconfigured && pending_ != kUnconfigured && !configures_; }
  /// Between two bit rates nobody speaks.
  [[nodiscard]] bool silent(Time now) const { return now < silent_until_; }
  [[nodiscard]] std::uint32_t bit_rate() const { return bit_rate_; }  ///< 0: as it was

 private:
  void select(unsigned part, std::uint32_t number, const Identity& identity);
  [[nodiscard]] bool scan(const CanFrame& frame, const Identity& identity);

  std::uint8_t active_, pending_, stored_;
  bool configures_ = false;
  unsigned selected_ = 0;  ///< parts of its identity that the master has named, in order
  unsigned scan_part_ = 0;
  std::uint32_t bit_rate_ = 0, pending_rate_ = 0, stored_rate_ = 0;
  Time silent_until_{0};
};

}  // namespace rmac::vdrive
