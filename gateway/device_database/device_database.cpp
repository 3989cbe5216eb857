#include "gateway/device_database/device_database.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "gateway/device_database/device_checks.hpp"
#include "gateway/json/json_document.hpp"
#include "gateway/json/schemas.hpp"

namespace rmac::gateway {
namespace {

// The functions below read a document that the schema has passed: what it requires is there and has its type.
using Json = nlohmann::json;

std::string text(const Json& object, const char* key) {
  return object.value(key, std::string());
}
double number(const Json& object, const char* key, double otherwise = 0) {
  return object.value(key, otherwise);
}

/// The enumerator whose name stands in the file; the schema's `enum` lists the same names.
template <typename Enumeration>
Enumeration named(const Json& object, const char* key, const std::map<std::string, Enumeration>& names) {
  return names.at(object.at(key).get<std::string>());
}

sdk::ModuleChoice module_choice(const Json& object) {
  sdk::ModuleChoice choice;
  choice.name = text(object, "Module");
  const Json parameters = object.value("Parameters", Json::object());
  for (const auto& [name, value] : parameters.items()) {
    if (value.is_string()) {
      choice.texts[name] = value.get<std::string>();
    } else if (value.is_array()) {
      choice.numbers[name] = value.get<std::vector<double>>();
    } else {
      choice.numbers[name] = {value.get<double>()};
    }
  }
  return choice;
}

JointLimits limits(const Json& joint) {
  JointLimits limits;
  limits.name = text(joint, "Name");
  limits.type = named<JointType>(
      joint, "Type", {{"Rotary", JointType::Rotary}, {"Linear", JointType::Linear}, {"Screw", JointType::Screw}});
  limits.limit_type = named<JointLimitType>(joint, "LimitType",
                                            {{"Limited", JointLimitType::Limited},
                                             {"Infinite", JointLimitType::Infinite},
                                             {"InfinitePositive", JointLimitType::InfinitePositive},
                                             {"InfiniteNegative", JointLimitType::InfiniteNegative}});
  limits.min = number(joint, "Min");
  limits.max = number(joint, "Max");
  limits.max_speed = number(joint, "MaxSpeed");
  limits.max_acceleration = number(joint, "MaxAcceleration");
  limits.max_jerk = number(joint, "MaxJerk");
  return limits;
}

JointMechanics mechanics(const Json& joint) {
  JointMechanics result;
  if (const auto table = joint.find("PitchErrors"); table != joint.end()) {
    result.pitch = {number(*table, "First"), number(*table, "Step"), (*table)["Errors"].get<std::vector<double>>()};
  }
  result.backlash = joint.value("Backlash", 0.0);
  for (const Json& entry : joint.value("Resonances", Json::array())) {
    Resonance resonance;
    resonance.frequency_hz = number(entry, "Frequency");
    resonance.damping = number(entry, "Damping");
    resonance.width = entry.value("Width", resonance.width);
    result.resonances.push_back(resonance);
  }
  result.low_pass_hz = joint.value("LowPass", 0.0);
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
  result.gain = number(*force, "Gain");
  result.reset_time_s = number(*force, "ResetTime");
  result.max_speed = number(*force, "MaxSpeed");
  result.max_force = number(*force, "MaxForce");
  result.max_search = number(*force, "MaxSearch");
  return result;
}

std::vector<sdk::Joint> joints(const Json& list) {
  std::vector<sdk::Joint> result;
  for (const Json& entry : list) {
    sdk::Joint joint;
    joint.limits = limits(entry);
    if (const auto law = entry.find("ServoControlLaw"); law != entry.end()) joint.servo_law = module_choice(*law);
    joint.method = named<ControlMethod>(entry, "ControlMethod",
                                        {{"Position", ControlMethod::Position},
                                         {"Velocity", ControlMethod::Velocity},
                                         {"Force", ControlMethod::Force}});
    joint.gains = entry.value("Gains", std::vector<double>());
    joint.max_following_error = number(entry, "MaxFollowingError");
    joint.max_effort = number(entry, "MaxEffort");
    joint.mechanics = mechanics(entry);
    joint.max_measured_speed = number(entry, "MaxMeasuredSpeed");
    joint.max_jump = number(entry, "MaxJump");
    joint.force_sensor = force_sensor(entry);
    joint.force = force_control(entry);
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
    static const std::map<int, TouchProbeEdge> kEdges{{1, TouchProbeEdge::FirstRising},
                                                      {-1, TouchProbeEdge::FirstFalling},
                                                      {2, TouchProbeEdge::SecondRising},
                                                      {-2, TouchProbeEdge::SecondFalling}};
    if (const auto probe = entry.find("TouchProbe"); probe != entry.end()) {
      actuator.probe_edge = kEdges.at(probe->get<int>());
    }
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

std::vector<sdk::ToolChangeStep> tool_change(const Json& list) {
  using Step = sdk::ToolChangeStep;
  constexpr double kTimeOutS = 10;
  std::vector<Step> result;
  for (const Json& entry : list) {
    const std::string what = text(entry, "Do");
    const std::string whose = entry.value("For", "");
    Step step;
    step.kind = what == "MoveTo"   ? Step::Kind::MoveTo
                : what == "Switch" ? Step::Kind::Switch
                : what == "Select" ? Step::Kind::Select
                                   : Step::Kind::Await;
    step.whose = whose == "Old" ? Step::Whose::Old : whose == "New" ? Step::Whose::New : Step::Whose::Both;
    step.joints = entry.value("Joints", std::vector<double>());
    step.outputs = entry.value("Outputs", std::vector<std::string>());
    step.input = entry.value("Input", "");
    step.on = entry.value("On", true);
    step.timeout_s = number(entry, "TimeOut", kTimeOutS);
    result.push_back(std::move(step));
  }
  return result;
}

sdk::Probing probing(const Json& file) {
  const Json given = file.value("Probing", Json::object());
  sdk::Probing result;
  result.prehit_distance_mm = number(given, "PrehitDistance", result.prehit_distance_mm);
  result.search_distance_mm = number(given, "SearchDistance", result.search_distance_mm);
  result.retract_distance_mm = number(given, "RetractDistance", result.retract_distance_mm);
  result.scan_speed_mm_s = number(given, "ScanSpeed", result.scan_speed_mm_s);
  result.settle_time_s = number(given, "SettleTime", result.settle_time_s);
  return result;
}

/// Names of the drives' inputs join those of the I/O interface, on bits that it has not named.
std::string add_drive_inputs(const Json& list, sdk::DeviceObject& device) {
  constexpr int kLastBit = 52;  // beyond it a number of JSON is not exact everywhere
  std::set<int> taken;
  for (const auto& [name, bit] : device.inputs) taken.insert(bit);
  int free = kLastBit;
  for (std::size_t i = 0; i < list.size(); ++i) {
    for (const auto& [name, bit] : list[i].value("Inputs", std::map<std::string, int>())) {
      while (taken.contains(free)) --free;
      if (free < 0) {
        return fmt::format("/Actuators/{}/Inputs/{} is one input too many; bits 0 to {} are taken", i, name, kLastBit);
      }
      if (!device.inputs.emplace(name, free).second) {
        return fmt::format("/Actuators/{}/Inputs/{} has the name of another input; allowed is a name of its own", i,
                           name);
      }
      device.drive_inputs[free--] = {i, bit};
    }
  }
  return {};
}

sdk::DeviceObject device_object(const Json& file) {
  sdk::DeviceObject device;
  device.name = text(file, "MechanismName");
  device.device_driver = text(file, "DeviceDriver");
  device.driver_version = text(file, "DeviceDriverVersion");
  device.type = text(file, "Type");
  device.configuration_type = text(file, "ConfigurationType");
  device.speed_capability = text(file, "SpeedCapability");
  device.tool_changer = file.value("ToolChanger", false);
  device.tool_change = tool_change(file.value("ToolChange", Json::array()));
  device.number_of_tools = file.value("NumberOfTools", 1);
  device.length_mm = number(file["WorkingVolume"], "Length");
  device.width_mm = number(file["WorkingVolume"], "Width");
  device.depth_mm = number(file["WorkingVolume"], "Depth");
  device.max_feedrate_mm_min = number(file, "MaxFeedrate");
  device.max_pallet_load_kg = number(file, "MaxPalletLoad");
  device.positioning_tolerance_mm = number(file, "PositioningTolerance");
  device.repeatability_tolerance_mm = number(file, "RepeatabilityTolerance");
  device.path_accel_rise_mm_s2 = number(file, "PathAccelRise");
  device.path_accel_fall_mm_s2 = number(file, "PathAccelFall");
  device.joints = joints(file["Joints"]);
  device.held_joints = joints(file.value("HeldJoints", Json::array()));
  device.actuators = actuators(file["Actuators"]);
  device.spindles = spindles(file.value("Spindles", Json::array()));
  device.overlay = file.value("Overlay", false);
  device.probing = probing(file);
  device.kinematics = module_choice(file["Kinematics"]);
  device.actuator_map = module_choice(file["ActuatorMap"]);
  device.digital_control_interface = module_choice(file["DigitalControlInterface"]);
  device.digital_io_interface = module_choice(file["DigitalIOInterface"]);
  device.inputs = file["DigitalIOInterface"].value("Inputs", std::map<std::string, int>());
  device.outputs = file["DigitalIOInterface"].value("Outputs", std::map<std::string, int>());
  return device;
}

/// An end of the travel that the limit type needs and the file lacks. A 0 put in its place would be a limit nobody
/// chose.
std::string missing_end(const Json& file, const sdk::DeviceObject& device) {
  const auto search = [&](const char* key, const std::vector<sdk::Joint>& list) -> std::string {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const JointLimits& limits = list[i].limits;
      const Json& entry = file[key][i];
      const char* missing = ends_below(limits) && !entry.contains("Min")   ? "Min"
                            : ends_above(limits) && !entry.contains("Max") ? "Max"
                                                                           : nullptr;
      if (missing != nullptr) {
        return fmt::format("/{}/{} lacks the key \"{}\", a number (mm or deg), which LimitType \"{}\" needs", key, i,
                           missing, text(entry, "LimitType"));
      }
    }
    return {};
  };
  std::string problem = search("Joints", device.joints);
  return problem.empty() ? search("HeldJoints", device.held_joints) : problem;
}

}  // namespace

Expected<DeviceDatabase> read_device_json(const std::filesystem::path& device_json) {
  try {
    static const JsonSchema kSchema(device_schema_text());
    const Expected<Json> document = read_json_document(device_json, kSchema);
    if (!document) return tl::make_unexpected(document.error());
    DeviceDatabase database{.device = device_object(*document), .mechanism_id = {}};
    if (document->contains("MechanismID")) database.mechanism_id = (*document)["MechanismID"].get<std::int64_t>();

    std::string problem = missing_end(*document, database.device);
    if (problem.empty()) problem = add_drive_inputs((*document)["Actuators"], database.device);
    if (problem.empty()) problem = check_sense(database.device);
    if (!problem.empty()) {
      return failure(MinorCode::InvalidParameterValue, fmt::format("{}: {}", device_json.string(), problem));
    }
    return database;
  } catch (const std::exception& error) {
    return failure(MinorCode::Other, fmt::format("{}: {}", device_json.string(), error.what()));
  }
}

Expected<sdk::DeviceObject> read_device_database(const std::filesystem::path& device_json) {
  return read_device_json(device_json).map([](DeviceDatabase&& database) { return std::move(database.device); });
}

}  // namespace rmac::gateway
