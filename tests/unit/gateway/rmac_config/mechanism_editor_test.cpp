#include "gateway/rmac_config/mechanism_editor.hpp"

#include <gmock/gmock.h>

#include "rmac/motion/machine_size.hpp"

namespace rmac::gateway {
namespace {

class Mechanism : public testing::Test {
 protected:
  Mechanism() {
    sdk::DeviceObject device;
    device.joints = {{.max_jump = 0.1}, {.max_jump = 0.2}};
    device.held_joints.resize(1);
    device.spindles = {{.horse_power = 7}};
    draft_.begin(device);
  }
  Draft draft_;
  MechanismEditor editor_{draft_};
};

TEST_F(Mechanism, HasSoManyJointsAsDeviceJsonDescribesThem) {
  ASSERT_TRUE(editor_.set_number_of_joints(3));
  ASSERT_EQ(draft_.device.joints.size(), 3U);
  EXPECT_EQ(draft_.device.joints[1].max_jump, 0.2);
  EXPECT_EQ(draft_.device.joints[2].max_jump, 0) << "it describes two";
  draft_.device.joints[0].limits.name = "X";
  ASSERT_TRUE(editor_.set_number_of_joints(1));
  ASSERT_TRUE(editor_.set_number_of_joints(2));
  EXPECT_EQ(draft_.device.joints[0].limits.name, "X") << "those that stay keep what was set";
  EXPECT_EQ(draft_.device.joints[1].max_jump, 0.2);
}

TEST_F(Mechanism, HasAtMostSoManyJointsAsThereIsRoomForBesideHeldOnes) {
  EXPECT_FALSE(editor_.set_number_of_joints(0));
  EXPECT_TRUE(editor_.set_number_of_joints(static_cast<int>(kMaxJoints) - 1));
  EXPECT_EQ(editor_.set_number_of_joints(static_cast<int>(kMaxJoints)).error().message,
            "SetMechanismNumJnts: 32 must be 1 to 31");
}

TEST_F(Mechanism, HasSoManySpindlesAsDeviceJsonDescribesThem) {
  ASSERT_TRUE(editor_.set_number_of_spindles(0));
  EXPECT_TRUE(draft_.device.spindles.empty());
  ASSERT_TRUE(editor_.set_number_of_spindles(2));
  EXPECT_EQ(draft_.device.spindles[0].horse_power, 7);
  EXPECT_EQ(draft_.device.spindles[1].horse_power, 0);
  EXPECT_FALSE(editor_.set_number_of_spindles(-1));
  EXPECT_FALSE(editor_.set_number_of_spindles(5));
}

TEST_F(Mechanism, HasActuatorsModulesAndALargestFeed) {
  ASSERT_TRUE(editor_.set_number_of_actuators(4));
  EXPECT_EQ(draft_.device.actuators.size(), 4U);
  EXPECT_FALSE(editor_.set_number_of_actuators(0));
  ASSERT_TRUE(editor_.set_kinematics({"K", {}, {}}));
  ASSERT_TRUE(editor_.set_actuator_map({"M", {}, {}}));
  EXPECT_EQ(draft_.device.kinematics.name, "K");
  EXPECT_EQ(draft_.device.actuator_map.name, "M");
  ASSERT_TRUE(editor_.set_maximum_feedrate(5000));
  EXPECT_EQ(draft_.device.max_feedrate_mm_min, 5000);
  EXPECT_FALSE(editor_.set_maximum_feedrate(-1));
}

}  // namespace
}  // namespace rmac::gateway
