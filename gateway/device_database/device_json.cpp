#include "gateway/device_database/device_json.hpp"

#include "gateway/device_database/part_names.hpp"
#include "rmac/motion/limits.hpp"

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;

/// A value that a file leaves out where there is none.
void add_if(Json& object, const char* key, double value) {
  if (value != 0) object[key] = value;
}
template <typename List>
void add_if(Json& object, const char* key, const std::vector<List>& list) {
  if (!list.empty()) object[key] = list;
}

Json choice_json(const sdk::ModuleChoice& choice) {
  Json parameters = Json::object();
  for (const auto& [key, values] : choice.numbers) {
    parameters[key] = values.size() == 1 ? Json(values.front()) : Json(values);
  }
  for (const auto& [key, value] : choice.texts) parameters[key] = value;
  Json object = Json::object();
  if (!choice.name.empty()) object["Module"] = choice.name;
  if (!parameters.empty()) object["Parameters"] = std::move(parameters);
  return object;
}

void add_mechanics(Json& object, const JointMechanics& mechanics) {
  if (const auto& pitch = mechanics.pitch; !pitch.errors.empty()) {
    object["PitchErrors"] = {{"First", pitch.first}, {"Step", pitch.step}, {"Errors", pitch.errors}};
  }
  add_if(object, "Backlash", mechanics.backlash);
  for (const Resonance& resonance : mechanics.resonances) {
    object["Resonances"].push_back(
        {{"Frequency", resonance.frequency_hz}, {"Damping", resonance.damping}, {"Width", resonance.width}});
  }
  add_if(object, "LowPass", mechanics.low_pass_hz);
}

void add_cogging(Json& object, const Cogging& cogging) {
  if (cogging.harmonics.empty()) return;
  Json harmonics = Json::array();
  for (const Cogging::Harmonic& one : cogging.harmonics) {
    harmonics.push_back({{"Order", one.order}, {"Cosine", one.cosine_nm}, {"Sine", one.sine_nm}});
  }
  object["Cogging"] = {{"Lead", cogging.lead_s}, {"Harmonics", std::move(harmonics)}};
}

void add_force(Json& object, const sdk::Joint& joint) {
  if (const auto& sensor = joint.force_sensor) {
    object["ForceSensor"] = {{"Bus", sensor->bus},
                             {"Axis", sensor->axis},
                             {"NewtonPerCount", sensor->newton_per_count},
                             {"ZeroCounts", sensor->zero_counts}};
  }
  if (const auto& force = joint.force) {
    object["ForceControl"] = {{"ApproachSpeed", force->approach_speed},
                              {"ContactForce", force->contact_force},
                              {"MaxSpeed", force->max_speed},
                              {"MaxForce", force->max_force},
                              {"MaxSearch", force->max_search}};
    Json& object_of_force = object["ForceControl"];
    for (const auto& [key, value] : {std::pair{"Gain", force->gain},
                                     {"ResetTime", force->reset_time_s},
                                     {"Mass", force->mass},
                                     {"Stiffness", force->stiffness}}) {
      if (value > 0) object_of_force[key] = value;
    }
  }
}

Json joints_json(const std::vector<sdk::Joint>& joints) {
  Json list = Json::array();
  for (const sdk::Joint& joint : joints) {
    const JointLimits& limits = joint.limits;
    Json entry{{"Name", limits.name},
               {"Type", name_of(limits.type, kJointTypeNames)},
               {"LimitType", name_of(limits.limit_type, kJointLimitTypeNames)},
               {"MaxSpeed", limits.max_speed},
               {"MaxAcceleration", limits.max_acceleration},
               {"MaxJerk", limits.max_jerk},
               {"ControlMethod", name_of(joint.method, kControlMethodNames)},
               {"MaxFollowingError", joint.max_following_error},
               {"MaxEffort", joint.max_effort}};
    if (ends_below(limits)) entry["Min"] = limits.min;
    if (ends_above(limits)) entry["Max"] = limits.max;
    if (!joint.servo_law.name.empty()) entry["ServoControlLaw"] = choice_json(joint.servo_law);
    add_if(entry, "Gains", joint.gains);
    add_if(entry, "MaxMeasuredSpeed", joint.max_measured_speed);
    add_if(entry, "MaxJump", joint.max_jump);
    add_mechanics(entry, joint.mechanics);
    add_force(entry, joint);
    if (joint.gantry) {
      entry["Gantry"] = {{"MaxSkew", joint.gantry->max_skew}};
      add_if(entry["Gantry"], "Stiffness", joint.gantry->stiffness);
      add_if(entry["Gantry"], "Damping", joint.gantry->damping);
    }
    list.push_back(std::move(entry));
  }
  return list;
}

Json tool_change_json(const std::vector<sdk::ToolChangeStep>& steps) {
  using Step = sdk::ToolChangeStep;
  Json list = Json::array();
  for (const Step& step : steps) {
    Json entry{{"Do", name_of(step.kind, kToolChangeNames)}};
    if (step.whose != Step::Whose::Both) entry["For"] = step.whose == Step::Whose::Old ? "Old" : "New";
    add_if(entry, "Joints", step.joints);
    add_if(entry, "Outputs", step.outputs);
    if (!step.input.empty()) entry["Input"] = step.input;
    if (step.kind == Step::Kind::Switch || step.kind == Step::Kind::Await) entry["On"] = step.on;
    if (step.kind == Step::Kind::Await) entry["TimeOut"] = step.timeout_s;
    list.push_back(std::move(entry));
  }
  return list;
}

/// Inputs that drives tell stand with their actuators, the others with the I/O interface.
void add_inputs(Json& file, const sdk::DeviceObject& device) {
  for (const auto& [name, bit] : device.inputs) {
    if (const auto drive = device.drive_inputs.find(bit); drive != device.drive_inputs.end()) {
      file["Actuators"][drive->second.actuator]["Inputs"][name] = drive->second.bit;
    } else {
      file["DigitalIOInterface"]["Inputs"][name] = bit;
    }
  }
  if (!device.outputs.empty()) file["DigitalIOInterface"]["Outputs"] = device.outputs;
}

}  // namespace

Json to_json(const std::vector<sdk::Actuator>& actuators) {
  Json list = Json::array();
  for (const sdk::Actuator& actuator : actuators) {
    Json entry{{"Bus", actuator.bus},
               {"Axis", actuator.axis},
               {"CountsPerRevolution", actuator.scale.counts_per_revolution},
               {"RatedTorque", actuator.scale.rated_torque_nm},
               {"Direction", static_cast<int>(actuator.scale.direction)},
               {"HomeCounts", actuator.scale.home_counts},
               {"HomingTurn", actuator.homing_turn}};
    add_if(entry, "MaxMeasuredTorque", actuator.max_measured_torque_nm);
    add_if(entry, "PositionGain", actuator.position_gain);
    if (actuator.probe_edge) entry["TouchProbe"] = name_of(*actuator.probe_edge, kTouchProbeNumbers);
    add_cogging(entry, actuator.cogging);
    list.push_back(std::move(entry));
  }
  return list;
}

Json to_json(const std::vector<sdk::Spindle>& spindles) {
  Json list = Json::array();
  for (const sdk::Spindle& spindle : spindles) {
    Json entry{{"Bus", spindle.bus},
               {"Axis", spindle.axis},
               {"MaxSpeed", spindle.max_speed_rpm},
               {"MaxTorque", spindle.max_torque_nm},
               {"HorsePower", spindle.horse_power},
               {"SpeedTolerance", spindle.speed_tolerance_rpm},
               {"SpeedTimeout", spindle.speed_timeout_s},
               {"ControlMethod", name_of(spindle.method, kControlMethodNames)},
               {"Direction", static_cast<int>(spindle.scale.direction)},
               {"MaxFollowingError", spindle.max_following_error_deg}};
    if (!spindle.servo_law.name.empty()) entry["ServoControlLaw"] = choice_json(spindle.servo_law);
    add_if(entry, "Gains", spindle.gains);
    add_if(entry, "CountsPerRevolution", spindle.scale.counts_per_revolution);
    add_if(entry, "RatedTorque", spindle.scale.rated_torque_nm);
    add_if(entry, "MaxAcceleration", spindle.max_acceleration_rpm_s);
    list.push_back(std::move(entry));
  }
  return list;
}

Json to_device_json(const sdk::DeviceObject& device) {
  Json file{
      {"MechanismName", device.name},
      {"DeviceDriver", device.device_driver},
      {"DeviceDriverVersion", device.driver_version},
      {"Type", device.type},
      {"ConfigurationType", device.configuration_type},
      {"SpeedCapability", device.speed_capability},
      {"WorkingVolume", {{"Length", device.length_mm}, {"Width", device.width_mm}, {"Depth", device.depth_mm}}},
      {"ToolChanger", device.tool_changer},
      {"ToolChange", tool_change_json(device.tool_change)},
      {"NumberOfTools", device.number_of_tools},
      {"MaxFeedrate", device.max_feedrate_mm_min},
      {"MaxPalletLoad", device.max_pallet_load_kg},
      {"PositioningTolerance", device.positioning_tolerance_mm},
      {"RepeatabilityTolerance", device.repeatability_tolerance_mm},
      {"Joints", joints_json(device.joints)},
      {"HeldJoints", joints_json(device.held_joints)},
      {"Actuators", to_json(device.actuators)},
      {"Spindles", to_json(device.spindles)},
      {"Overlay", device.overlay},
      {"Probing",
       {{"PrehitDistance", device.probing.prehit_distance_mm},
        {"SearchDistance", device.probing.search_distance_mm},
        {"RetractDistance", device.probing.retract_distance_mm},
        {"ScanSpeed", device.probing.scan_speed_mm_s},
        {"SettleTime", device.probing.settle_time_s}}},
      {"Kinematics", choice_json(device.kinematics)},
      {"ActuatorMap", choice_json(device.actuator_map)},
      {"DigitalControlInterface", choice_json(device.digital_control_interface)},
      {"DigitalIOInterface", choice_json(device.digital_io_interface)},
  };
  add_if(file, "PathAccelRise", device.path_accel_rise_mm_s2);
  add_if(file, "PathAccelFall", device.path_accel_fall_mm_s2);
  add_inputs(file, device);
  return file;
}

}  // namespace rmac::gateway
