#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "places.hpp"

namespace rmac::test {

inline const std::filesystem::path kSearcher = std::filesystem::path(RMAC_BINARY_DIR) / "bin/rmac-search";

/// A folder of its own for one test, gone with it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "rmac-test-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::filesystem::path& name, const std::string& text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// A sound device.json with `joints` linear joints; tests break one thing in it.
inline nlohmann::json sound_device(const std::string& name = "TestXYZ", int joints = 3) {
  nlohmann::json device = {
      {"MechanismName", name},
      {"DeviceDriver", name},
      {"DeviceDriverVersion", "1.2.3"},
      {"Type", "Mill"},
      {"ConfigurationType", "3-axis"},
      {"SpeedCapability", "fast"},
      {"WorkingVolume", {{"Length", 100}, {"Width", 90}, {"Depth", 80}}},
      {"ToolChanger", true},
      {"NumberOfTools", 12},
      {"MaxFeedrate", 2000},
      {"MaxPalletLoad", 100},
      {"PositioningTolerance", 0.05},
      {"RepeatabilityTolerance", 0.025},
      {"Kinematics", {{"Module", "TestKinematics"}, {"Parameters", {{"offset_mm", 4.5}, {"variant", "left"}}}}},
      {"ActuatorMap", {{"Module", "TestMap"}, {"Parameters", {{"pitch_mm", {5, 5, 4}}}}}},
      {"Joints", nlohmann::json::array()},
      {"HeldJoints", nlohmann::json::array()},
      {"Actuators", nlohmann::json::array()},
      {"Spindles",
       {{{"Bus", "sim0"},
         {"Axis", 30},
         {"MaxSpeed", 1000},
         {"MaxTorque", 5},
         {"HorsePower", 2.5},
         {"SpeedTolerance", 15},
         {"SpeedTimeout", 4}}}},
      {"DigitalControlInterface", {{"Module", "SimulatedInterface"}, {"Parameters", nlohmann::json::object()}}},
      {"DigitalIOInterface",
       {{"Module", "SimulatedIOInterface"}, {"Inputs", {{"Probe", 3}}}, {"Outputs", {{"Coolant", 0}}}}}};
  for (int i = 0; i < joints; ++i) {
    device["Joints"].push_back({{"Name", "J" + std::to_string(i)},
                                {"Type", "Linear"},
                                {"LimitType", "Limited"},
                                {"Min", -50},
                                {"Max", 60},
                                {"MaxSpeed", 200},
                                {"MaxAcceleration", 1000},
                                {"MaxJerk", 10000},
                                {"ControlMethod", "Position"},
                                {"ServoControlLaw", {{"Module", "TestLaw"}}},
                                {"Gains", {1, 2.5, 3}},
                                {"MaxFollowingError", 1},
                                {"MaxEffort", 800}});
    device["Actuators"].push_back({{"Bus", "sim0"},
                                   {"Axis", i},
                                   {"CountsPerRevolution", 131072},
                                   {"RatedTorque", 0.32},
                                   {"Direction", -1},
                                   {"HomeCounts", -7}});
  }
  return device;
}

/// Table 4-1's six mechanisms in the units of the contract, as far as a search sees them.
inline std::vector<nlohmann::json> table_4_1() {
  struct Row {
    const char* name;
    const char* type;
    const char* configuration;
    int joints;
    double side_mm, depth_mm, horse_power, rpm, torque_nm, feed_mm_min, load_kg, positioning_mm;
  };
  const std::vector<Row> rows = {{"DMACXYZ", "Mill", "3-axis", 3, 100, 100, 2.5, 1000, 5, 2000, 100, 0.05},
                                 {"TarusXYZCA", "Mill", "5-axis", 5, 800, 800, 10, 5000, 50, 20000, 1000, 0.005},
                                 {"SuginoXYZ", "Mill", "3-axis", 3, 100, 100, 5, 3000, 10, 5000, 500, 0.01},
                                 {"SuginoXYZAC", "Mill", "5-axis", 5, 100, 100, 5, 4000, 10, 10000, 500, 0.01},
                                 {"CMM", "CMM", "3-axis", 3, 100, 100, 5, 0, 10, 2000, 500, 0.005},
                                 {"DMACXY", "Mill", "2-axis", 2, 100, 0, 2.5, 1000, 5, 2000, 100, 0.05}};
  std::vector<nlohmann::json> devices;
  for (const Row& row : rows) {
    nlohmann::json device = sound_device(row.name, row.joints);
    device["Type"] = row.type;
    device["ConfigurationType"] = row.configuration;
    device["MechanismID"] = devices.size() + 1;
    device["WorkingVolume"] = {{"Length", row.side_mm}, {"Width", row.side_mm}, {"Depth", row.depth_mm}};
    device["Spindles"][0]["HorsePower"] = row.horse_power;
    device["Spindles"][0]["MaxSpeed"] = row.rpm;
    device["Spindles"][0]["MaxTorque"] = row.torque_nm;
    device["MaxFeedrate"] = row.feed_mm_min;
    device["MaxPalletLoad"] = row.load_kg;
    device["PositioningTolerance"] = row.positioning_mm;
    device["RepeatabilityTolerance"] = row.positioning_mm / 2;
    devices.push_back(device);
  }
  return devices;
}

/// Where a device.json belongs in a device tree.
inline std::filesystem::path place_of(const nlohmann::json& device) {
  std::string type = device["Type"].get<std::string>();
  for (char& letter : type) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return std::filesystem::path(type) / device["ConfigurationType"].get<std::string>() /
         device["MechanismName"].get<std::string>() / "device.json";
}

inline void write_tree(const TemporaryFolder& folder, const std::vector<nlohmann::json>& devices) {
  std::filesystem::create_directories(folder.path() / "tree");
  for (const nlohmann::json& device : devices) folder.write("tree" / place_of(device), device.dump(2));
}

}  // namespace rmac::test
