#pragma once

#include <cstdint>
#include <optional>

namespace rmac::fieldbus {

/// A CAN controller's fault confinement (ISO 11898-1, 12.1.4), as far as its interface tells it.
struct CanController {
  enum class State : std::uint8_t { Unknown, ErrorActive, ErrorWarning, ErrorPassive, BusOff, Stopped, Sleeping };
  /// Raised by errors, lowered by frames that pass: a warning from 96 on, passive from 128 on, bus-off above 255.
  struct ErrorCounters {
    std::uint16_t transmit = 0;
    std::uint16_t receive = 0;
  };

  State state = State::Unknown;              ///< Unknown: there is no controller (a virtual bus), or it is not told
  std::optional<ErrorCounters> errors = {};  ///< none: the driver does not tell them
  bool link_down = false;                    ///< its interface is down; of a virtual bus too
};

/// "error-active", "bus-off", "unknown".
[[nodiscard]] const char* to_string(CanController::State state) noexcept;

/// Asks the kernel for the controller behind an interface. Never on the servo thread.
[[nodiscard]] CanController read_can_controller(int interface_index) noexcept;

}  // namespace rmac::fieldbus
