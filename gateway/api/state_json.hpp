#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "gateway/api/ports.hpp"

namespace rmac::gateway {

[[nodiscard]] const char* to_string(Event::Kind kind) noexcept;

/// An entry of the topic `events`, and `last_stop` of the topic `state`.
[[nodiscard]] nlohmann::json event_to_json(const Event& event);

/// Names of who may move the machine; each may be empty.
struct Parties {
  std::string authority;  ///< holds motion authority
  std::string on_duty;    ///< is the operator
};

/// The topic `state`: docs/protocol.md lists its members. `moves_left` is asked before the sample is taken: of a move
/// that is gone from the queue, the sample shows where it ended.
[[nodiscard]] nlohmann::json state_to_json(MachinePort& machine, int moves_left, const CycleSample& sample,
                                           const MachineStatus& status, const Parties& who);

/// In µs; bins without a time are left out.
[[nodiscard]] nlohmann::json times_to_json(const TimeCounts& counts);

}  // namespace rmac::gateway
