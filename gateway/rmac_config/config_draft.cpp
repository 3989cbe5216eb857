#include "gateway/rmac_config/config_draft.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/json/range.hpp"
#include "rmac/motion/machine_size.hpp"

namespace rmac::gateway {
namespace {

tl::unexpected<Error> refuse(std::string message) {
  return failure(MinorCode::InvalidParameterValue, std::move(message));
}

Expected<> check_count(const char* function, int count, int least, std::size_t most) {
  if (count < least || static_cast<std::size_t>(count) > most) {
    return refuse(fmt::format("{}: {} must be {} to {}", function, count, least, most));
  }
  return {};
}

Expected<> set_module(const char* function, const sdk::ModuleChoice& module, sdk::ModuleChoice& target) {
  if (module.name.empty()) return refuse(fmt::format("{}: the name of a module is needed", function));
  target = module;
  return {};
}

sdk::Joint without_what_is_set(const sdk::Joint& joint) {
  sdk::Joint left;
  left.max_measured_speed = joint.max_measured_speed;
  left.max_jump = joint.max_jump;
  left.force_sensor = joint.force_sensor;
  left.force = joint.force;
  return left;
}

}  // namespace

void ConfigDraft::discard(const sdk::DeviceObject* in_force) {
  draft_ = in_force != nullptr ? *in_force : sdk::DeviceObject{};
  begun_ = in_force != nullptr;
  extent_ = Extent::Loops;
}

sdk::DeviceObject& ConfigDraft::edit() noexcept {
  extent_ = std::max(extent_, Extent::Configuration);
  return draft_;
}

Expected<> ConfigDraft::begin(const sdk::DeviceObject& device) {
  draft_ = device;
  // The rest is for the device driver to set, joint by joint; what no setter sets stays as device.json has it.
  described_.clear();
  for (const sdk::Joint& joint : device.joints) described_.push_back(without_what_is_set(joint));
  described_spindles_ = device.spindles;
  draft_.joints.clear();
  for (sdk::Joint& joint : draft_.held_joints) joint = without_what_is_set(joint);
  draft_.kinematics = {};
  draft_.actuator_map = {};
  draft_.digital_control_interface = {};
  draft_.digital_io_interface = {};
  begun_ = true;
  extent_ = Extent::Mechanism;
  return {};
}

Expected<> ConfigDraft::apply() {
  if (!begun_) {
    return failure(MinorCode::Other,
                   "Apply: there is no mechanism to configure; load a device driver with Device.Load");
  }
  return controller_.apply(draft_, extent_).map([this] { extent_ = Extent::Loops; });
}

Expected<sdk::Joint*> ConfigDraft::joint(int number, const char* function) {
  const std::size_t moved = draft_.joints.size();
  const std::size_t count = moved + draft_.held_joints.size();
  if (number < 0 || static_cast<std::size_t>(number) >= count) {
    return refuse(count == 0
                      ? fmt::format("{}: there is no joint {}; set the number of joints first", function, number)
                      : fmt::format("{}: there is no joint {}; joints are 0 to {}", function, number, count - 1));
  }
  const auto index = static_cast<std::size_t>(number);
  return index < moved ? &draft_.joints[index] : &draft_.held_joints[index - moved];
}

template <typename Change>
Expected<> ConfigDraft::change_joint(int number, const char* function, Change&& change) {
  return joint(number, function).map([&](sdk::Joint* found) {
    (void)edit();
    change(*found);
  });
}

Expected<> ConfigDraft::set_limit(int number, const char* function, const char* key, double value,
                                  double JointLimits::*member) {
  return check_device_range(key, value, function).and_then([&] {
    return change_joint(number, function, [&](sdk::Joint& found) { found.limits.*member = value; });
  });
}

Expected<> ConfigDraft::set_kinematics(const sdk::ModuleChoice& module) {
  return set_module("SetMechanismKinematics", module, edit().kinematics);
}

Expected<> ConfigDraft::set_actuator_map(const sdk::ModuleChoice& module) {
  return set_module("SetMechanismActuatorMap", module, edit().actuator_map);
}

Expected<> ConfigDraft::set_number_of_joints(int count) {
  return check_count("SetMechanismNumberOfJoints", count, 1, kMaxJoints - draft_.held_joints.size()).map([&] {
    auto& joints = edit().joints;
    for (std::size_t i = joints.size(); i < static_cast<std::size_t>(count); ++i) {
      joints.push_back(i < described_.size() ? described_[i] : sdk::Joint{});
    }
    joints.resize(static_cast<std::size_t>(count));
  });
}

Expected<> ConfigDraft::set_number_of_spindles(int count) {
  return check_count("SetMechanismNumberOfSpindles", count, 0, kMaxSpindles).map([&] {
    auto& spindles = edit().spindles;
    for (std::size_t i = spindles.size(); i < static_cast<std::size_t>(count); ++i) {
      spindles.push_back(i < described_spindles_.size() ? described_spindles_[i] : sdk::Spindle{});
    }
    spindles.resize(static_cast<std::size_t>(count));
  });
}

Expected<> ConfigDraft::set_number_of_actuators(int count) {
  return check_count("SetMechanismNumberOfActuators", count, 1, kMaxJoints).map([&] {
    edit().actuators.resize(static_cast<std::size_t>(count));
  });
}

Expected<> ConfigDraft::set_joint_name(int number, std::string_view name) {
  if (name.empty()) return refuse("SetMechanismJointName: a name must have a letter at least");
  return change_joint(number, "SetMechanismJointName", [&](sdk::Joint& found) { found.limits.name = name; });
}

Expected<> ConfigDraft::set_joint_type(int number, JointType type) {
  return change_joint(number, "SetMechanismJointType", [&](sdk::Joint& found) { found.limits.type = type; });
}

Expected<> ConfigDraft::set_joint_limit_type(int number, JointLimitType type) {
  return change_joint(number, "SetMechanismJointLimitType", [&](sdk::Joint& found) { found.limits.limit_type = type; });
}

Expected<> ConfigDraft::set_joint_maximum_limit(int number, double value) {
  return set_limit(number, "SetMechanismJointMaximumLimit", "joint/Max", value, &JointLimits::max);
}

Expected<> ConfigDraft::set_joint_minimum_limit(int number, double value) {
  return set_limit(number, "SetMechanismJointMinimumLimit", "joint/Min", value, &JointLimits::min);
}

Expected<> ConfigDraft::set_joint_maximum_speed(int number, double value) {
  return set_limit(number, "SetMechanismJointMaximumSpeed", "joint/MaxSpeed", value, &JointLimits::max_speed);
}

Expected<> ConfigDraft::set_joint_maximum_acceleration(int number, double value) {
  return set_limit(number, "SetMechanismJointMaximumAcceleration", "joint/MaxAcceleration", value,
                   &JointLimits::max_acceleration);
}

Expected<> ConfigDraft::set_joint_maximum_jerk(int number, double value) {
  return set_limit(number, "SetMechanismJointMaximumJerk", "joint/MaxJerk", value, &JointLimits::max_jerk);
}

Expected<> ConfigDraft::set_maximum_feedrate(double mm_min) {
  return check_device_range("MaxFeedrate", mm_min, "SetMechanismMaxFeedrate").map([&] {
    edit().max_feedrate_mm_min = mm_min;
  });
}

Expected<> ConfigDraft::set_joint_control_method(int number, ControlMethod method) {
  return joint(number, "SetMechanismJointControlMethod").map([&](sdk::Joint* found) {
    // A joint under force control is out of the plan.
    if (method == ControlMethod::Force || found->method == ControlMethod::Force) (void)edit();
    found->method = method;
  });
}

Expected<> ConfigDraft::set_joint_servo_control_law(int number, const sdk::ModuleChoice& module) {
  return joint(number, "SetMechanismJointServoControlLaw").and_then([&](sdk::Joint* found) {
    if (found->servo_law.name.empty()) (void)edit();  // a loop that its drive closed so far
    return set_module("SetMechanismJointServoControlLaw", module, found->servo_law);
  });
}

Expected<> ConfigDraft::set_joint_servo_control_gains(int number, std::span<const double> gains) {
  for (const double gain : gains) {
    if (auto sound = check_device_range("joint/Gains", gain, "SetMechanismJointServoControlGains"); !sound)
      return sound;
  }
  return joint(number, "SetMechanismJointServoControlGains").map([&](sdk::Joint* found) {
    found->gains.assign(gains.begin(), gains.end());
  });
}

Expected<> ConfigDraft::set_joint_watch(int number, double max_following_error, double max_effort) {
  const auto fine =
      check_device_range("joint/MaxFollowingError", max_following_error, "following-error bound").and_then([&] {
        return check_device_range("joint/MaxEffort", max_effort, "effort bound");
      });
  if (!fine) return fine;
  return change_joint(number, "joint watch", [&](sdk::Joint& found) {
    found.max_following_error = max_following_error;
    found.max_effort = max_effort;
  });
}

Expected<> ConfigDraft::set_joint_mechanics(int number, const JointMechanics& mechanics) {
  return change_joint(number, "joint mechanics", [&](sdk::Joint& found) { found.mechanics = mechanics; });
}

Expected<> ConfigDraft::set_digital_control_interface(const sdk::ModuleChoice& module) {
  return set_module("SetDigitalControlInterface", module, edit().digital_control_interface);
}

Expected<> ConfigDraft::initialize_digital_control_interface() {
  if (draft_.digital_control_interface.name.empty()) {
    return failure(MinorCode::InvalidParameter,
                   "InitializeDigitalControlInterface: choose one with SetDigitalControlInterface first");
  }
  return controller_.check_control_interface(draft_.digital_control_interface);
}

Expected<> ConfigDraft::set_digital_io_interface(const sdk::ModuleChoice& module) {
  // A mechanism without digital I/O names no interface.
  edit().digital_io_interface = module;
  return {};
}

Expected<> ConfigDraft::initialize_digital_io_interface() {
  if (draft_.digital_io_interface.name.empty()) return {};
  return controller_.check_io_interface(draft_.digital_io_interface);
}

}  // namespace rmac::gateway
