#include <fmt/format.h>

#include <cmath>
#include <set>

#include "gateway/controller/assembler.hpp"

namespace rmac::gateway {
namespace {

tl::unexpected<Error> refuse(std::string message) {
  return failure(MinorCode::InvalidParameterValue, std::move(message));
}

bool positive(double value) {
  return std::isfinite(value) && value > 0;
}

Expected<> check_limits(const JointLimits& limits, const std::string& who) {
  if (!positive(limits.max_speed) || !positive(limits.max_acceleration) || !positive(limits.max_jerk)) {
    return refuse(fmt::format("{}: maximum speed {}, acceleration {} and jerk {} must all be above 0", who,
                              limits.max_speed, limits.max_acceleration, limits.max_jerk));
  }
  if (!std::isfinite(limits.min) || !std::isfinite(limits.max)) {
    return refuse(fmt::format("{}: limits {} and {} must be finite", who, limits.min, limits.max));
  }
  if (limits.limit_type == JointLimitType::Limited && !(limits.min < limits.max)) {
    return refuse(
        fmt::format("{}: the minimum limit {} must be below the maximum limit {}", who, limits.min, limits.max));
  }
  return {};
}

Expected<> check_joint(const sdk::Joint& joint, const std::string& who) {
  if (auto limits = check_limits(joint.limits, who); !limits) return limits;
  if (joint.servo_law.name.empty()) {
    return refuse(who + ": no servo control law is chosen; use SetMechanismJointServoControlLaw");
  }
  if (!positive(joint.max_following_error) || !positive(joint.max_effort)) {
    return refuse(fmt::format("{}: following-error bound {} and effort bound {} must be above 0", who,
                              joint.max_following_error, joint.max_effort));
  }
  return {};
}

Expected<> check_joints(const sdk::DeviceObject& device) {
  const std::size_t count = device.joints.size() + device.held_joints.size();
  if (device.joints.empty() || count > kMaxJoints) {
    return refuse(fmt::format("{}: {} joints and {} held ones; there must be 1 joint at least, and {} at most together",
                              device.name, device.joints.size(), device.held_joints.size(), kMaxJoints));
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < count; ++i) {
    const bool held = i >= device.joints.size();
    const sdk::Joint& joint = held ? device.held_joints[i - device.joints.size()] : device.joints[i];
    const std::string who = fmt::format("{} {} \"{}\"", held ? "held joint" : "joint", i, joint.limits.name);
    if (joint.limits.name.empty() || !names.insert(joint.limits.name).second) {
      return refuse(who + ": every joint needs a name of its own");
    }
    if (auto fine = check_joint(joint, who); !fine) return fine;
  }
  return {};
}

Expected<> check_actuators(const sdk::DeviceObject& device) {
  std::set<std::pair<std::string, std::uint32_t>> taken;
  const auto take = [&](const std::string& who, const std::string& bus, std::uint32_t axis) -> Expected<> {
    if (bus.empty()) return refuse(who + ": no bus is named");
    if (!taken.emplace(bus, axis).second) {
      return refuse(
          fmt::format("{}: axis {} of bus {} is taken already by another actuator or spindle", who, axis, bus));
    }
    return {};
  };
  for (std::size_t i = 0; i < device.actuators.size(); ++i) {
    const sdk::Actuator& actuator = device.actuators[i];
    const std::string who = fmt::format("actuator {}", i);
    if (auto free = take(who, actuator.bus, actuator.axis); !free) return free;
    if (!positive(actuator.scale.counts_per_revolution) || !positive(actuator.scale.rated_torque_nm) ||
        std::abs(actuator.scale.direction) != 1) {
      return refuse(fmt::format(
          "{}: counts per revolution {} and rated torque {} must be above 0, direction {} must be "
          "1 or -1",
          who, actuator.scale.counts_per_revolution, actuator.scale.rated_torque_nm, actuator.scale.direction));
    }
  }
  for (std::size_t i = 0; i < device.spindles.size(); ++i) {
    const sdk::Spindle& spindle = device.spindles[i];
    const std::string who = fmt::format("spindle {}", i);
    if (auto free = take(who, spindle.bus, spindle.axis); !free) return free;
    if (!positive(spindle.max_speed_rpm) || !positive(spindle.speed_tolerance_rpm) ||
        !positive(spindle.speed_timeout_s)) {
      return refuse(
          fmt::format("{}: maximum speed {} rpm, speed tolerance {} rpm and speed time-out {} s must be above "
                      "0",
                      who, spindle.max_speed_rpm, spindle.speed_tolerance_rpm, spindle.speed_timeout_s));
    }
  }
  return {};
}

Expected<> check_io(const sdk::DeviceObject& device) {
  for (const auto* names : {&device.inputs, &device.outputs}) {
    std::set<int> bits;
    for (const auto& [name, bit] : *names) {
      if (bit < 0 || bit > 63 || !bits.insert(bit).second) {
        return refuse(fmt::format("I/O name \"{}\": bit {} must be 0 to 63 and not have another name", name, bit));
      }
    }
  }
  if (device.digital_io_interface.name.empty() && !(device.inputs.empty() && device.outputs.empty())) {
    return refuse("I/O names are given, but no digital I/O interface is chosen");
  }
  return {};
}

}  // namespace

Expected<> check_device(const sdk::DeviceObject& device) {
  if (!positive(device.max_feedrate_mm_min)) {
    return refuse(
        fmt::format("{}: maximum feedrate {} mm/min must be above 0", device.name, device.max_feedrate_mm_min));
  }
  if (device.kinematics.name.empty()) return refuse("no kinematics is chosen; use SetMechanismKinematics");
  if (device.actuator_map.name.empty()) return refuse("no actuator map is chosen");
  if (device.digital_control_interface.name.empty()) return refuse("no digital control interface is chosen");
  return check_joints(device).and_then([&] { return check_actuators(device); }).and_then([&] {
    return check_io(device);
  });
}

}  // namespace rmac::gateway
