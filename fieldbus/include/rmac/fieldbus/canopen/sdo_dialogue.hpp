#pragma once

#include <cstdint>

#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/canopen/sdo.hpp"

namespace rmac::fieldbus::canopen {

/// Data bytes of a segment (CiA 301, 7.2.4.3).
inline constexpr std::size_t kSdoSegment = 7;
/// Data bytes that fit into the request or answer that begins a transfer.
inline constexpr std::size_t kSdoExpedited = 4;
/// Command bytes: the specifier in bits 7 to 5, with block transfers a subcommand in bits 1 and 0.
inline constexpr std::uint8_t kSdoSpecifier = 0xE0;
inline constexpr std::uint8_t kSdoBlockSpecifier = 0xE3;
inline constexpr std::uint8_t kSdoAbort = 0x80;
inline constexpr std::uint8_t kSdoToggleBit = 0x10;
/// Segments of a block: the number in bits 6 to 0, above it whether it is the last.
inline constexpr std::uint8_t kSdoSequenceBits = 0x7F;
inline constexpr std::uint8_t kSdoLastSegment = 0x80;

enum class SdoState : std::uint8_t {
  Idle,
  Busy,
  Done,
  Refused,  ///< the server aborted; `abort_code` says why
  Failed,   ///< this side aborted: no answer in time, or one against the protocol
};

/// What a transfer has whichever way it goes: the object it is about, the next frame to the server, and how it ended.
/// Real-time safe.
class SdoDialogue {
 public:
  explicit SdoDialogue(std::uint8_t node) noexcept : node_(node) {}

  void begin(ObjectAddress object) noexcept;
  /// The server's abort.
  void refuse(std::uint32_t code) noexcept;
  /// Ends the transfer from this side, and tells the server.
  void abort(std::uint32_t code) noexcept;
  void done() noexcept { state_ = SdoState::Done; }

  /// Makes the next frame; its further bytes are written by the caller.
  CanFrame& put(std::uint8_t command) noexcept;
  /// The same with the object's address behind the command.
  CanFrame& put_for_object(std::uint8_t command) noexcept;
  /// Fetches the next frame, if there is one.
  [[nodiscard]] bool take(CanFrame& frame) noexcept;

  [[nodiscard]] bool is_about(const CanFrame& frame) const noexcept;
  [[nodiscard]] bool pending() const noexcept { return pending_; }
  [[nodiscard]] SdoState state() const noexcept { return state_; }
  [[nodiscard]] std::uint32_t abort_code() const noexcept { return abort_code_; }

 private:
  std::uint8_t node_;
  ObjectAddress object_;
  SdoState state_ = SdoState::Idle;
  std::uint32_t abort_code_ = 0;
  bool pending_ = false;
  CanFrame out_;
};

}  // namespace rmac::fieldbus::canopen
