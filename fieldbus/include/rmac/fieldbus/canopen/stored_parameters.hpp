#pragma once

#include <chrono>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus::canopen {

/// What a node keeps without power.
enum class StoreCommand : std::uint8_t {
  Save,         ///< all parameters as they are now (1010h:01)
  LoadDefaults  ///< those of the maker, from its next reset on (1011h:01)
};

/// Tells one node so (CiA 301, 7.5.2.13 and 7.5.2.14), by the signature that keeps anyone from doing it by mistake.
/// Refuses a bus on which a machine runs, as `scan_bus` does. Off the cycle; writing a memory may take seconds.
[[nodiscard]] Expected<> store_parameters(CanPort& port, std::uint8_t node, StoreCommand command);

}  // namespace rmac::fieldbus::canopen
