#include "gateway/rmac/commands/bus/machine_bus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "gateway/buses/bus_choice.hpp"
#include "gateway/buses/device_descriptions.hpp"
#include "gateway/buses/drive_library_file.hpp"
#include "gateway/configuration/configuration.hpp"
#include "gateway/device_database/device_database.hpp"
#include "gateway/device_driver_manager/device_tree.hpp"
#include "rmac/sdk/buses_of.hpp"

namespace rmac::cli {

using fieldbus::canopen::CanopenConfig;

Result<std::vector<CanopenConfig>> canopen_buses(const MachineChoice& choice) {
  const auto device_tree = choice.device_tree.empty() ? gateway::default_folders().device_tree : choice.device_tree;
  const auto file = gateway::find_device_json(choice.machine, device_tree);
  if (!file) return fail(file.error().message);
  const auto device = gateway::read_device_database(*file);
  if (!device) return fail(device.error().message);
  const gateway::ModuleLoader loader({file->parent_path(), device_tree / "modules"});
  const auto drives = std::make_shared<fieldbus::canopen::DriveLibrary>(
      gateway::read_drive_library(choice.drives.empty() ? gateway::default_folders().drives : choice.drives));
  std::vector<CanopenConfig> buses;
  for (const std::string& bus : sdk::buses_of(*device)) {
    const sdk::ModuleChoice interface = gateway::interface_of_bus(bus, device->digital_control_interface);
    if (interface.name != "CANopenInterface") continue;
    auto config = fieldbus::canopen::read_canopen_config(bus, interface.numbers, interface.texts, choice.period_s,
                                                         gateway::find_descriptions(loader), drives);
    if (!config) return fail(fmt::format("{}: {}", file->string(), config.error().message));
    buses.push_back(std::move(*config));
  }
  if (!buses.empty()) return buses;
  return fail(fmt::format("{}: its drives are reached by {}, which is no CAN bus", file->string(),
                          device->digital_control_interface.name));
}

const CanopenConfig* bus_of_interface(const std::vector<CanopenConfig>& buses, const std::string& interface) {
  const auto found = std::find_if(buses.begin(), buses.end(),
                                  [&](const CanopenConfig& config) { return config.interface == interface; });
  if (found != buses.end()) return &*found;
  return buses.size() == 1 ? &buses.front() : nullptr;
}

void add_machine_options(Command& command, MachineChoice& choice) {
  command.option("--machine", &choice.machine, "a machine's name; or the path of its folder or its device.json");
  command.option("--device-tree", &choice.device_tree,
                 "where machines are looked for; the installation's unless given");
}

}  // namespace rmac::cli
