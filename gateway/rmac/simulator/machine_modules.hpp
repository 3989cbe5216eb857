#pragma once

#include <filesystem>

#include "gateway/modules/module_loader.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::cli {

/// Finds the modules of a machine: beside its device.json, then in the tree's folders of its name and of its driver,
/// then among the shared ones.
[[nodiscard]] gateway::ModuleLoader loader_of(const sdk::DeviceObject& device, const std::filesystem::path& device_json,
                                              const std::filesystem::path& device_tree);

}  // namespace rmac::cli
