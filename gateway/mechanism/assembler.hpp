#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gateway/buses/bus_registry.hpp"
#include "gateway/mechanism/mechanism.hpp"
#include "gateway/modules/module_loader.hpp"

namespace rmac::gateway {

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

/// Where a mechanism comes from, beside its device object.
struct MechanismSource {
  std::string folder{};       ///< its own modules lie there; empty: it has none
  bool virtual_mode = false;  ///< setpoints are reflected as joint values, and no drive is touched
};

/// Assembles mechanisms as this appliance has them: its period, its buses, the folders of its modules. Gateway thread.
class Assembler {
 public:
  /// `module_folders` are searched in order, behind the mechanism's own. `options.virtual_mode` says nothing: each
  /// mechanism's source does.
  Assembler(AssemblyOptions options, std::vector<std::string> module_folders, BusRegistry& registry)
      : options_(options), module_folders_(std::move(module_folders)), registry_(registry) {}

  /// Finds modules in a mechanism's folder first, then in the shared ones.
  [[nodiscard]] ModuleLoader loader(const std::string& mechanism_folder) const;
  [[nodiscard]] Expected<std::shared_ptr<Mechanism>> assemble(const sdk::DeviceObject& device,
                                                              const MechanismSource& source) const;

 private:
  AssemblyOptions options_;
  std::vector<std::string> module_folders_;
  BusRegistry& registry_;
};

}  // namespace rmac::gateway
