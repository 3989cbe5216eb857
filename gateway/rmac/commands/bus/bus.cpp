#include "gateway/rmac/commands/bus/registrations.hpp"

namespace rmac::cli {

void add_bus(Command& rmac) {
  Command bus = rmac.add("bus", "commission a fieldbus");
  bus.needs_command();
  for (const Registration add : {add_bus_lss, add_bus_load, add_bus_scan, add_bus_sdo, add_bus_state, add_bus_store,
                                 add_bus_trace, add_bus_move})
    add(bus);
}

}  // namespace rmac::cli
