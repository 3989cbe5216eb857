#pragma once

#include <array>
#include <cstdint>

#include "rmac/fieldbus/canopen/sdo.hpp"

namespace rmac::fieldbus::canopen {

/// The bytes of an SDO frame: it has always all of them (CiA 301, 7.2.4.3).
using SdoBytes = std::array<std::uint8_t, 8>;

/// A frame with this command byte and nothing else.
[[nodiscard]] inline SdoBytes sdo_frame(std::uint8_t command) noexcept {
  return {command};
}
/// A frame with this command byte about an object.
[[nodiscard]] inline SdoBytes sdo_frame(std::uint8_t command, ObjectAddress object) noexcept {
  SdoBytes bytes{command};
  put_word(&bytes[1], object.index);
  bytes[3] = object.sub;
  return bytes;
}

/// What a transfer does after an answer of the server.
struct SdoStep {
  enum class Kind : std::uint8_t {
    Wait,
    Send,
    SendAndDone,  ///< the last frame of a transfer that succeeded
    Done,
    Abort  ///< the answer was against the protocol, or did not fit
  };
  Kind kind = Kind::Wait;
  SdoBytes bytes{};              ///< to send
  std::uint32_t abort_code = 0;  ///< why, for Abort

  [[nodiscard]] static SdoStep send(const SdoBytes& bytes) noexcept { return {Kind::Send, bytes, 0}; }
  [[nodiscard]] static SdoStep send_and_done(const SdoBytes& bytes) noexcept { return {Kind::SendAndDone, bytes, 0}; }
  [[nodiscard]] static SdoStep done() noexcept { return {Kind::Done, {}, 0}; }
  [[nodiscard]] static SdoStep abort(std::uint32_t code) noexcept { return {Kind::Abort, {}, code}; }
};

/// Bits of command bytes (CiA 301, 7.2.4.3.3 to 7.2.4.3.16): the specifier in bits 7 to 5, below it flags and counts.
namespace sdo_command {
inline constexpr std::uint8_t kSpecifier = 0xE0;
inline constexpr std::uint8_t kBlockSpecifier = 0xE3;  ///< with the subcommand of block transfers
inline constexpr std::uint8_t kAbort = 0x80;
inline constexpr std::uint8_t kToggleBit = 0x10;
inline constexpr std::uint8_t kLastSegment = 0x80;  ///< of block transfers
inline constexpr std::uint8_t kSequenceBits = 0x7F;
inline constexpr std::size_t kSegment = 7;    ///< bytes of data in a segment
inline constexpr std::size_t kExpedited = 4;  ///< bytes of data that fit into the first frame
}  // namespace sdo_command

}  // namespace rmac::fieldbus::canopen
