#include "gateway/rmac_config/config_draft.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "rmac/motion/pose.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

using Extent = ConfigDraft::Extent;

/// A draft whose controller takes everything and remembers it.
class DraftOfAMill : public testing::Test {
 protected:
  DraftOfAMill()
      : draft_({[this](const sdk::DeviceObject& device, ConfigDraft::Extent extent) -> Expected<> {
                  applied_.push_back(device.joints.size());
                  extents_.push_back(extent);
                  return {};
                },
                [](const sdk::ModuleChoice&) -> Expected<> { return {}; },
                [](const sdk::ModuleChoice&) -> Expected<> { return {}; }}) {
    sdk::DeviceObject device;
    device.name = "Mill";
    device.held_joints.resize(1);
    EXPECT_TRUE(draft_.begin(device));
    EXPECT_TRUE(draft_.mechanism().set_number_of_joints(2));
  }
  ConfigDraft draft_;
  std::vector<std::size_t> applied_;
  std::vector<ConfigDraft::Extent> extents_;
};

TEST_F(DraftOfAMill, HeldJointsFollowTheJoints) {
  ASSERT_TRUE(draft_.joints().set_name(1, "Y"));
  ASSERT_TRUE(draft_.joints().set_name(2, "Z"));
  EXPECT_EQ(draft_.draft().joints[1].limits.name, "Y");
  EXPECT_EQ(draft_.draft().held_joints[0].limits.name, "Z");
}

TEST_F(DraftOfAMill, RefusesWhatNoDraftCouldMakeRight) {
  EXPECT_EQ(draft_.joints().set_maximum_speed(3, 1).error().message,
            "SetMechanismJointMaximumSpeed: there is no joint 3; joints are 0 to 2");
  EXPECT_FALSE(draft_.joints().set_maximum_speed(-1, 1));
  EXPECT_FALSE(draft_.joints().set_maximum_speed(0, 0));
  EXPECT_FALSE(draft_.joints().set_maximum_acceleration(0, -1));
  EXPECT_FALSE(draft_.joints().set_maximum_jerk(0, std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(draft_.joints().set_minimum_limit(0, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(draft_.mechanism().set_number_of_joints(0));
  EXPECT_FALSE(draft_.mechanism().set_number_of_joints(static_cast<int>(kMaxJoints)));
  EXPECT_FALSE(draft_.mechanism().set_kinematics({"", {}, {}}));
  EXPECT_FALSE(draft_.spindles().set_maximum_rpm(0, 100)) << "there is no spindle";
  EXPECT_FALSE(draft_.loops().set_servo_law(0, {"", {}, {}}));
}

TEST_F(DraftOfAMill, NothingActsBeforeApply) {
  EXPECT_TRUE(applied_.empty());
  ASSERT_TRUE(draft_.apply());
  EXPECT_THAT(applied_, testing::ElementsAre(2));
}

TEST_F(DraftOfAMill, OnlyTheFirstApplyAfterBeginIsANewMechanism) {
  ASSERT_TRUE(draft_.apply());
  ASSERT_TRUE(draft_.joints().set_maximum_speed(0, 10));
  ASSERT_TRUE(draft_.apply());
  EXPECT_THAT(extents_, testing::ElementsAre(Extent::Mechanism, Extent::Configuration));
}

TEST_F(DraftOfAMill, LoopsAloneAreToldFromWhateverElseIsSetBesideThem) {
  ASSERT_TRUE(draft_.loops().set_servo_law(0, {"PIDServoControlLaw", {}, {}}));
  ASSERT_TRUE(draft_.apply());
  const std::vector<double> gains{1, 2, 3};
  const auto set_law = [&] {
    ASSERT_TRUE(draft_.loops().set_servo_law(0, {"FuzzyServoControlLaw", {}, {}}));
    ASSERT_TRUE(draft_.loops().set_gains(0, gains));
  };
  set_law();
  ASSERT_TRUE(draft_.loops().set_control_method(0, ControlMethod::Velocity));
  ASSERT_TRUE(draft_.apply());
  EXPECT_EQ(extents_.back(), Extent::Loops);
  const std::vector<std::function<Expected<>()>> others{
      [&] {
        return draft_.mechanism().set_kinematics({"K", {}, {}});
      },
      [&] {
        return draft_.mechanism().set_actuator_map({"M", {}, {}});
      },
      [&] { return draft_.mechanism().set_number_of_joints(2); },
      [&] { return draft_.mechanism().set_number_of_spindles(0); },
      [&] { return draft_.mechanism().set_number_of_actuators(3); },
      [&] { return draft_.joints().set_name(0, "A"); },
      [&] { return draft_.joints().set_maximum_jerk(1, 100); },
      [&] { return draft_.mechanism().set_maximum_feedrate(100); },
      [&] { return draft_.loops().set_control_method(0, ControlMethod::Force); },
      [&] { return draft_.loops().set_watch(0, 1, 1); },
      [&] { return draft_.loops().set_mechanics(0, {}); },
      [&] {
        return draft_.loops().set_servo_law(1, {"PIDServoControlLaw", {}, {}});
      },
      [&] {
        return draft_.interfaces().set_control({"I", {}, {}});
      },
      [&] { return draft_.interfaces().set_io({}); }};
  for (std::size_t i = 0; i < others.size(); ++i) {
    set_law();
    const auto changed = others[i]();
    ASSERT_TRUE(changed) << i << ": " << changed.error().message;
    ASSERT_TRUE(draft_.apply());
    EXPECT_EQ(extents_.back(), Extent::Configuration) << i;
  }
}

TEST_F(DraftOfAMill, ApplyNeedsAMechanism) {
  draft_.discard(nullptr);
  EXPECT_THAT(draft_.apply().error().message, HasSubstr("load a device driver"));
  EXPECT_TRUE(applied_.empty());
}

}  // namespace
}  // namespace rmac::gateway
