#include "gateway/rmac_config/spindle_editor.hpp"

#include <fmt/format.h>

#include "gateway/json/range.hpp"

namespace rmac::gateway {

Expected<> SpindleEditor::set_maximum_rpm(int spindle, double rpm) {
  constexpr const char* kFunction = "SetMechanismSpindleMaxRPM";
  return check_device_range("spindle/MaxSpeed", rpm, kFunction)
      .and_then([&] { return draft_.edit_spindle(spindle, kFunction); })
      .map([&](sdk::Spindle* found) { found->max_speed_rpm = rpm; });
}

Expected<> SpindleEditor::set_maximum_torque(int spindle, double torque_nm) {
  constexpr const char* kFunction = "largest torque of a spindle";
  return check_device_range("spindle/MaxTorque", torque_nm, kFunction)
      .and_then([&] { return draft_.edit_spindle(spindle, kFunction); })
      .map([&](sdk::Spindle* found) { found->max_torque_nm = torque_nm; });
}

Expected<> SpindleEditor::set_control_method(int spindle, ControlMethod method) {
  constexpr const char* kFunction = "SetMechanismSpindleControlMethod";
  if (method == ControlMethod::Force) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: nothing asks a spindle for a force; choose DMAC_VELOCITY_CONTROL or "
                               "DMAC_POSITION_CONTROL, and bound its torque with Machine_SetMechanismSpindleMaxTorque",
                               kFunction));
  }
  return draft_.edit_spindle(spindle, kFunction).map([&](sdk::Spindle* found) { found->method = method; });
}

Expected<> SpindleEditor::set_servo_law(int spindle, const sdk::ModuleChoice& module) {
  return draft_.edit_spindle(spindle, "SetMechanismSpindleServoControlLaw").map([&](sdk::Spindle* found) {
    found->servo_law = module;
    if (module.name.empty()) found->gains.clear();
  });
}

Expected<> SpindleEditor::set_gains(int spindle, std::span<const double> gains) {
  constexpr const char* kFunction = "SetMechanismSpindleServoControlGains";
  return check_gains(kFunction, gains)
      .and_then([&] { return draft_.edit_spindle(spindle, kFunction); })
      .map([&](sdk::Spindle* found) { found->gains.assign(gains.begin(), gains.end()); });
}

}  // namespace rmac::gateway
