#include "gateway/rmac_config/joint_editor.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace rmac::gateway {
namespace {

class Joints : public testing::Test {
 protected:
  Joints() {
    device_.joints.resize(1);
    device_.held_joints.resize(1);
    draft_.restart(&device_);
  }
  [[nodiscard]] const JointLimits& held() const { return draft_.device.held_joints[0].limits; }
  sdk::DeviceObject device_;
  Draft draft_;
  JointEditor editor_{draft_};
};

TEST_F(Joints, HaveEachLimitInItsPlace) {
  ASSERT_TRUE(editor_.set_name(1, "Z"));
  ASSERT_TRUE(editor_.set_type(1, JointType::Rotary));
  ASSERT_TRUE(editor_.set_limit_type(1, JointLimitType::InfinitePositive));
  ASSERT_TRUE(editor_.set_maximum_limit(1, 60));
  ASSERT_TRUE(editor_.set_minimum_limit(1, -70));
  ASSERT_TRUE(editor_.set_maximum_speed(1, 80));
  ASSERT_TRUE(editor_.set_maximum_acceleration(1, 900));
  ASSERT_TRUE(editor_.set_maximum_jerk(1, 1000));
  EXPECT_EQ(held().name, "Z");
  EXPECT_EQ(held().type, JointType::Rotary);
  EXPECT_EQ(held().limit_type, JointLimitType::InfinitePositive);
  EXPECT_EQ(held().max, 60);
  EXPECT_EQ(held().min, -70);
  EXPECT_EQ(held().max_speed, 80);
  EXPECT_EQ(held().max_acceleration, 900);
  EXPECT_EQ(held().max_jerk, 1000);
  EXPECT_EQ(draft_.device.joints[0].limits.name, "") << "the other joint is as it was";
  EXPECT_EQ(draft_.extent, Draft::Extent::Configuration);
}

TEST_F(Joints, StayAsTheyAreOnARefusal) {
  EXPECT_EQ(editor_.set_name(0, "").error().message, "joint name: a name must have a letter at least");
  EXPECT_FALSE(editor_.set_maximum_speed(0, 0));
  EXPECT_FALSE(editor_.set_maximum_acceleration(0, -1));
  EXPECT_FALSE(editor_.set_maximum_jerk(0, std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(editor_.set_maximum_limit(0, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(editor_.set_type(2, JointType::Linear).error().message,
            "SetMechanismJointType: there is no joint 2; joints are 0 to 1");
  EXPECT_EQ(draft_.extent, Draft::Extent::Loops);
}

}  // namespace
}  // namespace rmac::gateway
