#pragma once

#include <memory>

#include "gateway/buses/bus_registry.hpp"
#include "gateway/mechanism/mechanism.hpp"
#include "gateway/modules/module_loader.hpp"

namespace rmac::gateway {

/// Checks a device object as a whole, whatever its modules are: counts, names, limits, bounds, bus axes, I/O bits. The
/// error names the joint, actuator or spindle, the value, and what would be right.
[[nodiscard]] Expected<> check_device(const sdk::DeviceObject& device);

/// What of a servo loop is the appliance's to say, and not the mechanism's.
struct AssemblyOptions {
  bool virtual_mode = false;
  double period_s = 0.001;
  StopCategories stop_categories{};
  int max_cycles_lost = 0;
};

/// Builds the mechanism that a device object describes, beside whatever is in force: loads its modules, checks that
/// they fit each other and the gains, and borrows the buses. Nothing moves and nothing in force changes; a failure
/// leaves at most a bus brought up, which `BusRegistry::stop_unused` stops. Gateway thread.
[[nodiscard]] Expected<std::shared_ptr<Mechanism>> assemble(const sdk::DeviceObject& device,
                                                            const AssemblyOptions& options, const ModuleLoader& loader,
                                                            BusRegistry& registry);

/// The law that a joint names, with its gains; adds its module to `modules`. Gateway thread.
[[nodiscard]] Expected<std::shared_ptr<ServoLaw>> load_joint_law(const sdk::Joint& joint, const ModuleLoader& loader,
                                                                 std::vector<ModuleInUse>& modules);

}  // namespace rmac::gateway
