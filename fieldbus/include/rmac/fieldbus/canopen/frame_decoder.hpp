#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/canopen/canopen_config.hpp"
#include "rmac/fieldbus/eds/typed_value.hpp"

namespace rmac::fieldbus::canopen {

/// What a frame is by its identifier in the predefined connection set (CiA 301, 7.3.5; LSS: CiA 305).
enum class FrameKind : std::uint8_t { Nmt, Sync, Time, Emergency, Pdo, Sdo, Heartbeat, Lss, Other };
/// "nmt", "sync", ..., for programs.
[[nodiscard]] const char* to_text(FrameKind kind) noexcept;

/// An object's value in a frame.
struct DecodedValue {
  ObjectAddress object;
  std::string name;  ///< empty: unknown
  eds::TypedValue value;
  std::string text;  ///< with its unit, and what it stands for
};

/// What a frame says.
struct DecodedFrame {
  FrameKind kind = FrameKind::Other;
  std::optional<std::uint8_t> node;  ///< whom it comes from or goes to
  std::string text;                  ///< for a person, in one line
  std::vector<DecodedValue> values;  ///< of PDOs and SDOs
  std::optional<std::uint32_t> abort_code;
  std::optional<std::uint16_t> error_code;  ///< of an EMCY
};

/// Reads the frames of one bus, in their order: an SDO's segments are understood by what came before. Where the bus's
/// configuration is given, PDOs are taken apart by it, and objects named by the EDS or DCF of their node; without it
/// objects have the names of the standards, and PDOs are bytes. Nothing that comes is refused. Off the cycle.
class FrameDecoder {
 public:
  /// `config` need not live on; null: there is none.
  explicit FrameDecoder(const CanopenConfig* config = nullptr);
  ~FrameDecoder();
  FrameDecoder(FrameDecoder&&) noexcept;
  FrameDecoder& operator=(FrameDecoder&&) noexcept;

  [[nodiscard]] DecodedFrame decode(const CanFrame& frame);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rmac::fieldbus::canopen
