#include "gateway/device_database/device_database.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "places.hpp"
#include "unit/gateway/device_driver_manager/fixtures.hpp"

namespace rmac::gateway {
namespace {

using nlohmann::json;
using test::sound_device;
using test::TemporaryFolder;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

/// What reading `text` says is wrong, without the path before it.
std::string problem_of(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.write("device.json", text);
  const auto read = read_device_json(file);
  if (read) return "";
  const std::string prefix = file.string() + ": ";
  EXPECT_THAT(read.error().message, StartsWith(prefix)) << "an error names its file";
  return read.error().message.substr(prefix.size());
}

std::string problem_with(const char* pointer, const json& value) {
  json device = sound_device();
  device[json::json_pointer(pointer)] = value;
  return problem_of(device.dump());
}

std::string problem_without(const char* object, const char* key) {
  json device = sound_device();
  device[json::json_pointer(object)].erase(key);
  return problem_of(device.dump());
}

sdk::DeviceObject read_sound(const json& device) {
  const TemporaryFolder folder;
  const auto read = read_device_database(folder.write("device.json", device.dump()));
  EXPECT_TRUE(read) << (read ? "" : read.error().message);
  return read ? *read : sdk::DeviceObject{};
}

TEST(DeviceDatabase, GivesEveryValueOfTheFile) {
  json file = sound_device();
  file["HeldJoints"].push_back(file["Joints"][2]);
  file["HeldJoints"][0]["Name"] = "Held";
  file["Actuators"].push_back(file["Actuators"][2]);
  file["Actuators"][3]["Axis"] = 9;
  file["PathAccelRise"] = 700;
  file["PathAccelFall"] = 800;
  const sdk::DeviceObject device = read_sound(file);

  EXPECT_EQ(device.name, "TestXYZ");
  EXPECT_EQ(device.device_driver, "TestXYZ");
  EXPECT_EQ(device.driver_version, "1.2.3");
  EXPECT_EQ(device.type, "Mill");
  EXPECT_EQ(device.configuration_type, "3-axis");
  EXPECT_EQ(device.speed_capability, "fast");
  EXPECT_TRUE(device.tool_changer);
  EXPECT_EQ(device.number_of_tools, 12);
  EXPECT_EQ(device.length_mm, 100);
  EXPECT_EQ(device.width_mm, 90);
  EXPECT_EQ(device.depth_mm, 80);
  EXPECT_EQ(device.max_feedrate_mm_min, 2000);
  EXPECT_EQ(device.max_pallet_load_kg, 100);
  EXPECT_EQ(device.positioning_tolerance_mm, 0.05);
  EXPECT_EQ(device.repeatability_tolerance_mm, 0.025);
  EXPECT_EQ(device.path_accel_rise_mm_s2, 700);
  EXPECT_EQ(device.path_accel_fall_mm_s2, 800);
  EXPECT_EQ(device.kinematics.name, "TestKinematics");
  EXPECT_EQ(device.kinematics.numbers.at("offset_mm"), std::vector<double>{4.5});
  EXPECT_EQ(device.kinematics.texts.at("variant"), "left");
  EXPECT_EQ(device.actuator_map.numbers.at("pitch_mm"), (std::vector<double>{5, 5, 4}));
  EXPECT_EQ(device.digital_control_interface.name, "SimulatedInterface");
  EXPECT_EQ(device.digital_io_interface.name, "SimulatedIOInterface");
  EXPECT_EQ(device.inputs.at("Probe"), 3);
  EXPECT_EQ(device.outputs.at("Coolant"), 0);

  ASSERT_EQ(device.joints.size(), 3U);
  ASSERT_EQ(device.held_joints.size(), 1U);
  EXPECT_EQ(device.held_joints[0].limits.name, "Held");
  const sdk::Joint& joint = device.joints[1];
  EXPECT_EQ(joint.limits.name, "J1");
  EXPECT_EQ(joint.limits.type, JointType::Linear);
  EXPECT_EQ(joint.limits.limit_type, JointLimitType::Limited);
  EXPECT_EQ(joint.limits.min, -50);
  EXPECT_EQ(joint.limits.max, 60);
  EXPECT_EQ(joint.limits.max_speed, 200);
  EXPECT_EQ(joint.limits.max_acceleration, 1000);
  EXPECT_EQ(joint.limits.max_jerk, 10000);
  EXPECT_EQ(joint.method, ControlMethod::Position);
  EXPECT_EQ(joint.servo_law.name, "TestLaw");
  EXPECT_EQ(joint.gains, (std::vector<double>{1, 2.5, 3}));
  EXPECT_EQ(joint.max_following_error, 1);
  EXPECT_EQ(joint.max_effort, 800);

  ASSERT_EQ(device.actuators.size(), 4U);
  EXPECT_EQ(device.actuators[3].bus, "sim0");
  EXPECT_EQ(device.actuators[3].axis, 9U);
  EXPECT_EQ(device.actuators[3].scale.counts_per_revolution, 131072);
  EXPECT_EQ(device.actuators[3].scale.rated_torque_nm, 0.32);
  EXPECT_EQ(device.actuators[3].scale.direction, -1);
  EXPECT_EQ(device.actuators[3].scale.home_counts, -7);
  ASSERT_EQ(device.spindles.size(), 1U);
  EXPECT_EQ(device.spindles[0].axis, 30U);
  EXPECT_EQ(device.spindles[0].max_speed_rpm, 1000);
  EXPECT_EQ(device.spindles[0].max_torque_nm, 5);
  EXPECT_EQ(device.spindles[0].horse_power, 2.5);
  EXPECT_EQ(device.spindles[0].speed_tolerance_rpm, 15);
  EXPECT_EQ(device.spindles[0].speed_timeout_s, 4);
}

TEST(DeviceDatabase, GivesWhatTheMechanicsOfAJointDoWrong) {
  json file = sound_device();
  EXPECT_TRUE(read_sound(file).joints[0].mechanics.pitch.errors.empty());
  file["Joints"][1].update({{"PitchErrors", {{"First", -50}, {"Step", 25}, {"Errors", {0.01, 0, -0.02}}}},
                            {"Backlash", 0.015},
                            {"Resonances", {{{"Frequency", 180}, {"Damping", 0.02}}}},
                            {"LowPass", 350}});
  const JointMechanics mechanics = read_sound(file).joints[1].mechanics;
  EXPECT_EQ(mechanics.pitch.first, -50);
  EXPECT_EQ(mechanics.pitch.step, 25);
  EXPECT_EQ(mechanics.pitch.errors, (std::vector<double>{0.01, 0, -0.02}));
  EXPECT_EQ(mechanics.backlash, 0.015);
  ASSERT_EQ(mechanics.resonances.size(), 1U);
  EXPECT_EQ(mechanics.resonances[0].frequency_hz, 180);
  EXPECT_EQ(mechanics.resonances[0].damping, 0.02);
  EXPECT_EQ(mechanics.resonances[0].width, 0.5);
  EXPECT_EQ(mechanics.low_pass_hz, 350);
  EXPECT_EQ(problem_with("/Joints/0/Backlash", -1),
            "/Joints/0/Backlash is -1; allowed is a number from 0 to 10 (mm or deg)");
}

TEST(DeviceDatabase, PutsTheInputsOfDrivesBesideThoseOfTheIoInterface) {
  json file = sound_device();
  file["DigitalIOInterface"]["Inputs"] = {{"Probe", 3}, {"Door", 62}};
  file["Actuators"][0].update({{"Inputs", {{"LimitJ0Negative", 0}, {"LimitJ0Positive", 1}}}, {"TouchProbe", -2}});
  file["Actuators"][2]["Inputs"] = {{"Home", 2}};
  const sdk::DeviceObject device = read_sound(file);
  ASSERT_EQ(device.inputs.size(), 5U);
  ASSERT_EQ(device.drive_inputs.size(), 3U);
  const auto told = [&](const char* name) { return device.drive_inputs.at(device.inputs.at(name)); };
  EXPECT_EQ(told("LimitJ0Negative").actuator, 0U);
  EXPECT_EQ(told("LimitJ0Negative").bit, 0);
  EXPECT_EQ(told("LimitJ0Positive").bit, 1);
  EXPECT_EQ(told("Home").actuator, 2U);
  EXPECT_EQ(device.inputs.at("Door"), 62) << "bits that have a name keep it";
  EXPECT_EQ(device.actuators[0].probe_edge, TouchProbeEdge::SecondFalling);
  EXPECT_FALSE(device.actuators[1].probe_edge);

  EXPECT_EQ(problem_with("/Actuators/0/Inputs", {{"Probe", 4}}),
            "/Actuators/0/Inputs/Probe has the name of another input; allowed is a name of its own");
  EXPECT_EQ(problem_with("/Actuators/0/TouchProbe", 3), "/Actuators/0/TouchProbe is 3; allowed is one of 1, -1, 2, -2");
  EXPECT_EQ(problem_with("/Actuators/0/Inputs", {{"Home", 32}}),
            "/Actuators/0/Inputs/Home is 32; allowed is an integer from 0 to 31");
}

TEST(DeviceDatabase, RefusesALatchWithoutAProbe) {
  json file = sound_device();
  file["DigitalIOInterface"].erase("Inputs");
  file["Actuators"][1]["TouchProbe"] = 1;
  const TemporaryFolder folder;
  const auto refused = read_device_json(folder.write("device.json", file.dump()));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("/Actuators/1/TouchProbe is given, and no input is named Probe"),
            std::string::npos)
      << refused.error().message;
}

TEST(DeviceDatabase, RefusesParametersOfABusThatIsNotThere) {
  json file = sound_device();
  file["DigitalControlInterface"]["Parameters"] = {{"axes", 40}, {"sim0.model.axes", 40}};
  EXPECT_EQ(read_sound(file).digital_control_interface.numbers.size(), 2U);
  EXPECT_EQ(
      problem_with("/DigitalControlInterface/Parameters", {{"sim1.axes", 3}}),
      "/DigitalControlInterface/Parameters has \"sim1.axes\"; allowed before the point is a bus on which something "
      "of this machine hangs: sim0");
}

TEST(DeviceDatabase, TakesTheSchemasDefaultsForWhatIsLeftOut) {
  json file = sound_device();
  for (const char* key : {"SpeedCapability", "ToolChanger", "NumberOfTools", "HeldJoints"}) file.erase(key);
  for (const char* key : {"Direction", "HomeCounts"}) file["Actuators"][0].erase(key);
  for (const char* key : {"SpeedTolerance", "SpeedTimeout"}) file["Spindles"][0].erase(key);
  for (const char* key : {"Inputs", "Outputs"}) file["DigitalIOInterface"].erase(key);
  const sdk::DeviceObject device = read_sound(file);

  std::ifstream stream(RMAC_SOURCE_DIR "/etc/device.schema.json");
  const json schema = json::parse(stream);
  const auto by_default = [&](const char* pointer) { return schema[json::json_pointer(pointer)]["default"]; };
  EXPECT_EQ(device.speed_capability, by_default("/properties/SpeedCapability"));
  EXPECT_EQ(device.tool_changer, by_default("/properties/ToolChanger"));
  EXPECT_EQ(device.number_of_tools, by_default("/properties/NumberOfTools"));
  EXPECT_EQ(device.path_accel_rise_mm_s2, 0) << "the joints alone bound it";
  EXPECT_EQ(device.path_accel_fall_mm_s2, 0);
  EXPECT_EQ(device.actuators[0].scale.direction, by_default("/definitions/actuator/properties/Direction"));
  EXPECT_EQ(device.actuators[0].scale.home_counts, by_default("/definitions/actuator/properties/HomeCounts"));
  EXPECT_EQ(device.spindles[0].speed_tolerance_rpm, by_default("/definitions/spindle/properties/SpeedTolerance"));
  EXPECT_EQ(device.spindles[0].speed_timeout_s, by_default("/definitions/spindle/properties/SpeedTimeout"));
  EXPECT_TRUE(device.held_joints.empty());
  EXPECT_TRUE(device.inputs.empty());
  EXPECT_TRUE(device.outputs.empty());
}

TEST(DeviceDatabase, ReadsTheSameFromAnyWorkingFolder) {
  const TemporaryFolder folder;
  const auto file = folder.write("device.json", sound_device().dump());
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path("/");
  EXPECT_TRUE(read_device_json(file));
  std::filesystem::current_path(before);
}

TEST(DeviceDatabase, SyntaxErrorNamesLineAndColumn) {
  EXPECT_THAT(problem_of("{\n  \"MechanismName\": \"A\",\n  \"Joints\": [1 2]\n}"),
              StartsWith("line 3, column 16 is not JSON: "));
  EXPECT_THAT(problem_of(""), StartsWith("line 1, column 1 is not JSON: "));
  EXPECT_THAT(problem_of("{\"MaxFeedrate\": NaN}"), StartsWith("line 1, column 17 is not JSON: "));
  EXPECT_THAT(problem_of("{\n\"MaxFeedrate\": 1e999}"), StartsWith("line 2, column 20 is not JSON: number overflow"));
  EXPECT_THAT(problem_of(std::string("{\"A\": \"\xff\"}")), StartsWith("line 1, column 8 is not JSON: "));
}

TEST(DeviceDatabase, RefusesWhatJsonParsersLetPass) {
  EXPECT_EQ(problem_of("{\"Type\": \"Mill\", \"Type\": \"CMM\"}"),
            "the key \"Type\" stands twice in the document; keep one");
  EXPECT_THAT(problem_of(std::string(100, '[')), HasSubstr("nests deeper than 32 levels"));
  EXPECT_THAT(problem_with("/SpeedCapability", std::string(5000, 'a')), HasSubstr("is a text of 5000 bytes"));
  EXPECT_THAT(problem_of(std::string(2 << 20, ' ')), HasSubstr("at most 1048576 are read"));
}

TEST(DeviceDatabase, MissingFileAndFolderAreErrors) {
  const TemporaryFolder folder;
  EXPECT_THAT(read_device_json(folder.path() / "none.json").error().message,
              EndsWith("none.json: there is no such file"));
  EXPECT_FALSE(read_device_json(folder.path()));
}

TEST(DeviceDatabase, WrongValueNamesKeyValueAndAllowedRange) {
  EXPECT_EQ(problem_with("/Joints/1/MaxSpeed", -200),
            "/Joints/1/MaxSpeed is -200; allowed is a number from 0.001 to 1000000 (mm/s or deg/s)");
  EXPECT_EQ(problem_with("/Actuators/2/Axis", 128), "/Actuators/2/Axis is 128; allowed is an integer from 0 to 127");
  EXPECT_EQ(problem_with("/Joints/0/Type", "Circular"),
            "/Joints/0/Type is \"Circular\"; allowed is one of \"Linear\", \"Rotary\", \"Screw\"");
  EXPECT_EQ(problem_with("/ToolChanger", 1), "/ToolChanger is 1; allowed is true or false");
  EXPECT_EQ(problem_with("/MaxFeedrate", "2000"),
            "/MaxFeedrate is \"2000\"; allowed is a number from 0.01 to 1000000 (mm/min)");
  EXPECT_EQ(problem_with("/DeviceDriverVersion", "1.2"),
            "/DeviceDriverVersion is \"1.2\"; allowed is a text (three numbers of at most two digits, as in 1.2.3)");
  EXPECT_EQ(problem_with("/Kinematics/Module", "../../etc/passwd"),
            "/Kinematics/Module is \"../../etc/passwd\"; allowed is a text of at most 100 characters (a letter, then "
            "letters, digits and _)");
  EXPECT_EQ(problem_with("/Joints", json::array()),
            "/Joints is an array of 0 entries; allowed is an array of 1 to 32 entries");
  EXPECT_EQ(problem_with("/ActuatorMap/Parameters/pitch_mm/1", "5"),
            "/ActuatorMap/Parameters/pitch_mm/1 is \"5\"; allowed is a number");
  EXPECT_EQ(problem_with("/DigitalIOInterface/Outputs/Coolant", 64),
            "/DigitalIOInterface/Outputs/Coolant is 64; allowed is an integer from 0 to 63");
  EXPECT_EQ(problem_of("[]"), "the document is an array of 0 entries; allowed is an object");
}

TEST(DeviceDatabase, MissingKeyIsNamedWithWhatItWants) {
  EXPECT_EQ(problem_without("/Joints/2", "MaxJerk"),
            "/Joints/2 lacks the key \"MaxJerk\", a number from 1 to 10000000000 (mm/s³ or deg/s³)");
  EXPECT_EQ(problem_without("", "Kinematics"), "the document lacks the key \"Kinematics\", an object");
}

TEST(DeviceDatabase, UnknownKeyIsAnErrorThatGuessesTheRightOne) {
  EXPECT_THAT(problem_with("/Joints/0/MaxSped", 3),
              StartsWith("/Joints/0 has the unknown key \"MaxSped\"; did you mean \"MaxSpeed\"? allowed are "));
  EXPECT_THAT(problem_with("/Zebra", 3), StartsWith("the document has the unknown key \"Zebra\"; allowed are "));
}

TEST(DeviceDatabase, TellsSeveralMistakesAtOnce) {
  json device = sound_device();
  device["MaxFeedrate"] = -1;
  device["Spindles"][0]["Axis"] = -1;
  const std::string problem = problem_of(device.dump());
  EXPECT_THAT(problem, HasSubstr("/MaxFeedrate is -1"));
  EXPECT_THAT(problem, HasSubstr("/Spindles/0/Axis is -1"));
}

TEST(DeviceDatabase, ChecksThatTheTravelIsOne) {
  EXPECT_EQ(problem_with("/Joints/1/Min", 60), "/Joints/1/Min is 60; allowed is a number below 60, the joint's Max");
  EXPECT_EQ(problem_with("/Joints/1/Min", 70), "/Joints/1/Min is 70; allowed is a number below 60, the joint's Max");
  EXPECT_EQ(problem_without("/Joints/1", "Max"),
            "/Joints/1 lacks the key \"Max\", a number (mm or deg), which LimitType \"Limited\" needs");
}

TEST(DeviceDatabase, AnInfiniteJointNeedsNoEndOfTravel) {
  json device = sound_device();
  device["Joints"][0]["LimitType"] = "Infinite";
  device["Joints"][0].erase("Min");
  device["Joints"][0].erase("Max");
  device["Joints"][1]["LimitType"] = "InfinitePositive";
  device["Joints"][1].erase("Max");
  EXPECT_EQ(problem_of(device.dump()), "");
  device["Joints"][1]["LimitType"] = "InfiniteNegative";
  EXPECT_THAT(problem_of(device.dump()), StartsWith("/Joints/1 lacks the key \"Max\""));
}

TEST(DeviceDatabase, ChecksThatEveryJointHasAMotorOfItsOwn) {
  json device = sound_device();
  device["Actuators"].erase(2);
  EXPECT_EQ(problem_of(device.dump()),
            "/Actuators has 2 entries; allowed are at least 3, one for each of 3 Joints and 0 HeldJoints");
  EXPECT_EQ(problem_with("/Actuators/2/Axis", 1),
            "/Actuators/2/Axis is 1 on bus \"sim0\", which /Actuators/1 has already; allowed is an axis of its own");
  EXPECT_EQ(problem_with("/Spindles/0/Axis", 0),
            "/Spindles/0/Axis is 0 on bus \"sim0\", which /Actuators/0 has already; allowed is an axis of its own");
}

TEST(DeviceDatabase, ChecksThatNamesAndBitsAreUnique) {
  EXPECT_EQ(problem_with("/Joints/2/Name", "J0"),
            "/Joints/2/Name is \"J0\", which /Joints/0 has already; allowed is a name of its own");
  EXPECT_EQ(problem_with("/DigitalIOInterface/Outputs/Light", 0),
            "/DigitalIOInterface/Outputs/Light is bit 0, which \"Coolant\" has already; allowed is a bit of its own");
}

TEST(DeviceDatabase, ASpindleThatTurnsNeedsATolerance) {
  EXPECT_THAT(problem_with("/Spindles/0/SpeedTolerance", 0),
              StartsWith("/Spindles/0/SpeedTolerance is 0; allowed is "));
}

}  // namespace
}  // namespace rmac::gateway
