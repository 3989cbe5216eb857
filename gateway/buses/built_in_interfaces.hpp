#pragma once

#include "gateway/buses/bus_registry.hpp"

namespace rmac::gateway {

/// Registers the interfaces that the appliance brings along: the simulated bus and I/O, CANopen, Modbus and GPIO.
void add_built_in_interfaces(BusRegistry& registry, double period_s);

}  // namespace rmac::gateway
