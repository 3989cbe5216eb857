#pragma once

#include "gateway/rmac/commands/command.hpp"

namespace rmac::cli {

/// `rmac bus`: what commissions a fieldbus. All but `state` work by themselves, without an appliance.
void add_bus(Command& rmac);

// The commands within it.
void add_bus_load(Command& bus);
void add_bus_lss(Command& bus);
void add_bus_move(Command& bus);
void add_bus_scan(Command& bus);
void add_bus_sdo(Command& bus);
void add_bus_state(Command& bus);
void add_bus_store(Command& bus);
void add_bus_trace(Command& bus);

/// How the library of drives is asked for.
inline constexpr const char* kDrivesMeaning = "a folder of descriptions of drives; the installation's unless given";
/// How a CAN interface is asked for.
inline constexpr const char* kInterfaceMeaning = "a CAN interface that is up: can0";

}  // namespace rmac::cli
