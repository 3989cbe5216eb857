#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/canopen/canopen_config.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"

namespace rmac::fieldbus::canopen {

/// A node that a scan found.
struct ScannedNode {
  std::uint8_t node = 0;
  std::optional<NmtState> state;  ///< of a heartbeat, where it makes some
  bool answers = false;           ///< by SDO; what follows was read then
  std::uint32_t device_type = 0;  ///< 1000h
  Identity identity;              ///< 1018h; 0 where the node does not tell
  std::string name;               ///< 1008h, printable characters only
  bool two_identities = false;    ///< two devices have this id: it told two values of 1000h or 1018h
  bool answers_twice = false;     ///< each question; two devices that tell no difference, or a gateway that repeats
};

struct ScanOptions {
  std::chrono::nanoseconds listen = std::chrono::milliseconds(500);   ///< before anything is sent
  std::chrono::nanoseconds timeout = std::chrono::milliseconds(200);  ///< for each answer of a node
};

/// Listens for `listen` and refuses a bus on which a machine runs, which shows by SYNC or by a node that is
/// Operational: another client's questions would come between those of its master. `take` sees every frame meanwhile.
[[nodiscard]] Expected<> check_idle(CanPort& port, std::chrono::nanoseconds listen,
                                    const std::function<void(const CanFrame&)>& take = {});

/// Looks for all 127 nodes: reads 1000h, 1018h and 1008h of each, and changes nothing. Refuses a bus that is not idle.
/// Off the cycle.
[[nodiscard]] Expected<std::vector<ScannedNode>> scan_bus(CanPort& port, const ScanOptions& options = {});

/// What a device type (1000h) means: "servo drive (CiA 402)".
[[nodiscard]] std::string device_type_text(std::uint32_t device_type);

/// Whether a file describes this node: its vendor and product numbers are the node's, as far as the file tells them.
[[nodiscard]] bool describes(const eds::DeviceDescription& description, const ScannedNode& node) noexcept;

}  // namespace rmac::fieldbus::canopen
