#include "gateway/rmac_config/loop_editor.hpp"

#include "gateway/json/range.hpp"

namespace rmac::gateway {

Expected<> LoopEditor::set_control_method(int joint, ControlMethod method) {
  return draft_.joint(joint, "SetMechanismJointControlMethod").map([&](sdk::Joint* found) {
    // A joint under force control is out of the plan.
    if (method == ControlMethod::Force || found->method == ControlMethod::Force) (void)draft_.edit();
    found->method = method;
  });
}

Expected<> LoopEditor::set_servo_law(int joint, const sdk::ModuleChoice& module) {
  constexpr const char* kFunction = "SetMechanismJointServoControlLaw";
  return draft_.joint(joint, kFunction).and_then([&](sdk::Joint* found) {
    if (found->servo_law.name.empty()) (void)draft_.edit();  // a loop that its drive closed so far
    return choose_module(kFunction, module, found->servo_law);
  });
}

Expected<> LoopEditor::set_gains(int joint, std::span<const double> gains) {
  constexpr const char* kFunction = "SetMechanismJointServoControlGains";
  return check_gains(kFunction, gains)
      .and_then([&] { return draft_.joint(joint, kFunction); })
      .map([&](sdk::Joint* found) { found->gains.assign(gains.begin(), gains.end()); });
}

Expected<> LoopEditor::set_watch(int joint, double max_following_error, double max_effort) {
  return check_device_range("joint/MaxFollowingError", max_following_error, "following-error bound")
      .and_then([&] { return check_device_range("joint/MaxEffort", max_effort, "effort bound"); })
      .and_then([&] { return draft_.edit_joint(joint, "joint watch"); })
      .map([&](sdk::Joint* found) {
        found->max_following_error = max_following_error;
        found->max_effort = max_effort;
      });
}

Expected<> LoopEditor::set_mechanics(int joint, const JointMechanics& mechanics) {
  return draft_.edit_joint(joint, "joint mechanics").map([&](sdk::Joint* found) { found->mechanics = mechanics; });
}

}  // namespace rmac::gateway
