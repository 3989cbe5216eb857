#pragma once

#include <string>

#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// Which interface runs a bus, and its parameters. It is the machine's own, `machine`, unless a text parameter
/// `BUS.interface` names another for the bus BUS: that one gets the parameters named `BUS.…`, without the prefix. So a
/// machine with CAN drives has its spindle on Modbus. What is said of another bus alone is left out, so that a bus
/// stays as it is while that changes.
[[nodiscard]] sdk::ModuleChoice interface_of_bus(const std::string& bus, const sdk::ModuleChoice& machine);

}  // namespace rmac::gateway
