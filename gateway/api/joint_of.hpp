#pragma once

#include <fmt/format.h>

#include <cstdint>

#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// Joint `number` of a device, constant or not: those that are moved, then those that are held.
template <typename Device>
[[nodiscard]] auto joint_of(Device& device, std::int64_t number) -> Expected<decltype(device.joints.data())> {
  const auto index = static_cast<std::size_t>(number);
  if (index < device.joint_count_with_held()) return &sdk::joint_at(device, index);
  return failure(MinorCode::InvalidParameterValue, fmt::format("joint {} does not exist: {} has joints 0 to {}", number,
                                                               device.name, device.joint_count_with_held() - 1));
}

}  // namespace rmac::gateway
