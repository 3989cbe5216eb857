#include "gateway/mechanism/joint_name.hpp"

#include <fmt/format.h>

namespace rmac::gateway {

std::string joint_name(std::size_t index, const sdk::DeviceObject* device) {
  if (device == nullptr) return fmt::format("joint {} of the mechanism before", index);
  if (index >= device->joint_count_with_held()) return fmt::format("joint {}", index);
  return fmt::format("{}joint {} ({})", index < device->joints.size() ? "" : "held ", index,
                     joint_at(*device, index).limits.name);
}

}  // namespace rmac::gateway
