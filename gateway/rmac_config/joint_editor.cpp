#include "gateway/rmac_config/joint_editor.hpp"

#include "gateway/json/range.hpp"

namespace rmac::gateway {

Expected<> JointEditor::set(int joint, const char* function, const char* key, double value,
                            double JointLimits::*member) {
  return check_device_range(key, value, function)
      .and_then([&] { return draft_.edit_joint(joint, function); })
      .map([&](sdk::Joint* found) { found->limits.*member = value; });
}

Expected<> JointEditor::set_name(int joint, std::string_view name) {
  constexpr const char* kFunction = "joint name";
  if (name.empty()) {
    return failure(MinorCode::InvalidParameterValue, std::string(kFunction) + ": a name must have a letter at least");
  }
  return draft_.edit_joint(joint, kFunction).map([&](sdk::Joint* found) { found->limits.name = name; });
}

Expected<> JointEditor::set_type(int joint, JointType type) {
  return draft_.edit_joint(joint, "SetMechanismJointType").map([&](sdk::Joint* found) { found->limits.type = type; });
}

Expected<> JointEditor::set_limit_type(int joint, JointLimitType type) {
  return draft_.edit_joint(joint, "SetMechanismJointLimitType").map([&](sdk::Joint* found) {
    found->limits.limit_type = type;
  });
}

Expected<> JointEditor::set_maximum_limit(int joint, double value) {
  return set(joint, "SetMechanismJointMaximumLimit", "joint/Max", value, &JointLimits::max);
}

Expected<> JointEditor::set_minimum_limit(int joint, double value) {
  return set(joint, "SetMechanismJointMinimumLimit", "joint/Min", value, &JointLimits::min);
}

Expected<> JointEditor::set_maximum_speed(int joint, double value) {
  return set(joint, "SetMechanismJointMaximumSpeed", "joint/MaxSpeed", value, &JointLimits::max_speed);
}

Expected<> JointEditor::set_maximum_acceleration(int joint, double value) {
  return set(joint, "SetMechanismJointMaximumAcceleration", "joint/MaxAcceleration", value,
             &JointLimits::max_acceleration);
}

Expected<> JointEditor::set_maximum_jerk(int joint, double value) {
  return set(joint, "SetMechanismJointMaximumJerk", "joint/MaxJerk", value, &JointLimits::max_jerk);
}

}  // namespace rmac::gateway
