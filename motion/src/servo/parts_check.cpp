#include "servo/parts_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "servo/drives/cogging_map.hpp"
#include "servo/gantry/gantries.hpp"
#include "servo/joints/position_correction.hpp"
#include "servo/joints/wiring.hpp"
#include "servo/setpoint/force_loop.hpp"

namespace rmac {

namespace {

std::string joint_text(std::size_t joint) {
  return "joint " + std::to_string(joint);
}

Expected<> check_counts(const ServoLoopParts& parts) {
  if (!parts.kinematics || !parts.actuator_map) {
    return failure(MinorCode::InvalidParameter, "servo loop: kinematics or actuator map is missing; choose both");
  }
  const std::size_t all = parts.joints.size();
  const std::size_t joints = parts.kinematics->joint_count();
  if (joints == 0 || joints > all || all > kMaxJoints) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: the kinematics has " + std::to_string(joints) + " joints, but " + std::to_string(all) +
                       " joints are configured (held ones included); at least as many as the kinematics has, and at "
                       "most " +
                       std::to_string(kMaxJoints) + ", are needed");
  }
  if (parts.actuator_map->joint_count() != all) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: the actuator map is for " + std::to_string(parts.actuator_map->joint_count()) +
                       " joints, but " + std::to_string(all) + " are configured (held ones included)");
  }
  if (parts.actuator_map->actuator_count() != parts.actuators.size() || parts.actuators.size() > kMaxJoints) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: the actuator map is for " + std::to_string(parts.actuator_map->actuator_count()) +
                       " actuators, but " + std::to_string(parts.actuators.size()) + " are configured");
  }
  if (parts.spindles.size() > kMaxSpindles) {
    return failure(MinorCode::InvalidParameterValue, "servo loop: " + std::to_string(parts.spindles.size()) +
                                                         " spindles; at most " + std::to_string(kMaxSpindles));
  }
  if (!(parts.period_s > 0 && parts.period_s <= 0.1) || !(parts.enable_timeout_s > 0)) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: the period must be above 0 and at most 0.1 s, the enable time-out above 0 s");
  }
  return {};
}

Expected<> check_joints(const ServoLoopParts& parts) {
  for (std::size_t j = 0; j < parts.joints.size(); ++j) {
    const ServoJoint& joint = parts.joints[j];
    if (joint.method == ControlMethod::Force) {
      if (auto ok = check_force_control(joint.force, joint_text(j)); !ok) return ok;
      if (!joint.force_sensor && !parts.virtual_mode) {
        return failure(MinorCode::InvalidParameter,
                       "servo loop: " + joint_text(j) + " is under force control and has no force sensor");
      }
    }
    if (!(joint.max_following_error > 0) || !(joint.max_effort > 0) || !std::isfinite(joint.max_effort)) {
      return failure(MinorCode::InvalidParameterValue,
                     "servo loop: " + joint_text(j) + " needs a following-error bound and an effort bound above 0");
    }
    if (auto ok = check_mechanics(joint.mechanics, parts.period_s, joint_text(j)); !ok) return ok;
  }
  const std::size_t starts = parts.virtual_start.size();
  if (starts != 0 && starts != parts.joints.size()) {
    return failure(MinorCode::InvalidParameterValue, "servo loop: virtual mode starts at " + std::to_string(starts) +
                                                         " positions, but there are " +
                                                         std::to_string(parts.joints.size()) + " joints");
  }
  return {};
}

Expected<> check_drive(const ServoBus* bus, std::uint32_t axis, const std::string& who) {
  if (bus == nullptr) return failure(MinorCode::InvalidParameter, "servo loop: " + who + " has no bus");
  if (axis >= bus->commands.size()) {
    return failure(MinorCode::InvalidParameterValue, "servo loop: " + who + " is axis " + std::to_string(axis) +
                                                         ", but its bus has " + std::to_string(bus->commands.size()) +
                                                         " axes, counted from 0");
  }
  return {};
}

/// A gain that closes more than half of the error within a cycle would swing, with the cycle that an answer takes.
constexpr double kMostOfACycle = 0.5;

Expected<> check_mode(const ServoActuator& actuator, double period_s, const std::string& who) {
  const bool velocity = actuator.mode == DriveMode::CyclicSyncVelocity;
  if (!velocity && actuator.mode != DriveMode::CyclicSyncTorque && actuator.mode != DriveMode::CyclicSyncPosition) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: " + who + " has a drive in mode " + std::to_string(static_cast<int>(actuator.mode)) +
                       ", which no joint can be moved in; allowed are 8, 9 and 10 (cyclic synchronous position, "
                       "velocity and torque)");
  }
  if (velocity && !(actuator.position_gain > 0 && actuator.position_gain * period_s <= kMostOfACycle)) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: " + who + " has a drive in velocity mode, and a position gain of " +
                       std::to_string(actuator.position_gain) + " 1/s; it must be above 0 and at most " +
                       std::to_string(kMostOfACycle / period_s));
  }
  if (!velocity && actuator.position_gain != 0) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: " + who +
                       " has a position gain, which only a drive in cyclic synchronous velocity (mode 9) needs");
  }
  return {};
}

Expected<> check_cogging(const ServoActuator& actuator, const std::string& who) {
  constexpr double kMostShare = 0.25;  // no servo motor has more of its rated torque
  double most = 0;
  for (const Cogging::Harmonic& one : actuator.cogging.harmonics) {
    most += std::hypot(one.cosine_nm, one.sine_nm);
    if (one.order >= 1 && one.order <= CoggingMap::kHighestOrder) continue;
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: " + who + " has cogging of " + std::to_string(one.order) +
                       " periods a turn; there are 1 to " + std::to_string(CoggingMap::kHighestOrder));
  }
  if (most > 0 && actuator.mode != DriveMode::CyclicSyncTorque &&
      !actuator.bus->interface->takes_torque_offset(actuator.axis)) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: " + who +
                       " has Cogging, and its drive follows positions or velocities and takes no torque beside; leave "
                       "it out, or have its torque offset carried (60B2h in rpdo)");
  }
  if (most <= kMostShare * actuator.scale.rated_torque_nm) return {};
  return failure(MinorCode::InvalidParameterValue,
                 "servo loop: " + who + " has cogging of up to " + std::to_string(most) +
                     " N·m; more than a quarter of its RatedTorque is no cogging: give N·m at the motor");
}

Expected<> check_drives(const ServoLoopParts& parts) {
  std::vector<std::pair<const ServoBus*, std::uint32_t>> taken;
  const auto take = [&taken](const ServoBus* bus, std::uint32_t axis, const std::string& who) -> Expected<> {
    if (auto ok = check_drive(bus, axis, who); !ok) return ok;
    if (std::find(taken.begin(), taken.end(), std::pair{bus, axis}) != taken.end()) {
      return failure(MinorCode::InvalidParameterValue,
                     "servo loop: " + who + " is bus axis " + std::to_string(axis) + ", which is taken already");
    }
    taken.emplace_back(bus, axis);
    return {};
  };
  for (std::size_t i = 0; i < parts.actuators.size(); ++i) {
    const ServoActuator& actuator = parts.actuators[i];
    const std::string who = "actuator " + std::to_string(i);
    if (auto ok = take(actuator.bus.get(), actuator.axis, who); !ok) return ok;
    const DriveScale& scale = actuator.scale;
    if (!(scale.counts_per_revolution > 0) || !(scale.rated_torque_nm > 0) || std::abs(scale.direction) != 1) {
      return failure(MinorCode::InvalidParameterValue,
                     "servo loop: " + who +
                         " needs counts a revolution and a rated torque above 0, and a direction of "
                         "1 or -1");
    }
    if (auto ok = check_mode(actuator, parts.period_s, who); !ok) return ok;
    if (auto ok = check_cogging(actuator, who); !ok) return ok;
  }
  for (std::size_t i = 0; i < parts.spindles.size(); ++i) {
    const std::string who = "spindle " + std::to_string(i);
    if (auto ok = take(parts.spindles[i].bus.get(), parts.spindles[i].axis, who); !ok) return ok;
    if (auto ok = check_spindle(parts.spindles[i], "servo loop: " + who); !ok) return ok;
  }
  for (std::size_t j = 0; j < parts.joints.size(); ++j) {
    const auto& sensor = parts.joints[j].force_sensor;
    if (!sensor) continue;
    const std::string who = "the force sensor of " + joint_text(j);
    if (auto ok = check_drive(sensor->bus.get(), sensor->axis, who); !ok) return ok;
    if (!(std::abs(sensor->newton_per_count) > 0) || !std::isfinite(sensor->newton_per_count)) {
      return failure(MinorCode::InvalidParameterValue, "servo loop: " + who + " needs a scale other than 0");
    }
  }
  return {};
}

Expected<> check_inputs(const ServoLoopParts& parts) {
  for (const ServoDriveInput& input : parts.drive_inputs) {
    if (input.actuator < parts.actuators.size()) continue;
    return failure(MinorCode::InvalidParameterValue, "servo loop: an input is told by actuator " +
                                                         std::to_string(input.actuator) + ", and there are " +
                                                         std::to_string(parts.actuators.size()));
  }
  for (const ServoLimit& limit : parts.limits) {
    if (limit.joint < parts.joints.size()) continue;
    return failure(MinorCode::InvalidParameterValue, "servo loop: a limit switch is of " + joint_text(limit.joint) +
                                                         ", and there are " + std::to_string(parts.joints.size()));
  }
  return {};
}

/// Actuators whose drives take a torque beside what they follow.
IndexSet with_torque_offset(const ServoLoopParts& parts) {
  IndexSet found = 0;
  for (std::size_t i = 0; i < parts.actuators.size(); ++i) {
    if (parts.actuators[i].bus->interface->takes_torque_offset(parts.actuators[i].axis)) found |= only(i);
  }
  return found;
}

/// A joint has a law where its drives take a torque, and may have one where they take one beside what they follow.
Expected<> check_modes(const ServoLoopParts& parts, const Wiring& wiring) {
  if (parts.virtual_mode) return {};
  const IndexSet offset = with_torque_offset(parts);
  for (std::size_t j = 0; j < wiring.joints(); ++j) {
    const bool takes_torque = (wiring.actuators_of(j) & wiring.torque_drives()) != 0;
    const bool follows_itself = wiring.follows_itself(j);
    if (takes_torque && follows_itself) {
      return failure(MinorCode::InvalidParameterValue,
                     "servo loop: " + joint_text(j) +
                         " is moved by drives that take a torque and by others that follow a position or velocity "
                         "themselves; give them all the same kind of mode");
    }
    if (takes_torque && !parts.joints[j].law)
      return failure(MinorCode::InvalidParameter, "servo loop: " + joint_text(j) +
                                                      " has no servo law, and its drive takes a torque; choose one "
                                                      "(SetMechanismJointServoControlLaw)");
    if (!takes_torque && parts.joints[j].law && (wiring.actuators_of(j) & ~offset) != 0) {
      return failure(
          MinorCode::InvalidParameterValue,
          "servo loop: " + joint_text(j) +
              " has a servo law, but its drive closes the loop itself (cyclic synchronous position or "
              "velocity) and takes no torque beside; leave the law out, have its torque offset carried (60B2h in "
              "rpdo), or put the drive in torque mode");
    }
  }
  return {};
}

/// Drives that move a joint together home together.
Expected<> check_homing(const ServoLoopParts& parts, const Wiring& wiring) {
  for (std::size_t j = 0; j < wiring.joints(); ++j) {
    std::size_t first = wiring.actuators();
    for (std::size_t i = 0; i < wiring.actuators(); ++i) {
      if (!has(wiring.actuators_of(j), i)) continue;
      if (first == wiring.actuators()) first = i;
      if (parts.actuators[i].homing_turn == parts.actuators[first].homing_turn) continue;
      return failure(MinorCode::InvalidParameterValue, "servo loop: actuators " + std::to_string(first) + " and " +
                                                           std::to_string(i) + " move joint " + std::to_string(j) +
                                                           " together; they must home in the same turn");
    }
  }
  return {};
}

}  // namespace

Expected<> check_servo_loop_parts(const ServoLoopParts& parts) {
  return check_counts(parts)
      .and_then([&] { return check_joints(parts); })
      .and_then([&] { return check_drives(parts); })
      .and_then([&] { return check_inputs(parts); })
      .and_then([&]() -> Expected<> {
        const Wiring wiring(*parts.actuator_map, parts.joints.size(), parts.actuators);
        return check_modes(parts, wiring).and_then([&] { return check_homing(parts, wiring); }).and_then([&] {
          return check_gantries(parts, wiring);
        });
      });
}

}  // namespace rmac
