#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus::canopen {

/// Commands of network management (CiA 301, 7.2.8.3.1).
enum class NmtCommand : std::uint8_t {
  Start = 0x01,
  Stop = 0x02,
  EnterPreOperational = 0x80,
  ResetNode = 0x81,
  ResetCommunication = 0x82,
};

/// What a heartbeat says (7.2.8.3.2.2). `BootUp` is said once, when a node has come up (7.2.8.3.3).
enum class NmtState : std::uint8_t { BootUp = 0x00, Stopped = 0x04, Operational = 0x05, PreOperational = 0x7F };

inline constexpr std::uint16_t kNmtId = 0x000;
inline constexpr std::uint16_t kSyncId = 0x080;
inline constexpr std::uint16_t kTimeId = 0x100;
inline constexpr std::uint16_t kEmergencyId = 0x080;  ///< plus the node's id, as the following ones
inline constexpr std::uint16_t kSdoAnswerId = 0x580;
inline constexpr std::uint16_t kHeartbeatId = 0x700;

[[nodiscard]] inline CanFrame nmt_frame(NmtCommand command, std::uint8_t node) noexcept {
  return {.id = 0, .size = 2, .data = {static_cast<std::uint8_t>(command), node}};
}
[[nodiscard]] inline CanFrame heartbeat_frame(std::uint8_t node, NmtState state) noexcept {
  return {.id = static_cast<std::uint16_t>(kHeartbeatId + node), .size = 1, .data = {static_cast<std::uint8_t>(state)}};
}
/// Asks a node for its state (7.2.8.3.2.1): it answers as with a heartbeat, and turns bit 7 round each time.
[[nodiscard]] inline CanFrame guard_frame(std::uint8_t node) noexcept {
  return {.id = static_cast<std::uint16_t>(kHeartbeatId + node), .size = 1, .remote = true};
}
[[nodiscard]] inline CanFrame sync_frame() noexcept {
  return {.id = kSyncId};
}
/// The first day of TIME_OF_DAY (7.1.6.5).
inline constexpr std::chrono::sys_days kFirstDay{
    std::chrono::year_month_day(std::chrono::year(1984), std::chrono::January, std::chrono::day(1))};

/// TIME (7.2.6): TIME_OF_DAY, milliseconds since midnight in 28 bits and days since 1 January 1984 (7.1.6.5). UTC.
[[nodiscard]] inline CanFrame time_frame(std::chrono::system_clock::time_point now) noexcept {
  using std::chrono::days;
  const auto today = std::chrono::floor<days>(now);
  const auto ms = static_cast<std::uint32_t>(std::chrono::floor<std::chrono::milliseconds>(now - today).count());
  const auto day = static_cast<std::uint32_t>((today - kFirstDay).count());
  CanFrame frame{.id = kTimeId, .size = 6};
  for (unsigned i = 0; i < 4; ++i) frame.data[i] = static_cast<std::uint8_t>(ms >> (8 * i));
  for (unsigned i = 0; i < 2; ++i) frame.data[4 + i] = static_cast<std::uint8_t>(day >> (8 * i));
  return frame;
}
/// The time that such a frame tells; none where it is too short.
[[nodiscard]] inline std::optional<std::chrono::sys_time<std::chrono::milliseconds>> time_of(
    const CanFrame& frame) noexcept {
  constexpr std::uint8_t kBytes = 6, kTimeBits = 0x0F;  // the upper four bits are reserved
  if (frame.size < kBytes) return {};
  const auto& data = frame.data;
  const std::uint32_t ms = data[0] | static_cast<std::uint32_t>(data[1]) << 8 |
                           static_cast<std::uint32_t>(data[2]) << 16 |
                           static_cast<std::uint32_t>(data[3] & kTimeBits) << 24;
  return kFirstDay + std::chrono::days(data[4] | data[5] << 8) + std::chrono::milliseconds(ms);
}
/// The state in a heartbeat; bit 7 is reserved and passed over.
[[nodiscard]] inline NmtState heartbeat_state(const CanFrame& frame) noexcept {
  return static_cast<NmtState>(frame.data[0] & 0x7F);
}

[[nodiscard]] inline const char* to_text(NmtState state) noexcept {
  switch (state) {
    case NmtState::BootUp:
      return "booting";
    case NmtState::Stopped:
      return "stopped";
    case NmtState::Operational:
      return "operational";
    case NmtState::PreOperational:
      return "pre-operational";
  }
  return "unknown";
}
[[nodiscard]] inline const char* to_text(NmtCommand command) noexcept {
  switch (command) {
    case NmtCommand::Start:
      return "start";
    case NmtCommand::Stop:
      return "stop";
    case NmtCommand::EnterPreOperational:
      return "enter pre-operational";
    case NmtCommand::ResetNode:
      return "reset node";
    case NmtCommand::ResetCommunication:
      return "reset communication";
  }
  return "unknown command";
}

}  // namespace rmac::fieldbus::canopen
