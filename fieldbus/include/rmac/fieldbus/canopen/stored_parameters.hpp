#pragma once

#include <array>
#include <cstdint>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus::canopen {

/// What to write to 1010h, without which nothing is stored (CiA 301, 7.5.2.13).
inline constexpr std::array<std::uint8_t, 4> kSaveSignature{'s', 'a', 'v', 'e'};

/// What a node keeps without power.
enum class StoreCommand : std::uint8_t {
  Save,         ///< all parameters as they are now (1010h:01)
  LoadDefaults  ///< those of the maker, from its next reset on (1011h:01)
};

/// Tells one node so (CiA 301, 7.5.2.13 and 7.5.2.14), by the signature that keeps anyone from doing it by mistake.
/// Refuses a bus on which a machine runs, as `scan_bus` does. Off the cycle; writing a memory may take seconds.
[[nodiscard]] Expected<> store_parameters(CanPort& port, std::uint8_t node, StoreCommand command);

}  // namespace rmac::fieldbus::canopen
