#include "gateway/rmac_config/verified_bounds.hpp"

#include <fmt/format.h>

namespace rmac::gateway {
namespace {

tl::unexpected<Error> beyond(const sdk::DeviceObject& verified, const std::string& what) {
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("{}. {} was verified as its device.json has it: change that file, have it verified "
                             "(Device.Verify) and load it anew (Device.Load)",
                             what, verified.machine()));
}

bool same(const sdk::ModuleChoice& one, const sdk::ModuleChoice& other) {
  return one.name == other.name && one.numbers == other.numbers && one.texts == other.texts;
}

Expected<> check_joint(const JointLimits& wanted, const JointLimits& verified, const sdk::DeviceObject& whole) {
  const auto wider = [&](const char* what, double value, double most) {
    return beyond(whole,
                  fmt::format("joint {}: {} {} is beyond {}, which was verified", verified.name, what, value, most));
  };
  if (wanted.type != verified.type) {
    return beyond(whole, fmt::format("joint {}: it is of another type than was verified", verified.name));
  }
  if ((ends_above(verified) && !ends_above(wanted)) || (ends_below(verified) && !ends_below(wanted))) {
    return beyond(whole, fmt::format("joint {}: its travel has no end where one from {} to {} was verified",
                                     verified.name, verified.min, verified.max));
  }
  if (ends_above(verified) && wanted.max > verified.max) return wider("the maximum limit", wanted.max, verified.max);
  if (ends_below(verified) && wanted.min < verified.min) return wider("the minimum limit", wanted.min, verified.min);
  if (wanted.max_speed > verified.max_speed) return wider("the speed", wanted.max_speed, verified.max_speed);
  if (wanted.max_acceleration > verified.max_acceleration) {
    return wider("the acceleration", wanted.max_acceleration, verified.max_acceleration);
  }
  if (wanted.max_jerk > verified.max_jerk) return wider("the jerk", wanted.max_jerk, verified.max_jerk);
  return {};
}

}  // namespace

Expected<> check_within_verified(const sdk::DeviceObject& wanted, const sdk::DeviceObject& verified) {
  if (wanted.joints.size() != verified.joints.size() || wanted.held_joints.size() != verified.held_joints.size()) {
    return beyond(verified, fmt::format("{} joints, {} of them held, were verified, not {} and {}",
                                        verified.joint_count_with_held(), verified.held_joints.size(),
                                        wanted.joint_count_with_held(), wanted.held_joints.size()));
  }
  for (std::size_t j = 0; j < verified.joint_count_with_held(); ++j) {
    auto within = check_joint(sdk::joint_at(wanted, j).limits, sdk::joint_at(verified, j).limits, verified);
    if (!within) return within;
  }
  if (!same(wanted.kinematics, verified.kinematics)) {
    return beyond(verified, "other kinematics, or others of their parameters, than were verified");
  }
  if (!same(wanted.actuator_map, verified.actuator_map)) {
    return beyond(verified, "another actuator map, or others of its parameters, than were verified");
  }
  return {};
}

}  // namespace rmac::gateway
