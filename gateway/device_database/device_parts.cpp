#include "gateway/device_database/device_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "gateway/device_database/device_json.hpp"
#include "gateway/device_database/json_values.hpp"
#include "gateway/device_database/part_names.hpp"
#include "gateway/json/json_schema.hpp"
#include "gateway/json/schemas.hpp"

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;

std::string_view name(const Json& object, const char* key) {
  return object.at(key).get_ref<const std::string&>();
}

void take_parameters(const Json& parameters, sdk::ModuleChoice& choice) {
  for (const auto& [key, value] : parameters.items()) {
    if (value.is_string()) {
      choice.texts[key] = value.get<std::string>();
    } else if (value.is_array()) {
      choice.numbers[key] = value.get<std::vector<double>>();
    } else {
      choice.numbers[key] = {value.get<double>()};
    }
  }
}

JointLimits limits(const Json& joint) {
  JointLimits limits;
  limits.name = text(joint, "Name");
  limits.type = named(name(joint, "Type"), kJointTypeNames);
  limits.limit_type = named(name(joint, "LimitType"), kJointLimitTypeNames);
  limits.min = number(joint, "Min");
  limits.max = number(joint, "Max");
  limits.max_speed = number(joint, "MaxSpeed");
  limits.max_acceleration = number(joint, "MaxAcceleration");
  limits.max_jerk = number(joint, "MaxJerk");
  return limits;
}

std::vector<Resonance> resonances(const Json& list) {
  std::vector<Resonance> result;
  for (const Json& entry : list) {
    Resonance resonance;
    resonance.frequency_hz = number(entry, "Frequency");
    resonance.damping = number(entry, "Damping");
    resonance.width = entry.value("Width", resonance.width);
    result.push_back(resonance);
  }
  return result;
}

JointMechanics mechanics(const Json& joint) {
  JointMechanics result;
  if (const auto table = joint.find("PitchErrors"); table != joint.end()) {
    result.pitch = {number(*table, "First"), number(*table, "Step"), (*table)["Errors"].get<std::vector<double>>()};
  }
  result.backlash = joint.value("Backlash", 0.0);
  result.resonances = resonances(joint.value("Resonances", Json::array()));
  result.low_pass_hz = joint.value("LowPass", 0.0);
  return result;
}

Cogging cogging(const Json& actuator) {
  Cogging result;
  const auto given = actuator.find("Cogging");
  if (given == actuator.end()) return result;
  result.lead_s = number(*given, "Lead");
  for (const Json& one : (*given)["Harmonics"]) {
    result.harmonics.push_back({one["Order"].get<int>(), number(one, "Cosine"), number(one, "Sine")});
  }
  return result;
}

std::optional<sdk::ForceSensor> force_sensor(const Json& joint) {
  const auto sensor = joint.find("ForceSensor");
  if (sensor == joint.end()) return {};
  return sdk::ForceSensor{.bus = text(*sensor, "Bus"),
                          .axis = (*sensor)["Axis"].get<std::uint32_t>(),
                          .newton_per_count = number(*sensor, "NewtonPerCount"),
                          .zero_counts = sensor->value("ZeroCounts", std::int32_t{0})};
}

std::optional<ForceControl> force_control(const Json& joint) {
  const auto force = joint.find("ForceControl");
  if (force == joint.end()) return {};
  ForceControl result;
  result.approach_speed = number(*force, "ApproachSpeed");
  result.contact_force = number(*force, "ContactForce");
  result.gain = force->value("Gain", 0.0);
  result.reset_time_s = force->value("ResetTime", 0.0);
  result.max_speed = number(*force, "MaxSpeed");
  result.max_force = number(*force, "MaxForce");
  result.max_search = number(*force, "MaxSearch");
  result.mass = force->value("Mass", 0.0);
  result.stiffness = force->value("Stiffness", 0.0);
  return result;
}

std::optional<Gantry> gantry(const Json& entry) {
  const auto gantry = entry.find("Gantry");
  if (gantry == entry.end()) return std::nullopt;
  return Gantry{number(*gantry, "MaxSkew"), number(*gantry, "Stiffness"), number(*gantry, "Damping")};
}

/// device.json's schema of one of its definitions, or of a list of them.
std::string schema_of(const char* definition, bool list) {
  const Json definitions = Json::parse(device_schema_text()).at("definitions");
  // Itself, and no reference to it: what is wrong is told by what stands here.
  Json schema = definitions.at(definition);
  if (list) schema = {{"type", "array"}, {"items", {{"$ref", fmt::format("#/definitions/{}", definition)}}}};
  schema["definitions"] = definitions;
  return schema.dump();
}

Expected<> check_against(const Json& document, const JsonSchema& schema) {
  const std::string wrong = schema.check(document);
  return wrong.empty() ? Expected<>() : failure(MinorCode::InvalidParameterValue, wrong);
}

Json completed(const Json& list, const Json& present) {
  if (!list.is_array()) return list;
  Json whole = list;
  for (std::size_t i = 0; i < std::min(list.size(), present.size()); ++i) {
    if (!list[i].is_object()) continue;
    whole[i] = present[i];
    whole[i].update(list[i]);
  }
  return whole;
}

}  // namespace

sdk::ModuleChoice module_choice(const Json& object) {
  sdk::ModuleChoice choice;
  choice.name = text(object, "Module");
  take_parameters(object.value("Parameters", Json::object()), choice);
  return choice;
}

std::vector<sdk::Joint> joints(const Json& list) {
  std::vector<sdk::Joint> result;
  for (const Json& entry : list) {
    sdk::Joint joint;
    joint.limits = limits(entry);
    if (const auto law = entry.find("ServoControlLaw"); law != entry.end()) joint.servo_law = module_choice(*law);
    joint.method = named(name(entry, "ControlMethod"), kControlMethodNames);
    joint.gains = entry.value("Gains", std::vector<double>());
    joint.max_following_error = number(entry, "MaxFollowingError");
    joint.max_effort = number(entry, "MaxEffort");
    joint.mechanics = mechanics(entry);
    joint.max_measured_speed = number(entry, "MaxMeasuredSpeed");
    joint.max_jump = number(entry, "MaxJump");
    joint.force_sensor = force_sensor(entry);
    joint.force = force_control(entry);
    joint.gantry = gantry(entry);
    result.push_back(std::move(joint));
  }
  return result;
}

std::vector<sdk::Actuator> actuators(const Json& list) {
  std::vector<sdk::Actuator> result;
  for (const Json& entry : list) {
    sdk::Actuator actuator;
    actuator.bus = text(entry, "Bus");
    actuator.axis = entry["Axis"].get<std::uint32_t>();
    actuator.scale.counts_per_revolution = number(entry, "CountsPerRevolution");
    actuator.scale.rated_torque_nm = number(entry, "RatedTorque");
    actuator.max_measured_torque_nm = number(entry, "MaxMeasuredTorque");
    actuator.scale.direction = entry.value("Direction", 1);
    actuator.scale.home_counts = entry.value("HomeCounts", std::int32_t{0});
    actuator.homing_turn = entry.value("HomingTurn", 0);
    actuator.position_gain = number(entry, "PositionGain");
    if (const auto probe = entry.find("TouchProbe"); probe != entry.end()) {
      actuator.probe_edge = named(probe->get<int>(), kTouchProbeNumbers);
    }
    actuator.cogging = cogging(entry);
    result.push_back(std::move(actuator));
  }
  return result;
}

std::vector<sdk::Spindle> spindles(const Json& list) {
  std::vector<sdk::Spindle> result;
  for (const Json& entry : list) {
    sdk::Spindle spindle;
    spindle.bus = text(entry, "Bus");
    spindle.axis = entry["Axis"].get<std::uint32_t>();
    spindle.max_speed_rpm = number(entry, "MaxSpeed");
    spindle.max_torque_nm = number(entry, "MaxTorque");
    spindle.horse_power = number(entry, "HorsePower");
    constexpr double kSpeedToleranceRpm = 20;
    constexpr double kSpeedTimeoutS = 5;
    spindle.speed_tolerance_rpm = number(entry, "SpeedTolerance", kSpeedToleranceRpm);
    spindle.speed_timeout_s = number(entry, "SpeedTimeout", kSpeedTimeoutS);
    if (const auto law = entry.find("ServoControlLaw"); law != entry.end()) spindle.servo_law = module_choice(*law);
    if (entry.value("ControlMethod", "") == "Position") spindle.method = ControlMethod::Position;
    spindle.gains = entry.value("Gains", std::vector<double>());
    spindle.scale = {number(entry, "CountsPerRevolution"), number(entry, "RatedTorque"), entry.value("Direction", 1)};
    spindle.max_acceleration_rpm_s = number(entry, "MaxAcceleration");
    constexpr double kFollowingErrorDeg = 90;
    spindle.max_following_error_deg = number(entry, "MaxFollowingError", kFollowingErrorDeg);
    result.push_back(std::move(spindle));
  }
  return result;
}

Expected<> read_parameters(const Json& parameters, sdk::ModuleChoice& choice) {
  static const JsonSchema kSchema(schema_of("parameters", false));
  return check_against(parameters, kSchema).map([&] { take_parameters(parameters, choice); });
}

Expected<std::vector<sdk::Actuator>> read_actuators(const Json& list, const std::vector<sdk::Actuator>& present) {
  static const JsonSchema kSchema(schema_of("actuator", true));
  const Json whole = completed(list, to_json(present));
  return check_against(whole, kSchema).map([&] { return actuators(whole); });
}

Expected<std::vector<sdk::Spindle>> read_spindles(const Json& list, const std::vector<sdk::Spindle>& present) {
  static const JsonSchema kSchema(schema_of("spindle", true));
  const Json whole = completed(list, to_json(present));
  return check_against(whole, kSchema).map([&] { return spindles(whole); });
}

Expected<std::vector<Resonance>> read_resonances(const Json& list) {
  static const JsonSchema kSchema(schema_of("resonances", false));
  return check_against(list, kSchema).map([&] { return resonances(list); });
}

}  // namespace rmac::gateway
