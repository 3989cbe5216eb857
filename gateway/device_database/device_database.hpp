#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "gateway/bodies/body.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// A whole `device.json`: what the device driver works with, and what only the device driver manager does.
struct DeviceDatabase {
  sdk::DeviceObject device;
  std::optional<std::int64_t> mechanism_id;  ///< number in the device driver database, where the file claims one
  MachineBodies bodies;                      ///< none where the file says nothing of its shape
};

/// Reads a mechanism's device database, `device.json` (Table 4-2), checks it against etc/device.schema.json and for
/// sense, and returns typed values. An error names file, key, value and allowed range.
[[nodiscard]] Expected<DeviceDatabase> read_device_json(const std::filesystem::path& device_json);

/// The device object of `read_device_json` alone.
[[nodiscard]] Expected<sdk::DeviceObject> read_device_database(const std::filesystem::path& device_json);

}  // namespace rmac::gateway
