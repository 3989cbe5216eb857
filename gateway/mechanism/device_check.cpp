#include "gateway/mechanism/device_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <set>

#include "gateway/json/range.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::gateway {
namespace {

tl::unexpected<Error> refuse(std::string message) {
  return failure(MinorCode::InvalidParameterValue, std::move(message));
}

/// Every value of a row within what device.json allows for its key.
Expected<> check_all(const std::string& who, std::initializer_list<std::pair<const char*, double>> values) {
  for (const auto& [key, value] : values) {
    const std::string name = key;
    if (auto fine = check_device_range(key, value, who + ": " + name.substr(name.find('/') + 1)); !fine) return fine;
  }
  return {};
}

/// 0 stands for "none"; else as `check_all`.
Expected<> check_optional(const std::string& who, const char* key, double value) {
  return value == 0 ? Expected<>{} : check_all(who, {{key, value}});
}

Expected<> check_joint(const sdk::Joint& joint, const std::string& who) {
  const JointLimits& limits = joint.limits;
  auto fine = check_all(who, {{"joint/Min", limits.min},
                              {"joint/Max", limits.max},
                              {"joint/MaxSpeed", limits.max_speed},
                              {"joint/MaxAcceleration", limits.max_acceleration},
                              {"joint/MaxJerk", limits.max_jerk},
                              {"joint/MaxFollowingError", joint.max_following_error},
                              {"joint/MaxEffort", joint.max_effort}});
  if (!fine) return fine;
  if (limits.limit_type == JointLimitType::Limited && !(limits.min < limits.max)) {
    return refuse(
        fmt::format("{}: the minimum limit {} must be below the maximum limit {}", who, limits.min, limits.max));
  }
  if (joint.servo_law.name.empty() && !joint.gains.empty()) {
    return refuse(
        who +
        ": it has gains and no servo control law; choose one (SetMechanismJointServoControlLaw), or leave the "
        "gains out where its drive closes the loop itself");
  }
  for (const double gain : joint.gains) {
    if (auto sound = check_all(who, {{"joint/Gains", gain}}); !sound) return sound;
  }
  return {};
}

Expected<> check_joint_data(const sdk::DeviceObject& device) {
  const std::size_t count = device.joint_count_with_held();
  if (device.joints.empty() || count > kMaxJoints) {
    return refuse(fmt::format("{}: {} joints and {} held ones; there must be 1 joint at least, and {} at most together",
                              device.name, device.joints.size(), device.held_joints.size(), kMaxJoints));
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < count; ++i) {
    const bool held = i >= device.joints.size();
    const sdk::Joint& joint = joint_at(device, i);
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
    auto fine = check_all(who, {{"actuator/CountsPerRevolution", actuator.scale.counts_per_revolution},
                                {"actuator/RatedTorque", actuator.scale.rated_torque_nm}});
    if (!fine) return fine;
    if (std::abs(actuator.scale.direction) != 1) {
      return refuse(fmt::format("{}: direction {} must be 1 or -1", who, actuator.scale.direction));
    }
  }
  for (std::size_t i = 0; i < device.spindles.size(); ++i) {
    const sdk::Spindle& spindle = device.spindles[i];
    const std::string who = fmt::format("spindle {}", i);
    if (auto free = take(who, spindle.bus, spindle.axis); !free) return free;
    auto fine = check_all(who, {{"spindle/MaxSpeed", spindle.max_speed_rpm},
                                {"spindle/SpeedTolerance", spindle.speed_tolerance_rpm},
                                {"spindle/SpeedTimeout", spindle.speed_timeout_s},
                                {"spindle/MaxTorque", spindle.max_torque_nm},
                                {"spindle/RatedTorque", spindle.scale.rated_torque_nm}});
    if (!fine) return fine;
    for (const double gain : spindle.gains) {
      if (auto sound = check_all(who, {{"spindle/Gains", gain}}); !sound) return sound;
    }
    if (spindle.servo_law.name.empty() && !spindle.gains.empty()) {
      return refuse(who + ": it has gains and no servo control law; choose one (SetMechanismSpindleServoControlLaw)");
    }
    // 0 rpm is a spindle that does not turn; one that does needs a tolerance that it can keep.
    constexpr double kLeastToleranceRpm = 0.1;
    if (spindle.max_speed_rpm != 0 &&
        !(spindle.max_speed_rpm >= 1 && spindle.speed_tolerance_rpm >= kLeastToleranceRpm)) {
      return refuse(fmt::format("{}: maximum speed {} rpm and speed tolerance {} rpm must be at least 1 and {}", who,
                                spindle.max_speed_rpm, spindle.speed_tolerance_rpm, kLeastToleranceRpm));
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
  for (const auto& [bit, input] : device.drive_inputs) {
    if (input.actuator < device.actuators.size()) continue;
    return refuse(fmt::format("input on bit {} is told by actuator {}, and there are {}", bit, input.actuator,
                              device.actuators.size()));
  }
  const bool named = device.inputs.size() > device.drive_inputs.size() || !device.outputs.empty();
  if (device.digital_io_interface.name.empty() && named) {
    return refuse("I/O names are given, but no digital I/O interface is chosen");
  }
  return {};
}

}  // namespace

Expected<> check_device(const sdk::DeviceObject& device) {
  auto fine = check_all(device.name, {{"MaxFeedrate", device.max_feedrate_mm_min}})
                  .and_then([&] { return check_optional(device.name, "PathAccelRise", device.path_accel_rise_mm_s2); })
                  .and_then([&] { return check_optional(device.name, "PathAccelFall", device.path_accel_fall_mm_s2); });
  if (!fine) return fine;
  if (device.kinematics.name.empty()) return refuse("no kinematics is chosen; use SetMechanismKinematics");
  if (device.actuator_map.name.empty()) return refuse("no actuator map is chosen");
  if (device.digital_control_interface.name.empty()) return refuse("no digital control interface is chosen");
  return check_joint_data(device).and_then([&] { return check_actuators(device); }).and_then([&] {
    return check_io(device);
  });
}

}  // namespace rmac::gateway
