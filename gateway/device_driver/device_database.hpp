#pragma once

#include <filesystem>

#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// Reads a mechanism's device database, `device.json` (Table 4-2), checks it against etc/device.schema.json and for
/// sense, and returns typed values. An error names file, key, value and allowed range.
[[nodiscard]] Expected<sdk::DeviceObject> read_device_database(const std::filesystem::path& device_json);

}  // namespace rmac::gateway
