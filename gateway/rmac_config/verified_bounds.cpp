#include "gateway/rmac_config/verified_bounds.hpp"

#include <fmt/format.h>

namespace rmac::gateway {
namespace {

tl::unexpected<Error> refuse(const std::string& what) {
  return failure(MinorCode::InvalidParameterValue, what);
}

bool same(const sdk::ModuleChoice& one, const sdk::ModuleChoice& other) {
  return one.name == other.name && one.numbers == other.numbers && one.texts == other.texts;
}

/// What goes beyond the limits of a joint; empty where nothing does.
std::string wider(const JointLimits& wanted, const JointLimits& given) {
  const auto beyond = [&](const char* what, double value, double most) {
    return fmt::format("joint {}: the {} {} is beyond {}, which was verified", given.name, what, value, most);
  };
  if ((ends_above(given) && !ends_above(wanted)) || (ends_below(given) && !ends_below(wanted))) {
    return fmt::format("joint {}: its travel has no end where one from {} to {} was verified", given.name, given.min,
                       given.max);
  }
  if (ends_above(given) && wanted.max > given.max) return beyond("maximum limit", wanted.max, given.max);
  if (ends_below(given) && wanted.min < given.min) return beyond("minimum limit", wanted.min, given.min);
  if (wanted.max_speed > given.max_speed) return beyond("speed", wanted.max_speed, given.max_speed);
  if (wanted.max_acceleration > given.max_acceleration) {
    return beyond("acceleration", wanted.max_acceleration, given.max_acceleration);
  }
  if (wanted.max_jerk > given.max_jerk) return beyond("jerk", wanted.max_jerk, given.max_jerk);
  return {};
}

Expected<> check_joint(const JointLimits& wanted, const JointLimits& verified) {
  if (wanted.type != verified.type) {
    return refuse(fmt::format("joint {}: it is of another type than was verified", verified.name));
  }
  const std::string what = wider(wanted, verified);
  return what.empty() ? Expected<>() : refuse(what);
}

}  // namespace

Expected<> check_within_verified(const sdk::DeviceObject& wanted, const sdk::DeviceObject& verified) {
  if (wanted.joints.size() != verified.joints.size() || wanted.held_joints.size() != verified.held_joints.size()) {
    return refuse(fmt::format("{} joints, {} of them held, were verified, not {} and {}",
                              verified.joint_count_with_held(), verified.held_joints.size(),
                              wanted.joint_count_with_held(), wanted.held_joints.size()));
  }
  for (std::size_t j = 0; j < verified.joint_count_with_held(); ++j) {
    auto within = check_joint(sdk::joint_at(wanted, j).limits, sdk::joint_at(verified, j).limits);
    if (!within) return within;
  }
  if (!same(wanted.kinematics, verified.kinematics)) {
    return refuse("other kinematics, or others of their parameters, than were verified");
  }
  if (!same(wanted.actuator_map, verified.actuator_map)) {
    return refuse("another actuator map, or others of its parameters, than were verified");
  }
  return {};
}

Expected<> check_within_database(const sdk::DeviceObject& wanted, const sdk::DeviceObject& database) {
  for (std::size_t j = 0; j < wanted.joint_count_with_held(); ++j) {
    const JointLimits& limits = sdk::joint_at(wanted, j).limits;
    for (std::size_t k = 0; k < database.joint_count_with_held(); ++k) {
      const JointLimits& given = sdk::joint_at(database, k).limits;
      // Of another type its numbers mean something else.
      if (given.name != limits.name || given.type != limits.type) continue;
      if (const std::string what = wider(limits, given); !what.empty()) return refuse(what);
    }
  }
  return {};
}

}  // namespace rmac::gateway
