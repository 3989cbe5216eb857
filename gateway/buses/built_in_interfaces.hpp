#pragma once

#include <filesystem>

#include "gateway/buses/bus_registry.hpp"

namespace rmac::gateway {

/// Registers the interfaces that the appliance brings along: the simulated bus and I/O, CANopen, Modbus and GPIO.
/// `drives_folder`: the CANopen drives that are known, which are read anew for each bus; empty: none is.
void add_built_in_interfaces(BusRegistry& registry, double period_s, const std::filesystem::path& drives_folder = {});

}  // namespace rmac::gateway
