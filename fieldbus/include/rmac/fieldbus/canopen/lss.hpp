#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/canopen/canopen_config.hpp"

namespace rmac::fieldbus::canopen {

/// Layer setting services (CiA 305): node ids and bit rates over the bus, for nodes that have no switches. Each
/// function refuses a bus on which a machine runs, and leaves every node waiting, whatever happens. Off the cycle.
struct LssOptions {
  std::chrono::nanoseconds listen = std::chrono::milliseconds(500);  ///< before anything is sent, and for the slowest
  /// At least, for an answer of each of an identity's bits; twice as long as the slowest node took to the first.
  std::chrono::nanoseconds timeout = std::chrono::milliseconds(50);
  std::chrono::nanoseconds patience = std::chrono::seconds(1);  ///< for an answer of one node, which may write a memory
  std::chrono::nanoseconds boot_timeout = std::chrono::seconds(5);  ///< for a node to come up with its new id
};

/// Who of the nodes has no node id, by fast scan. An identity that several nodes answer to is told several times.
[[nodiscard]] Expected<std::vector<Identity>> lss_scan(CanPort& port, const LssOptions& options = {});

struct LssAssigned {
  Identity identity;
  bool stored = false;  ///< the node keeps its id without power
};
/// Gives a node an id: the one that has none, or the one of this identity, whether it has an id or not. It has come up
/// with it when this returns. Refuses an id that somebody has.
[[nodiscard]] Expected<LssAssigned> lss_assign(CanPort& port, std::uint8_t node,
                                               const std::optional<Identity>& identity, const LssOptions& options = {});

/// Has nodes take another bit rate: each is told by its identity and keeps it without power, then all change at once.
/// They speak at the old one no more, and at the new one after twice the `switch_delay`. Where one cannot, none
/// changes.
[[nodiscard]] Expected<> lss_set_bit_rate(CanPort& port, const std::vector<Identity>& nodes, std::uint32_t bit_rate,
                                          std::chrono::milliseconds switch_delay, const LssOptions& options = {});

/// "vendor 1h, product 402h, revision 10000h, serial 3h"
[[nodiscard]] std::string to_string(const Identity& identity);

}  // namespace rmac::fieldbus::canopen
