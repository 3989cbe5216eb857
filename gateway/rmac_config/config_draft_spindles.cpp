// What RMAC_Config says of spindles.
#include <fmt/format.h>

#include "gateway/json/range.hpp"
#include "gateway/rmac_config/config_draft.hpp"

namespace rmac::gateway {

Expected<sdk::Spindle*> ConfigDraft::spindle(int number, const char* function) {
  const std::size_t count = draft_.spindles.size();
  if (number >= 0 && static_cast<std::size_t>(number) < count) {
    return &edit().spindles[static_cast<std::size_t>(number)];
  }
  return failure(MinorCode::InvalidParameterValue,
                 count == 0
                     ? fmt::format("{}: the mechanism has no spindle", function)
                     : fmt::format("{}: there is no spindle {}; spindles are 0 to {}", function, number, count - 1));
}

Expected<> ConfigDraft::set_spindle_maximum_rpm(int number, double rpm) {
  constexpr const char* kFunction = "SetMechanismSpindleMaxRPM";
  return check_device_range("spindle/MaxSpeed", rpm, kFunction)
      .and_then([&] { return spindle(number, kFunction); })
      .map([&](sdk::Spindle* found) { found->max_speed_rpm = rpm; });
}

Expected<> ConfigDraft::set_spindle_maximum_torque(int number, double torque_nm) {
  constexpr const char* kFunction = "largest torque of a spindle";
  return check_device_range("spindle/MaxTorque", torque_nm, kFunction)
      .and_then([&] { return spindle(number, kFunction); })
      .map([&](sdk::Spindle* found) { found->max_torque_nm = torque_nm; });
}

Expected<> ConfigDraft::set_spindle_control_method(int number, ControlMethod method) {
  constexpr const char* kFunction = "SetMechanismSpindleControlMethod";
  if (method == ControlMethod::Force) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: nothing asks a spindle for a force; choose DMAC_VELOCITY_CONTROL or "
                               "DMAC_POSITION_CONTROL, and bound its torque with Machine_SetMechanismSpindleMaxTorque",
                               kFunction));
  }
  return spindle(number, kFunction).map([&](sdk::Spindle* found) { found->method = method; });
}

Expected<> ConfigDraft::set_spindle_servo_control_law(int number, const sdk::ModuleChoice& module) {
  return spindle(number, "SetMechanismSpindleServoControlLaw").map([&](sdk::Spindle* found) {
    found->servo_law = module;
    if (module.name.empty()) found->gains.clear();
  });
}

Expected<> ConfigDraft::set_spindle_servo_control_gains(int number, std::span<const double> gains) {
  constexpr const char* kFunction = "SetMechanismSpindleServoControlGains";
  for (const double gain : gains) {
    if (auto sound = check_device_range("joint/Gains", gain, kFunction); !sound) return sound;
  }
  return spindle(number, kFunction).map([&](sdk::Spindle* found) { found->gains.assign(gains.begin(), gains.end()); });
}

}  // namespace rmac::gateway
