#include "gateway/device_database/device_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "rmac/motion/pose.hpp"
#include "rmac/sdk/buses_of.hpp"

namespace rmac::gateway {
namespace {

using sdk::DeviceObject;

std::string check_travel(const JointLimits& limits, const std::string& place) {
  if (limits.limit_type == JointLimitType::Limited && !(limits.min < limits.max)) {
    return fmt::format("{}/Min is {}; allowed is a number below {}, the joint's Max", place, limits.min, limits.max);
  }
  return {};
}

/// Joints and held joints are told apart by name everywhere, so no name may stand twice.
std::string check_joints(const std::vector<sdk::Joint>& joints, const char* key,
                         std::map<std::string, std::string>& names) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::string place = fmt::format("/{}/{}", key, i);
    if (auto problem = check_travel(joints[i].limits, place); !problem.empty()) return problem;
    const auto [taken, is_new] = names.emplace(joints[i].limits.name, place);
    if (!is_new) {
      return fmt::format("{}/Name is \"{}\", which {} has already; allowed is a name of its own", place,
                         joints[i].limits.name, taken->second);
    }
  }
  return {};
}

std::string check_counts(const DeviceObject& device) {
  const std::size_t joints = device.joints.size() + device.held_joints.size();
  if (joints > kMaxJoints) {
    return fmt::format("/HeldJoints has {} entries beside {} Joints; allowed are {} together",
                       device.held_joints.size(), device.joints.size(), kMaxJoints);
  }
  // More than joints is sound: two motors of a gantry, or a redundant drive. Fewer leaves a joint without a motor.
  if (device.actuators.size() < joints) {
    return fmt::format(
        "/Actuators has {} entries; allowed are at least {}, one for each of {} Joints and {} HeldJoints",
        device.actuators.size(), joints, device.joints.size(), device.held_joints.size());
  }
  return {};
}

/// Two masters of one drive would fight.
std::string check_bus_axes(const DeviceObject& device) {
  std::map<std::pair<std::string, std::uint32_t>, std::string> taken;
  const auto take = [&](const std::string& bus, std::uint32_t axis, const std::string& place) -> std::string {
    const auto [first, is_new] = taken.emplace(std::pair(bus, axis), place);
    if (is_new) return {};
    return fmt::format("{}/Axis is {} on bus \"{}\", which {} has already; allowed is an axis of its own", place, axis,
                       bus, first->second);
  };
  for (std::size_t i = 0; i < device.actuators.size(); ++i) {
    const sdk::Actuator& actuator = device.actuators[i];
    auto problem = take(actuator.bus, actuator.axis, fmt::format("/Actuators/{}", i));
    if (!problem.empty()) return problem;
  }
  for (std::size_t i = 0; i < device.spindles.size(); ++i) {
    const sdk::Spindle& spindle = device.spindles[i];
    auto problem = take(spindle.bus, spindle.axis, fmt::format("/Spindles/{}", i));
    if (!problem.empty()) return problem;
  }
  return {};
}

/// A parameter `BUS.name` of a bus that is not there would be passed over.
std::string check_bus_names(const DeviceObject& device) {
  const std::set<std::string> buses = sdk::buses_of(device);
  const auto check = [&](const auto& parameters) -> std::string {
    for (const auto& entry : parameters) {
      const std::string& key = entry.first;
      const bool known = std::ranges::any_of(buses, [&](const std::string& bus) { return key.starts_with(bus + "."); });
      if (known || key.find('.') == std::string::npos) continue;
      return fmt::format(
          "/DigitalControlInterface/Parameters has \"{}\"; allowed before the point is a bus on which "
          "something of this machine hangs: {}",
          key, fmt::join(buses, ", "));
    }
    return {};
  };
  auto problem = check(device.digital_control_interface.numbers);
  return problem.empty() ? check(device.digital_control_interface.texts) : problem;
}

std::string check_spindles(const DeviceObject& device) {
  for (std::size_t i = 0; i < device.spindles.size(); ++i) {
    const sdk::Spindle& spindle = device.spindles[i];
    if (spindle.max_speed_rpm > 0 && !(spindle.speed_tolerance_rpm > 0)) {
      return fmt::format(
          "/Spindles/{}/SpeedTolerance is {}; allowed is a number above 0 (rpm), or feed would wait for ever", i,
          spindle.speed_tolerance_rpm);
    }
  }
  return {};
}

std::string check_bits(const std::map<std::string, int>& bits, const char* key) {
  std::map<int, std::string> taken;
  for (const auto& [name, bit] : bits) {
    const auto [first, is_new] = taken.emplace(bit, name);
    if (!is_new) {
      return fmt::format("/DigitalIOInterface/{}/{} is bit {}, which \"{}\" has already; allowed is a bit of its own",
                         key, name, bit, first->second);
    }
  }
  return {};
}

std::string check_step(const DeviceObject& device, const sdk::ToolChangeStep& step) {
  using Kind = sdk::ToolChangeStep::Kind;
  if (step.kind == Kind::MoveTo && step.joints.size() != device.joints.size()) {
    return fmt::format("/Joints has {} entries; allowed are {}, one for each of the mechanism's Joints",
                       step.joints.size(), device.joints.size());
  }
  for (std::size_t i = 0; step.kind == Kind::MoveTo && i < step.joints.size(); ++i) {
    const JointLimits& joint = device.joints[i].limits;
    if ((ends_below(joint) && step.joints[i] < joint.min) || (ends_above(joint) && step.joints[i] > joint.max)) {
      return fmt::format("/Joints/{} is {}; allowed is what lies within the travel of {}, {} to {}", i, step.joints[i],
                         joint.name, joint.min, joint.max);
    }
  }
  const bool switches = step.kind == Kind::Switch || step.kind == Kind::Select;
  if (switches && step.outputs.empty()) return " lacks the key \"Outputs\", which Switch and Select need";
  for (std::size_t i = 0; switches && i < step.outputs.size(); ++i) {
    if (device.outputs.contains(step.outputs[i])) continue;
    return fmt::format("/Outputs/{} is \"{}\"; allowed are names of /DigitalIOInterface/Outputs", i, step.outputs[i]);
  }
  if (step.kind == Kind::Select && step.whose == sdk::ToolChangeStep::Whose::Both) {
    return " lacks the key \"For\", \"Old\" or \"New\": which tool's number Select means";
  }
  if (step.kind == Kind::Await && !device.inputs.contains(step.input)) {
    return fmt::format("/Input is \"{}\"; allowed are names of /DigitalIOInterface/Inputs", step.input);
  }
  return {};
}

std::string check_tool_change(const DeviceObject& device) {
  if (!device.tool_changer && !device.tool_change.empty()) {
    return "/ToolChanger is false; allowed is true beside ToolChange";
  }
  for (std::size_t i = 0; i < device.tool_change.size(); ++i) {
    const std::string problem = check_step(device, device.tool_change[i]);
    if (!problem.empty()) return fmt::format("/ToolChange/{}{}", i, problem);
  }
  return {};
}

std::string check_touch_probes(const DeviceObject& device) {
  for (std::size_t i = 0; i < device.actuators.size(); ++i) {
    if (!device.actuators[i].probe_edge || device.inputs.contains("Probe")) continue;
    return fmt::format(
        "/Actuators/{}/TouchProbe is given, and no input is named Probe, which tells when the probe lets go; allowed "
        "is to name one, of the DigitalIOInterface or of a drive",
        i);
  }
  return {};
}

}  // namespace

std::string check_sense(const DeviceObject& device) {
  std::map<std::string, std::string> names;
  for (auto problem :
       {check_joints(device.joints, "Joints", names), check_joints(device.held_joints, "HeldJoints", names),
        check_counts(device), check_bus_axes(device), check_bus_names(device), check_spindles(device),
        check_bits(device.inputs, "Inputs"), check_bits(device.outputs, "Outputs"), check_tool_change(device),
        check_touch_probes(device)}) {
    if (!problem.empty()) return problem;
  }
  return {};
}

}  // namespace rmac::gateway
