#pragma once

#include "rmac/fieldbus/canopen/canopen_config.hpp"

namespace rmac::fieldbus::canopen {

/// What a bus carries at worst: every frame with all the stuff bits that it can have by its identifier and length.
struct BusLoad {
  std::uint32_t sync_bits = 0;      ///< a cycle
  std::uint32_t setpoint_bits = 0;  ///< a cycle
  std::uint32_t answer_bits = 0;    ///< a cycle
  double heartbeat_bits_per_s = 0;  ///< of all nodes and the master, and TIME
  double bits_of_cycle = 0;         ///< that the bit rate gives
  double share = 0;                 ///< of them that SYNC and PDOs may fill

  [[nodiscard]] std::uint32_t cyclic_bits() const noexcept { return sync_bits + setpoint_bits + answer_bits; }
  [[nodiscard]] double load() const noexcept { return cyclic_bits() / bits_of_cycle; }
  [[nodiscard]] bool fits() const noexcept { return cyclic_bits() <= share * bits_of_cycle; }
};

[[nodiscard]] BusLoad bus_load(const CanopenConfig& config) noexcept;

/// Refuses a bus that exceeds its share; the error names bus, axes, cycle, and what there is against it.
[[nodiscard]] Expected<> check_bus_load(const CanopenConfig& config);

/// Frames that one cycle may queue at once: setpoints, SYNC, heartbeat, and one to bring up a node.
[[nodiscard]] std::size_t frames_of_cycle(const CanopenConfig& config) noexcept;

}  // namespace rmac::fieldbus::canopen
