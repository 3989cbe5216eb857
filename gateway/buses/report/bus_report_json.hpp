#pragma once

#include <nlohmann/json.hpp>

#include "rmac/fieldbus/bus_report.hpp"

namespace rmac::gateway {

/// `buses` and `lines`, as `Bus.GetState` gives them and flight records keep them.
[[nodiscard]] nlohmann::json to_json(const fieldbus::FieldbusReport& report);

}  // namespace rmac::gateway
