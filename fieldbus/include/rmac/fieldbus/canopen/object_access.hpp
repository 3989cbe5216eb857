#pragma once

#include <chrono>
#include <span>
#include <vector>

#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/eds/object_entry.hpp"

namespace rmac::fieldbus::canopen {

/// Reads one object of a node by SDO, of any length up to 1 MiB. The error says why: the node's abort code in words, or
/// that it does not answer. For a bus on which no other client asks. Off the cycle.
[[nodiscard]] Expected<std::vector<std::uint8_t>> read_object(
    CanPort& port, std::uint8_t node, ObjectAddress object, std::chrono::nanoseconds timeout = std::chrono::seconds(1));

/// Writes one, likewise.
[[nodiscard]] Expected<> write_object(CanPort& port, std::uint8_t node, ObjectAddress object,
                                      std::span<const std::uint8_t> bytes,
                                      std::chrono::nanoseconds timeout = std::chrono::seconds(1));

/// Refuses a write by which a motor could move that nobody watches: one that gives it power (6040h with bits 0 to 3
/// set), and any other to a node of which an axis has power (6041h). Fails where the node does not answer.
[[nodiscard]] Expected<> check_moves_nothing(CanPort& port, std::uint8_t node, ObjectAddress object,
                                             std::span<const std::uint8_t> bytes);

}  // namespace rmac::fieldbus::canopen
