#include <fmt/format.h>

#include "gateway/mechanism/loop_draft.hpp"

namespace rmac::gateway {
namespace {

const char* type_text(JointType type) {
  return type == JointType::Rotary ? "Rotary" : type == JointType::Linear ? "Linear" : "Screw";
}

/// A screw slides by what it counts. Its turn, about the axis along which it slides, is the geometry's business where
/// it moves the tool, and shows in none where the tool lies in that axis, as in a quill's.
bool fits(JointType configured, JointType built) {
  return configured == built || (configured == JointType::Screw && built == JointType::Linear);
}

Expected<> check_joint_links(const Kinematics& kinematics, const sdk::DeviceObject& device) {
  if (kinematics.joint_count() != device.joints.size()) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{} has {} joints, but {} are configured", device.kinematics.name,
                               kinematics.joint_count(), device.joints.size()));
  }
  for (std::size_t i = 0; i < device.joints.size(); ++i) {
    const JointLimits& joint = device.joints[i].limits;
    if (const JointType built = kinematics.joint_type(i); !fits(joint.type, built)) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("joint {} \"{}\" is set to be {}, but it is {} in the geometry of {}", i, joint.name,
                                 type_text(joint.type), type_text(built), device.kinematics.name));
    }
  }
  return {};
}

Expected<> check_sizes(const ActuatorMap& map, const sdk::DeviceObject& device) {
  const std::size_t joints = device.joint_count_with_held();
  if (map.joint_count() == joints && map.actuator_count() == device.actuators.size()) return {};
  return failure(
      MinorCode::InvalidParameterValue,
      fmt::format("{} maps {} joints to {} actuators, but {} joints (held ones included) and {} actuators "
                  "are configured",
                  device.actuator_map.name, map.joint_count(), map.actuator_count(), joints, device.actuators.size()));
}

}  // namespace

Expected<> add_geometry(LoopDraft& draft) {
  const sdk::DeviceObject& device = draft.device;
  auto kinematics = draft.loader.load<Kinematics>(device.kinematics);
  if (!kinematics) return tl::unexpected(kinematics.error());
  if (auto fine = check_joint_links(*kinematics->object, device); !fine) return fine;
  auto map = draft.loader.load<ActuatorMap>(device.actuator_map);
  if (!map) return tl::unexpected(map.error());
  if (auto fine = check_sizes(*map->object, device); !fine) return fine;
  draft.modules.push_back({"kinematics", device.kinematics.name, kinematics->build_id});
  draft.modules.push_back({"actuator map", device.actuator_map.name, map->build_id});
  draft.parts.kinematics = std::move(kinematics->object);
  draft.parts.actuator_map = std::move(map->object);
  return {};
}

}  // namespace rmac::gateway
