#include "gateway/rmac_config/loop_editor.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using Extent = Draft::Extent;
using testing::ElementsAre;

class Loops : public testing::Test {
 protected:
  Loops() {
    device_.joints.resize(2);
    device_.joints[0].servo_law.name = "Law";
    draft_.restart(&device_);
  }
  [[nodiscard]] const sdk::Joint& joint() const { return draft_.device.joints[0]; }
  sdk::DeviceObject device_;
  Draft draft_;
  LoopEditor editor_{draft_};
};

TEST_F(Loops, ChangeALawItsGainsAndItsMethodAsLoops) {
  ASSERT_TRUE(editor_.set_servo_law(0, {"Other", {{"lead_s", {0.1}}}, {}}));
  ASSERT_TRUE(editor_.set_gains(0, std::vector<double>{1, 2}));
  ASSERT_TRUE(editor_.set_control_method(0, ControlMethod::Velocity));
  EXPECT_EQ(joint().servo_law.name, "Other");
  EXPECT_EQ(joint().servo_law.numbers.at("lead_s").at(0), 0.1);
  EXPECT_THAT(joint().gains, ElementsAre(1, 2));
  EXPECT_EQ(joint().method, ControlMethod::Velocity);
  EXPECT_EQ(draft_.extent, Extent::Loops);
}

TEST_F(Loops, GetALawWhereTheDriveClosedTheLoop) {
  ASSERT_TRUE(editor_.set_servo_law(1, {"Law", {}, {}}));
  EXPECT_EQ(draft_.extent, Extent::Configuration);
}

TEST_F(Loops, ComeUnderForceControlAndOutOfIt) {
  ASSERT_TRUE(editor_.set_control_method(0, ControlMethod::Force));
  EXPECT_EQ(draft_.extent, Extent::Configuration);
  draft_.extent = Extent::Loops;
  ASSERT_TRUE(editor_.set_control_method(0, ControlMethod::Position));
  EXPECT_EQ(draft_.extent, Extent::Configuration);
}

TEST_F(Loops, AreWatchedAndMadeGood) {
  ASSERT_TRUE(editor_.set_watch(0, 3, 400));
  EXPECT_EQ(joint().max_following_error, 3);
  EXPECT_EQ(joint().max_effort, 400);
  EXPECT_EQ(draft_.extent, Extent::Configuration);
  EXPECT_FALSE(editor_.set_watch(0, -1, 400));
  EXPECT_FALSE(editor_.set_watch(0, 3, -1));
  draft_.extent = Extent::Loops;
  ASSERT_TRUE(editor_.set_mechanics(0, {}));
  EXPECT_EQ(draft_.extent, Extent::Configuration);
}

TEST_F(Loops, StayAsTheyAreOnARefusal) {
  EXPECT_FALSE(editor_.set_servo_law(0, {}));
  EXPECT_FALSE(editor_.set_gains(0, std::vector<double>{std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_FALSE(editor_.set_gains(2, std::vector<double>{1}));
  EXPECT_FALSE(editor_.set_control_method(-1, ControlMethod::Position));
  EXPECT_EQ(joint().servo_law.name, "Law");
  EXPECT_TRUE(joint().gains.empty());
}

}  // namespace
}  // namespace rmac::gateway
