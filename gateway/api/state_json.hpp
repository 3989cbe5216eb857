#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "gateway/api/ports.hpp"

namespace rmac::gateway {

/// The topic `state`: docs/protocol.md lists its members.
[[nodiscard]] nlohmann::json state_to_json(MachinePort& machine, const CycleSample& sample, const MachineStatus& status,
                                           const std::string& authority_holder);

}  // namespace rmac::gateway
