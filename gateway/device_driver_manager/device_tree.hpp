#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gateway/device_database/device_database.hpp"
#include "gateway/device_driver_manager/device_driver_manager.hpp"

namespace rmac::gateway {

/// What a walk through the device tree found: mechanisms whose device.json is sound, and the others with the reason.
struct DeviceTree {
  struct Mechanism {
    std::filesystem::path folder;
    DeviceDatabase database;
  };
  std::vector<Mechanism> mechanisms;  ///< in the order of their folders; no name stands twice
  std::vector<DeviceDriverManager::ScanProblem> problems;
};

/// Reads every `<type>/<configuration>/<Mechanism>/device.json` under `root`. A folder at that depth without one is no
/// mechanism (the SDK lies in the same tree). Fails only when `root` itself cannot be read.
[[nodiscard]] Expected<DeviceTree> scan_device_tree(const std::filesystem::path& root);

/// Whether a machine is named by the path of its folder or of its device.json, instead of by its name in the tree.
[[nodiscard]] bool is_path_of_machine(const std::string& machine);
/// The device.json of a machine that is named either way; of a path it is not said that the file is there.
[[nodiscard]] Expected<std::filesystem::path> find_device_json(const std::string& machine,
                                                               const std::filesystem::path& root);

}  // namespace rmac::gateway
