#include "gateway/device_database/device_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "gateway/device_database/device_database.hpp"
#include "gateway/device_database/device_parts.hpp"
#include "places.hpp"
#include "unit/gateway/device_driver_manager/fixtures.hpp"

namespace rmac::gateway {
namespace {

using nlohmann::json;
using test::sound_device;
using test::TemporaryFolder;
using testing::HasSubstr;

/// Every device.json of the tree and of the examples.
std::vector<std::filesystem::path> device_files() {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"drivers", "docs/examples"}) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::filesystem::path(RMAC_SOURCE_DIR) / folder)) {
      if (entry.path().filename() == "device.json") files.push_back(entry.path());
    }
  }
  return files;
}

sdk::DeviceObject read(const std::filesystem::path& file) {
  const auto device = read_device_database(file);
  EXPECT_TRUE(device) << (device ? "" : device.error().message);
  return device.value_or(sdk::DeviceObject{});
}

/// What `file` says, and `written` says otherwise. A file may leave out what is nothing, and write one number as a
/// list.
std::string missing(const json& file, const json& written, const std::string& where = "") {
  if (file.is_object()) {
    for (const auto& [key, value] : file.items()) {
      if (key == "Description" || key == "MechanismID" || key == "$schema") continue;
      const bool nothing = value.empty() || value == 0 || value == "" || value == false;
      if (!written.contains(key)) {
        if (!nothing) return where + "/" + key;
        continue;
      }
      if (auto inside = missing(value, written[key], where + "/" + key); !inside.empty()) return inside;
    }
    return "";
  }
  if (file.is_array() && file.size() == 1 && !written.is_array()) return missing(file[0], written, where + "/0");
  if (!file.is_array()) return file == written ? "" : where;
  if (file.size() != written.size()) return where;
  for (std::size_t i = 0; i < file.size(); ++i) {
    if (auto inside = missing(file[i], written[i], where + "/" + std::to_string(i)); !inside.empty()) return inside;
  }
  return "";
}

TEST(DeviceJson, SaysAllThatTheFileSaid) {
  for (const auto& file : device_files()) {
    const json written = to_device_json(read(file));
    std::ifstream stream(file);
    json said = json::parse(stream);
    // Bodies are no part of the device object.
    for (const char* key : {"Chain", "Geometry"}) said.erase(key);
    EXPECT_EQ(missing(said, written), "") << file;
  }
}

TEST(DeviceJson, ReadsAsTheDeviceThatItWasMadeOf) {
  ASSERT_GT(device_files().size(), 8U);
  const TemporaryFolder folder;
  for (const auto& file : device_files()) {
    const json written = to_device_json(read(file));
    EXPECT_EQ(to_device_json(read(folder.write("device.json", written.dump()))), written) << file;
  }
}

TEST(DeviceJson, LosesNothingOfWhatFewMachinesHave) {
  json file = sound_device();
  file["PathAccelRise"] = 700;
  json& joint = file["Joints"][0];
  joint["LimitType"] = "InfinitePositive";
  joint.erase("Max");
  joint["MaxJump"] = 0.25;
  joint["Gantry"] = {{"MaxSkew", 0.2}, {"Stiffness", 1500}, {"Damping", 12}};
  joint["MaxMeasuredSpeed"] = 900;
  joint["Backlash"] = 0.01;
  joint["LowPass"] = 120;
  joint["PitchErrors"] = {{"First", -5}, {"Step", 2.5}, {"Errors", {0.001, 0, -0.001}}};
  joint["Resonances"] = {{{"Frequency", 80}, {"Damping", 0.1}, {"Width", 0.6}}};
  json& motor = file["Actuators"][1];
  motor["Inputs"] = {{"LimitYNegative", 1}, {"LimitYPositive", 0}};
  motor["MaxMeasuredTorque"] = 7;
  motor["Cogging"] = {{"Lead", 0.0016}, {"Harmonics", {{{"Order", 60}, {"Cosine", 0.001}, {"Sine", -0.006}}}}};
  motor["HomingTurn"] = 2;
  motor["HomeCounts"] = -70000;
  motor["Direction"] = -1;
  const TemporaryFolder folder;
  const json written = to_device_json(read(folder.write("device.json", file.dump())));
  EXPECT_EQ(missing(file, written), "");
  EXPECT_EQ(to_device_json(read(folder.write("device.json", written.dump()))), written);
}

TEST(DeviceParts, AreHeldToTheSchema) {
  EXPECT_THAT(read_actuators(json::parse(R"([{"Bus": "can0", "Axis": 128}])"), {}).error().message,
              HasSubstr("/0/Axis"));
  EXPECT_THAT(read_spindles(json::parse(R"([{"Bus": "can0", "Speed": 1}])"), {}).error().message, HasSubstr("Speed"));
  sdk::ModuleChoice choice;
  ASSERT_TRUE(read_parameters(json::parse(R"({"t1": [10, 1], "t2": 90, "kind": "screw"})"), choice));
  EXPECT_EQ(choice.numbers.at("t1"), (std::vector<double>{10, 1}));
  EXPECT_EQ(choice.numbers.at("t2"), std::vector<double>{90});
  EXPECT_EQ(choice.texts.at("kind"), "screw");
  EXPECT_THAT(read_parameters(json::parse(R"({"t1": {"deep": 1}})"), choice).error().message, HasSubstr("/t1"));
  EXPECT_FALSE(read_parameters(json::parse("[1]"), choice));
}

TEST(DeviceParts, TakeWhatIsLeftOutFromWhatThereIs) {
  sdk::Actuator motor;
  motor.bus = "sim0";
  motor.axis = 3;
  motor.scale = {65536, 2.4, -1, 100};
  motor.homing_turn = 1;
  const auto moved = read_actuators(json::parse(R"([{"Bus": "can0", "Axis": 7}])"), {motor, motor});
  ASSERT_TRUE(moved) << moved.error().message;
  ASSERT_EQ(moved->size(), 1U);
  EXPECT_EQ(moved->front().bus, "can0");
  EXPECT_EQ(moved->front().axis, 7U);
  EXPECT_EQ(moved->front().scale.counts_per_revolution, 65536);
  EXPECT_EQ(moved->front().scale.home_counts, 100);
  EXPECT_EQ(moved->front().homing_turn, 1);
  const auto one_more = read_actuators(json::parse(R"([{}, {"Bus": "can0", "Axis": 7}])"), {motor});
  ASSERT_FALSE(one_more);
  EXPECT_THAT(one_more.error().message, HasSubstr("CountsPerRevolution")) << "of the second nothing is known";
  for (const char* odd : {"{}", "[1]", "3", "[null]", R"(["can0"])"}) {
    EXPECT_FALSE(read_actuators(json::parse(odd), {motor})) << odd;
    EXPECT_FALSE(read_spindles(json::parse(odd), {})) << odd;
  }
}

}  // namespace
}  // namespace rmac::gateway
