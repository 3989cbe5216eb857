#include "gateway/device_database/device_database.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "gateway/bodies/body_json.hpp"
#include "gateway/device_database/device_checks.hpp"
#include "gateway/device_database/device_parts.hpp"
#include "gateway/device_database/json_values.hpp"
#include "gateway/device_database/part_names.hpp"
#include "gateway/json/json_document.hpp"
#include "gateway/json/schemas.hpp"

namespace rmac::gateway {
namespace {

// The functions below read a document that the schema has passed: what it requires is there and has its type.
using Json = nlohmann::json;

std::vector<sdk::ToolChangeStep> tool_change_steps(const Json& list) {
  using Step = sdk::ToolChangeStep;
  constexpr double kTimeOutS = 10;
  std::vector<Step> result;
  for (const Json& entry : list) {
    const std::string whose = entry.value("For", "");
    Step step;
    step.kind = named(std::string_view(entry.at("Do").get_ref<const std::string&>()), kToolChangeNames);
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
  device.tool_change = tool_change_steps(file.value("ToolChange", Json::array()));
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
    DeviceDatabase database{.device = device_object(*document), .mechanism_id = {}, .bodies = {}};
    if (document->contains("MechanismID")) database.mechanism_id = (*document)["MechanismID"].get<std::int64_t>();

    std::string problem = missing_end(*document, database.device);
    if (problem.empty()) problem = add_drive_inputs((*document)["Actuators"], database.device);
    if (problem.empty()) problem = check_sense(database.device);
    if (!problem.empty()) {
      return failure(MinorCode::InvalidParameterValue, fmt::format("{}: {}", device_json.string(), problem));
    }
    std::vector<std::string> names;
    for (const sdk::Joint& joint : database.device.joints) names.push_back(joint.limits.name);
    auto bodies = read_machine_bodies(*document, names, device_json.parent_path());
    if (!bodies) {
      return failure(bodies.error().code, fmt::format("{}: {}", device_json.string(), bodies.error().message));
    }
    database.bodies = std::move(*bodies);
    return database;
  } catch (const std::exception& error) {
    return failure(MinorCode::Other, fmt::format("{}: {}", device_json.string(), error.what()));
  }
}

Expected<sdk::DeviceObject> read_device_database(const std::filesystem::path& device_json) {
  return read_device_json(device_json).map([](DeviceDatabase&& database) { return std::move(database.device); });
}

}  // namespace rmac::gateway
