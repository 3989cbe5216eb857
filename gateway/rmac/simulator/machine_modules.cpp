#include "gateway/rmac/simulator/machine_modules.hpp"

#include <string>
#include <vector>

#include "gateway/device_driver_manager/device_tree.hpp"

namespace rmac::cli {

gateway::ModuleLoader loader_of(const sdk::DeviceObject& device, const std::filesystem::path& device_json,
                                const std::filesystem::path& device_tree) {
  std::vector<std::filesystem::path> folders{device_json.parent_path()};
  for (const std::string& name : {device.name, device.device_driver}) {
    if (const auto file = gateway::find_device_json(name, device_tree); file) folders.push_back(file->parent_path());
  }
  folders.push_back(device_tree / "modules");
  return gateway::ModuleLoader(folders);
}

}  // namespace rmac::cli
