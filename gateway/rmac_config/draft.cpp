#include "gateway/rmac_config/draft.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/json/range.hpp"

namespace rmac::gateway {
namespace {

sdk::Joint without_what_is_set(const sdk::Joint& joint) {
  sdk::Joint left;
  left.max_measured_speed = joint.max_measured_speed;
  left.max_jump = joint.max_jump;
  left.force_sensor = joint.force_sensor;
  left.force = joint.force;
  left.gantry = joint.gantry;
  return left;
}

/// Those beyond `parts` stay known as they were.
template <typename Part>
void remember(const std::vector<Part>& parts, std::vector<Part>& known) {
  known.resize(std::max(known.size(), parts.size()));
  std::copy(parts.begin(), parts.end(), known.begin());
}

}  // namespace

void Draft::begin(const sdk::DeviceObject& from) {
  device = from;
  // The rest is for the device driver to set, joint by joint; what no setter sets stays as device.json has it.
  described.clear();
  for (const sdk::Joint& joint : from.joints) described.push_back(without_what_is_set(joint));
  described_spindles = from.spindles;
  described_actuators = from.actuators;
  device.joints.clear();
  for (sdk::Joint& joint : device.held_joints) joint = without_what_is_set(joint);
  device.kinematics = {};
  device.actuator_map = {};
  device.digital_control_interface = {};
  device.digital_io_interface = {};
  begun = true;
  extent = Extent::Mechanism;
}

void Draft::restart(const sdk::DeviceObject* in_force) {
  device = in_force != nullptr ? *in_force : sdk::DeviceObject{};
  begun = in_force != nullptr;
  extent = Extent::Loops;
}

void Draft::applied() {
  extent = Extent::Loops;
  remember(device.joints, described);
  remember(device.spindles, described_spindles);
  remember(device.actuators, described_actuators);
}

sdk::DeviceObject& Draft::edit() noexcept {
  extent = std::max(extent, Extent::Configuration);
  return device;
}

Expected<sdk::Joint*> Draft::joint(int number, const char* function) {
  const std::size_t count = device.joint_count_with_held();
  if (number >= 0 && static_cast<std::size_t>(number) < count) {
    return &sdk::joint_at(device, static_cast<std::size_t>(number));
  }
  return failure(MinorCode::InvalidParameterValue,
                 count == 0 ? fmt::format("{}: there is no joint {}; set the number of joints first", function, number)
                            : fmt::format("{}: there is no joint {}; joints are 0 to {}", function, number, count - 1));
}

Expected<sdk::Joint*> Draft::edit_joint(int number, const char* function) {
  return joint(number, function).map([this](sdk::Joint* found) {
    (void)edit();
    return found;
  });
}

Expected<sdk::Spindle*> Draft::edit_spindle(int number, const char* function) {
  const std::size_t count = device.spindles.size();
  if (number >= 0 && static_cast<std::size_t>(number) < count) {
    return &edit().spindles[static_cast<std::size_t>(number)];
  }
  return failure(MinorCode::InvalidParameterValue,
                 count == 0
                     ? fmt::format("{}: the mechanism has no spindle", function)
                     : fmt::format("{}: there is no spindle {}; spindles are 0 to {}", function, number, count - 1));
}

Expected<> choose_module(const char* function, const sdk::ModuleChoice& module, sdk::ModuleChoice& target) {
  if (module.name.empty()) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("{}: the name of a module is needed", function));
  }
  target = module;
  return {};
}

Expected<> check_gains(const char* function, std::span<const double> gains) {
  for (const double gain : gains) {
    if (auto sound = check_device_range("joint/Gains", gain, function); !sound) return sound;
  }
  return {};
}

}  // namespace rmac::gateway
