#include "gateway/rmac_config/config_draft.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "rmac/motion/pose.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

/// A draft whose controller takes everything and remembers it.
class Draft : public testing::Test {
 protected:
  Draft()
      : draft_({[this](const sdk::DeviceObject& device, bool fresh) -> Expected<> {
                  applied_.push_back(device.joints.size());
                  fresh_.push_back(fresh);
                  return {};
                },
                [](const sdk::ModuleChoice&) -> Expected<> { return {}; },
                [](const sdk::ModuleChoice&) -> Expected<> { return {}; }}) {
    sdk::DeviceObject device;
    device.name = "Mill";
    device.held_joints.resize(1);
    EXPECT_TRUE(draft_.begin(device));
    EXPECT_TRUE(draft_.set_number_of_joints(2));
  }
  ConfigDraft draft_;
  std::vector<std::size_t> applied_;
  std::vector<bool> fresh_;
};

TEST_F(Draft, HeldJointsFollowTheJoints) {
  ASSERT_TRUE(draft_.set_joint_name(1, "Y"));
  ASSERT_TRUE(draft_.set_joint_name(2, "Z"));
  EXPECT_EQ(draft_.draft().joints[1].limits.name, "Y");
  EXPECT_EQ(draft_.draft().held_joints[0].limits.name, "Z");
}

TEST_F(Draft, RefusesWhatNoDraftCouldMakeRight) {
  EXPECT_EQ(draft_.set_joint_maximum_speed(3, 1).error().message,
            "SetMechanismJointMaximumSpeed: there is no joint 3; joints are 0 to 2");
  EXPECT_FALSE(draft_.set_joint_maximum_speed(-1, 1));
  EXPECT_FALSE(draft_.set_joint_maximum_speed(0, 0));
  EXPECT_FALSE(draft_.set_joint_maximum_acceleration(0, -1));
  EXPECT_FALSE(draft_.set_joint_maximum_jerk(0, std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(draft_.set_joint_minimum_limit(0, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(draft_.set_number_of_joints(0));
  EXPECT_FALSE(draft_.set_number_of_joints(static_cast<int>(kMaxJoints)));
  EXPECT_FALSE(draft_.set_kinematics({"", {}, {}}));
  EXPECT_FALSE(draft_.set_spindle_maximum_rpm(0, 100)) << "there is no spindle";
  EXPECT_FALSE(draft_.set_joint_servo_control_law(0, {"", {}, {}}));
}

TEST_F(Draft, NothingActsBeforeApply) {
  EXPECT_TRUE(applied_.empty());
  ASSERT_TRUE(draft_.apply());
  EXPECT_THAT(applied_, testing::ElementsAre(2));
}

TEST_F(Draft, OnlyTheFirstApplyAfterBeginIsANewMechanism) {
  ASSERT_TRUE(draft_.apply());
  ASSERT_TRUE(draft_.apply());
  EXPECT_THAT(fresh_, testing::ElementsAre(true, false));
}

TEST_F(Draft, ApplyNeedsAMechanism) {
  draft_.discard(nullptr);
  EXPECT_THAT(draft_.apply().error().message, HasSubstr("load a device driver"));
  EXPECT_TRUE(applied_.empty());
}

}  // namespace
}  // namespace rmac::gateway
