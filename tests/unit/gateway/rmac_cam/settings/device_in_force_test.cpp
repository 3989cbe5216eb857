#include "gateway/rmac_cam/settings/device_in_force.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

sdk::DeviceObject device_of(std::size_t joints, std::size_t spindles) {
  sdk::DeviceObject device;
  device.joints.resize(joints);
  device.held_joints.resize(1);
  device.spindles.resize(spindles);
  return device;
}

TEST(DeviceInForce, SaysWhatToDoWhereThereIsNone) {
  const DeviceInForce none;
  for (const auto& refused : {none.require("F"), none.find_joint(0, "F").map([](std::size_t) {}),
                              none.find_spindle(0, "F").map([](std::size_t) {})}) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, MinorCode::Other);
    EXPECT_EQ(refused.error().message, "F: no mechanism is loaded; load one with Device.Load");
  }
  EXPECT_TRUE(none.get_or_empty().joints.empty());
  EXPECT_EQ(none.coolant(), 0U);
}

TEST(DeviceInForce, FindsJointsThatAreMovedAndNoOthers) {
  const sdk::DeviceObject two = device_of(2, 0);
  DeviceInForce device;
  device.change(&two);
  EXPECT_EQ(device.find_joint(0, "F").value(), 0U);
  EXPECT_EQ(device.find_joint(1, "F").value(), 1U);
  EXPECT_EQ(device.find_joint(2, "F").error().message, "F: there is no joint 2; joints are 0 to 1") << "held";
  EXPECT_EQ(device.find_joint(-1, "F").error().code, MinorCode::InvalidParameterValue);
}

TEST(DeviceInForce, FindsSpindlesOrSaysThatThereAreNone) {
  const sdk::DeviceObject two = device_of(1, 2), none = device_of(1, 0);
  DeviceInForce device;
  device.change(&two);
  EXPECT_EQ(device.find_spindle(1, "F").value(), 1U);
  EXPECT_EQ(device.find_spindle(2, "F").error().message, "F: there is no spindle 2; spindles are 0 to 1");
  EXPECT_EQ(device.find_spindle(-1, "F").error().code, MinorCode::InvalidParameterValue);
  device.change(&none);
  EXPECT_EQ(device.find_spindle(0, "F").error().message, "F: the mechanism has no spindle");
}

TEST(DeviceInForce, TellsTheBitOfTheCoolant) {
  sdk::DeviceObject mill = device_of(1, 0);
  DeviceInForce device;
  device.change(&mill);
  EXPECT_EQ(device.coolant(), 0U);
  mill.outputs = {{"Air", 2}, {"Coolant", 5}};
  EXPECT_EQ(device.coolant(), std::uint64_t{1} << 5);
}

}  // namespace
}  // namespace rmac::gateway
