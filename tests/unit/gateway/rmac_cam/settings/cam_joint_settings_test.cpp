#include "gateway/rmac_cam/settings/cam_joint_settings.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace rmac::gateway {
namespace {

class JointSettings : public testing::Test {
 protected:
  JointSettings() {
    device_object_.joints.resize(2);
    device_object_.joints[0].limits.max_acceleration = 500;
    device_object_.joints[1].limits.max_acceleration = 700;
    device_.change(&device_object_);
    settings_.mechanism_changed(true);
  }
  sdk::DeviceObject device_object_;
  DeviceInForce device_;
  CamJointSettings settings_{device_};
};

TEST_F(JointSettings, BeginWithTheJointsLimits) {
  EXPECT_EQ(settings_.interp_speed(), 100);
  EXPECT_EQ(settings_.accel_rise(0).value(), 500);
  EXPECT_EQ(settings_.accel_fall(1).value(), 700);
}

TEST_F(JointSettings, AreEachJointsAndEachDirectionsOwn) {
  ASSERT_TRUE(settings_.set_accel_rise(0, 100));
  ASSERT_TRUE(settings_.set_accel_fall(1, 200));
  EXPECT_THAT(settings_.values().accel_rise, testing::ElementsAre(100, 700));
  EXPECT_THAT(settings_.values().accel_fall, testing::ElementsAre(500, 200));
  EXPECT_EQ(settings_.accel_rise(0).value(), 100);
  EXPECT_EQ(settings_.accel_fall(1).value(), 200);
}

TEST_F(JointSettings, RefuseWhatTheJointCannotDo) {
  EXPECT_EQ(settings_.set_accel_rise(0, 501).error().code, MinorCode::AccelerationLimit);
  EXPECT_TRUE(settings_.set_accel_rise(1, 501));
  EXPECT_EQ(settings_.set_accel_fall(0, 0).error().code, MinorCode::InvalidParameterValue);
  EXPECT_FALSE(settings_.set_accel_fall(2, 1));
  EXPECT_FALSE(settings_.accel_rise(-1));
  EXPECT_FALSE(settings_.accel_fall(2));
}

TEST_F(JointSettings, TakeASpeedAboveNoneUpToAllOfIt) {
  for (const double refused : {0.0, -1.0, 100.5, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(settings_.set_interp_speed(refused)) << refused;
  }
  ASSERT_TRUE(settings_.set_interp_speed(100));
  ASSERT_TRUE(settings_.set_interp_speed(0.1));
  EXPECT_EQ(settings_.interp_speed(), 0.1);
}

TEST_F(JointSettings, KeepTheSpeedAloneWhenTheMechanismIsConfiguredAnew) {
  ASSERT_TRUE(settings_.set_interp_speed(40));
  ASSERT_TRUE(settings_.set_accel_rise(0, 100));
  device_object_.joints[0].limits.max_acceleration = 900;
  settings_.mechanism_changed(false);
  EXPECT_EQ(settings_.interp_speed(), 40);
  EXPECT_EQ(settings_.accel_rise(0).value(), 900);
  settings_.mechanism_changed(true);
  EXPECT_EQ(settings_.interp_speed(), 100);
}

TEST_F(JointSettings, AreTakenUpAgain) {
  ASSERT_TRUE(settings_.set_interp_speed(40));
  ASSERT_TRUE(settings_.set_accel_rise(0, 100));
  const CamJointSettings::Values before = settings_.values();
  settings_.mechanism_changed(true);
  settings_.take_up(before);
  EXPECT_EQ(settings_.interp_speed(), 40);
  EXPECT_EQ(settings_.accel_rise(0).value(), 100);
}

}  // namespace
}  // namespace rmac::gateway
