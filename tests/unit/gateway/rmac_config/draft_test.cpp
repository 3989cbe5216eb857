#include "gateway/rmac_config/draft.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using Extent = Draft::Extent;

sdk::DeviceObject described() {
  sdk::DeviceObject device;
  device.name = "Mill";
  for (const char* name : {"X", "Y"}) {
    device.joints.push_back(
        {.limits = {.name = name}, .max_measured_speed = 250, .max_jump = 0.5, .gantry = Gantry{.max_skew = 0.2}});
  }
  device.held_joints = {{.limits = {.name = "Z"}, .max_jump = 0.7}};
  device.spindles.resize(1);
  device.kinematics.name = "K";
  device.actuator_map.name = "M";
  device.digital_control_interface.name = "C";
  device.digital_io_interface.name = "I";
  return device;
}

TEST(Draft, BeginsWithNothingThatASetterSets) {
  Draft draft;
  draft.begin(described());
  EXPECT_TRUE(draft.begun);
  EXPECT_EQ(draft.extent, Extent::Mechanism);
  EXPECT_EQ(draft.device.name, "Mill");
  EXPECT_EQ(draft.device.spindles.size(), 1U);
  EXPECT_TRUE(draft.device.joints.empty());
  EXPECT_EQ(draft.device.held_joints.at(0).limits.name, "");
  for (const auto* module : {&draft.device.kinematics, &draft.device.actuator_map,
                             &draft.device.digital_control_interface, &draft.device.digital_io_interface}) {
    EXPECT_EQ(module->name, "");
  }
}

TEST(Draft, KeepsOfJointsWhatNoSetterSets) {
  Draft draft;
  draft.begin(described());
  ASSERT_EQ(draft.described.size(), 2U);
  EXPECT_EQ(draft.described[1].max_measured_speed, 250);
  EXPECT_EQ(draft.described[1].max_jump, 0.5);
  ASSERT_TRUE(draft.described[1].gantry);
  EXPECT_EQ(draft.described[1].gantry->max_skew, 0.2);
  EXPECT_EQ(draft.described[1].limits.name, "");
  EXPECT_EQ(draft.device.held_joints.at(0).max_jump, 0.7);
}

TEST(Draft, GoesOnFromWhatIsInForce) {
  const sdk::DeviceObject in_force = described();
  Draft draft;
  draft.restart(&in_force);
  EXPECT_TRUE(draft.begun);
  EXPECT_EQ(draft.extent, Extent::Loops);
  EXPECT_EQ(draft.device.joints.size(), 2U);
  draft.restart(nullptr);
  EXPECT_FALSE(draft.begun);
  EXPECT_EQ(draft.device.name, "");
}

TEST(Draft, CountsHeldJointsBehindThoseThatAreMoved) {
  const sdk::DeviceObject in_force = described();
  Draft draft;
  draft.restart(&in_force);
  EXPECT_EQ(draft.joint(1, "F").value(), &draft.device.joints[1]);
  EXPECT_EQ(draft.joint(2, "F").value(), &draft.device.held_joints[0]);
  EXPECT_EQ(draft.joint(3, "F").error().message, "F: there is no joint 3; joints are 0 to 2");
  EXPECT_EQ(draft.joint(-1, "F").error().code, MinorCode::InvalidParameterValue);
  EXPECT_EQ(draft.extent, Extent::Loops) << "looking changes nothing";
  draft.restart(nullptr);
  EXPECT_EQ(draft.joint(0, "F").error().message, "F: there is no joint 0; set the number of joints first");
}

TEST(Draft, IsMoreThanOneOfLoopsOnceItIsEdited) {
  const sdk::DeviceObject in_force = described();
  Draft draft;
  draft.restart(&in_force);
  EXPECT_FALSE(draft.edit_joint(3, "F"));
  EXPECT_FALSE(draft.edit_spindle(1, "F"));
  EXPECT_EQ(draft.extent, Extent::Loops);
  EXPECT_EQ(draft.edit_joint(2, "F").value(), &draft.device.held_joints[0]);
  EXPECT_EQ(draft.extent, Extent::Configuration);
  draft.begin(in_force);
  EXPECT_TRUE(draft.edit_spindle(0, "F"));
  EXPECT_EQ(draft.extent, Extent::Mechanism);
}

TEST(Draft, NamesTheSpindlesThatThereAre) {
  sdk::DeviceObject in_force = described();
  Draft draft;
  draft.restart(&in_force);
  EXPECT_EQ(draft.edit_spindle(1, "F").error().message, "F: there is no spindle 1; spindles are 0 to 0");
  in_force.spindles.clear();
  draft.restart(&in_force);
  EXPECT_EQ(draft.edit_spindle(0, "F").error().message, "F: the mechanism has no spindle");
}

TEST(Draft, TakesModulesThatHaveANameAndGainsThatAreNumbers) {
  sdk::ModuleChoice target{"Old", {}, {}};
  EXPECT_EQ(choose_module("F", {}, target).error().message, "F: the name of a module is needed");
  EXPECT_EQ(target.name, "Old");
  ASSERT_TRUE(choose_module("F", {"New", {{"a", {1}}}, {}}, target));
  EXPECT_EQ(target.numbers.at("a").at(0), 1);
  EXPECT_TRUE(check_gains("F", std::vector<double>{1, 0, 2}));
  EXPECT_FALSE(check_gains("F", std::vector<double>{1, std::numeric_limits<double>::infinity()}));
}

}  // namespace
}  // namespace rmac::gateway
