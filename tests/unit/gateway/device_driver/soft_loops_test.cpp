#include "gateway/device_driver/soft_loops.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

sdk::Joint joint_with(const char* law, std::vector<double> gains) {
  sdk::Joint joint;
  joint.servo_law.name = law;
  joint.gains = std::move(gains);
  joint.limits.max_acceleration = 1000;
  joint.limits.max_speed = 200;
  joint.max_following_error = 0.5;
  return joint;
}

TEST(SoftLoops, DividePidsAndLeaveWhatStandsBehindThem) {
  sdk::DeviceObject device;
  device.joints = {joint_with("PIDServoControlLaw", {1600, 128000, 8}),
                   joint_with("FeedforwardFeedbackServoControlLaw", {800, 6400, 16, 0.1, 0.02, 19, 3})};
  device.held_joints = {joint_with("PIDServoControlLaw", {80, 64, 4})};
  device.joints[0].gantry = Gantry{.max_skew = 0.2, .stiffness = 800, .damping = 4};
  const sdk::DeviceObject soft = softened(device, 8).value();
  EXPECT_THAT(soft.joints[0].gains, ElementsAre(200, 2000, 1));
  EXPECT_EQ(soft.joints[0].gantry->max_skew, 0.2);
  EXPECT_EQ(soft.joints[0].gantry->stiffness, 100) << "each side is as soft as its joint";
  EXPECT_EQ(soft.joints[0].gantry->damping, 0.5);
  EXPECT_THAT(soft.joints[1].gains, ElementsAre(100, 100, 2, 0.1, 0.02, 19, 3));
  EXPECT_THAT(soft.held_joints[0].gains, ElementsAre(10, 1, 0.5));
  for (const sdk::Joint& joint : soft.joints) {
    EXPECT_EQ(joint.limits.max_acceleration, 250);
    EXPECT_EQ(joint.limits.max_speed, 200);
  }
}

TEST(SoftLoops, PushNoHarderAtTheirBoundThanBefore) {
  for (const double factor : {1.0, 1.5, 2.0, 8.0, 32.0, 100.0}) {
    sdk::DeviceObject device;
    device.joints = {joint_with("PIDServoControlLaw", {1600, 128000, 8})};
    const sdk::Joint& before = device.joints[0];
    const sdk::DeviceObject soft = softened(device, factor).value();
    const sdk::Joint& after = soft.joints[0];
    EXPECT_GE(after.max_following_error, before.max_following_error);
    EXPECT_LE(after.gains[0] * after.max_following_error, before.gains[0] * before.max_following_error) << factor;
  }
}

TEST(SoftLoops, LeaveOtherLawsAlone) {
  sdk::DeviceObject device;
  device.joints = {joint_with("FuzzyServoControlLaw", {0.16, 22, 120, 140000}), joint_with("", {}),
                   joint_with("PIDServoControlLaw", {1600, 128000, 8})};
  const sdk::DeviceObject same = softened(device, 8).value();
  EXPECT_THAT(same.joints[0].gains, ElementsAre(0.16, 22, 120, 140000));
  for (const std::size_t other : {0U, 1U}) {
    EXPECT_EQ(same.joints[other].limits.max_acceleration, 1000);
    EXPECT_EQ(same.joints[other].max_following_error, 0.5);
  }
}

TEST(SoftLoops, AreNotPromisedWhereThereAreNone) {
  sdk::DeviceObject device;
  device.name = "Drill";
  device.joints = {joint_with("FuzzyServoControlLaw", {0.16, 22, 120, 140000}), joint_with("", {})};
  EXPECT_THAT(softened(device, 8).error().message, HasSubstr("no joint of Drill has a PID"));
  device.joints.push_back(joint_with("PIDServoControlLaw", {1600, 128000, 8}));
  device.overlay = true;
  EXPECT_THAT(softened(device, 8).error().message, HasSubstr("lies over another machine"));
}

TEST(SoftLoops, WidenNoBoundBeyondWhatAMachineStands) {
  sdk::DeviceObject device;
  device.joints = {joint_with("PIDServoControlLaw", {1600, 128000, 8})};
  for (const double bound : {0.01, 1.0, 4.0, 30.0, 1000.0}) {
    device.joints[0].max_following_error = bound;
    const double wider = softened(device, 100).value().joints[0].max_following_error;
    EXPECT_EQ(wider, std::max(bound, std::min(10.0, 4 * bound)));
  }
}

}  // namespace
}  // namespace rmac::gateway
