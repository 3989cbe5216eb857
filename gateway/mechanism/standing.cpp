#include "gateway/mechanism/standing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace rmac::gateway {
namespace {

/// mm or degrees: what a position loses on its way through maps and encoders.
constexpr double kRounding = 1e-6;

}  // namespace

std::optional<std::vector<double>> standing_after(const Mechanism& now, std::span<const double> position,
                                                  const Mechanism& next) {
  if (now.virtual_mode() || next.virtual_mode()) return std::nullopt;
  const auto& drives_now = now.device.actuators;
  const auto& drives_next = next.device.actuators;
  std::array<double, kMaxJoints> shafts_now{};
  now.loop->parts().actuator_map->actuator_positions(position, {shafts_now.data(), drives_now.size()});
  std::array<double, kMaxJoints> shafts_next{};
  for (std::size_t i = 0; i < drives_next.size(); ++i) {
    const auto shared = std::ranges::find_if(drives_now, [&](const sdk::Actuator& drive) {
      return drive.bus == drives_next[i].bus && drive.axis == drives_next[i].axis;
    });
    if (shared == drives_now.end()) return std::nullopt;
    const auto index = static_cast<std::size_t>(shared - drives_now.begin());
    shafts_next[i] = shaft_rad(drives_next[i].scale, shaft_counts(shared->scale, shafts_now[index]));
  }
  std::vector<double> joints(next.loop->joint_count_with_held());
  next.loop->parts().actuator_map->joint_positions({shafts_next.data(), drives_next.size()}, joints);
  return joints;
}

Expected<> check_standing(const sdk::DeviceObject& device, std::span<const double> position, bool as_measured) {
  // Held joints are not moved, so that their limits bound nothing.
  for (std::size_t i = 0; i < device.joints.size(); ++i) {
    const JointLimits& joint = device.joints[i].limits;
    const double slack = as_measured ? device.joints[i].max_following_error : kRounding;
    const bool outside = (ends_below(joint) && position[i] < joint.min - slack) ||
                         (ends_above(joint) && position[i] > joint.max + slack);
    if (!outside) continue;
    return failure(
        MinorCode::TravelLimit,
        fmt::format("joint {} \"{}\" stands at {:.4f}, outside of its limits {} to {}; bring it inside by "
                    "hand, or with a mechanism that may be there, or choose limits that include it",
                    i, joint.name, position[i], ends_below(joint) ? fmt::format("{}", joint.min) : "-infinity",
                    ends_above(joint) ? fmt::format("{}", joint.max) : "infinity"));
  }
  return {};
}

}  // namespace rmac::gateway
