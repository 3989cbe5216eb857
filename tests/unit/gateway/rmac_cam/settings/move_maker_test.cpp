#include "gateway/rmac_cam/settings/move_maker.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "rmac/motion/move_name.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

const LineGeometry kLine{{{0, 0, 0}, {0, 0, 1}}, {{10, 0, 0}, {0, 0, 1}}};

/// X and Y slide, A turns.
class MakesMoves : public testing::Test {
 protected:
  MakesMoves() {
    machine_.max_feedrate_mm_min = 6000;
    machine_.path_accel_rise_mm_s2 = 800;
    for (const auto& [name, type] :
         {std::pair{"X", JointType::Linear}, {"Y", JointType::Linear}, {"A", JointType::Rotary}}) {
      machine_.joints.push_back({.limits = {name, type, JointLimitType::Limited, -50, 50, 100, 1000, 10000}});
    }
    device_.change(&machine_);
    path_.mechanism_changed(true);
    joints_.mechanism_changed(true);
  }
  sdk::DeviceObject machine_;
  DeviceInForce device_;
  CycleHistory history_{1};
  CamPathSettings path_{device_, history_};
  CamJointSettings joints_{device_};
  MoveMaker maker_{device_, path_, joints_};
  std::vector<double> from_{10, 20, 30};
};

TEST_F(MakesMoves, OfWhatIsInForce) {
  ASSERT_TRUE(path_.set_feedrate(1200));
  ASSERT_TRUE(path_.set_accel_rise(300));
  ASSERT_TRUE(path_.set_accel_fall(400));
  ASSERT_TRUE(path_.set_tolerance(0.05));
  ASSERT_TRUE(path_.set_orientation_tolerance(0.3));
  ASSERT_TRUE(joints_.set_interp_speed(30));
  const Move move = maker_.path_move(7, kLine);
  EXPECT_EQ(move.id, 7);
  EXPECT_EQ(std::get<LineGeometry>(move.geometry).end.tip[0], 10);
  EXPECT_EQ(move.feed_mm_s, 20);
  EXPECT_EQ(move.accel_rise_mm_s2, 300);
  EXPECT_EQ(move.accel_fall_mm_s2, 400);
  EXPECT_EQ(move.tolerance_mm, 0.05);
  EXPECT_EQ(move.orientation_tolerance_deg, 0.3);
  EXPECT_EQ(move.joint_speed_fraction, 0.3);
}

TEST_F(MakesMoves, OfJointsAsTheTightestOfThemLets) {
  ASSERT_TRUE(joints_.set_accel_rise(0, 300));
  ASSERT_TRUE(joints_.set_accel_fall(1, 200));
  // 3 of X and 4 of Y: three fifths and four fifths of the way in joint space.
  const Move move = maker_.joint_move(1, {{13, 24, 30}}, from_);
  EXPECT_DOUBLE_EQ(move.accel_rise_mm_s2, 300 / 0.6);
  EXPECT_DOUBLE_EQ(move.accel_fall_mm_s2, 200 / 0.8);
}

TEST_F(MakesMoves, OfJointsThatStandWithoutABound) {
  const Move move = maker_.joint_move(1, {{10, 20, 30}}, from_);
  EXPECT_EQ(move.accel_rise_mm_s2, 0);
  EXPECT_EQ(move.accel_fall_mm_s2, 0);
}

TEST_F(MakesMoves, OfItsOwnAtTheFeedInForceOrAsFastAsJointMoves) {
  ASSERT_TRUE(joints_.set_interp_speed(50));
  const ToolPose target{{1, 2, 3}, {0, 0, 1}};
  EXPECT_EQ(maker_.straight_move(target).feed_mm_s, 50);
  EXPECT_EQ(maker_.straight_move(target).id, kPositioningMoveId);
  ASSERT_TRUE(path_.set_feedrate(600));
  EXPECT_EQ(maker_.straight_move(target).feed_mm_s, 10);
}

TEST_F(MakesMoves, AtASpeedThatIsBoundedAsFeedsAre) {
  EXPECT_EQ(maker_.path_move_at("F", 1, kLine, 100).value().feed_mm_s, 100);
  EXPECT_EQ(maker_.path_move_at("F", 1, kLine, 100.1).error().message,
            "F: 100.1 mm/s is above the maximum feed of 100 mm/s");
  EXPECT_EQ(maker_.path_move_at("F", 1, kLine, 0).error().code, MinorCode::InvalidParameterValue);
  EXPECT_FALSE(maker_.path_move_at("F", 1, kLine, std::numeric_limits<double>::infinity()));
}

TEST_F(MakesMoves, AtTheSpeedOfTheLinearJointsTogether) {
  // 5 mm at 10 mm/s: half a second, in which A turns 45 degrees, at 90 of its 100 degrees a second.
  const auto move = maker_.joint_move_at("F", 1, {{13, 24, 75}}, from_, 10);
  ASSERT_TRUE(move);
  EXPECT_NEAR(move->joint_speed_fraction, 0.9, 1e-12);
}

TEST_F(MakesMoves, AtTheSpeedOfAllWhereNoLinearJointMoves) {
  const auto move = maker_.joint_move_at("F", 1, {{10, 20, 40}}, from_, 25);
  ASSERT_TRUE(move);
  EXPECT_NEAR(move->joint_speed_fraction, 0.25, 1e-12);
}

TEST_F(MakesMoves, RefusesASpeedThatTakesAJointBeyondItsLimit) {
  const auto refused = maker_.joint_move_at("F", 1, {{13, 24, 81}}, from_, 10);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::SpeedLimit);
  EXPECT_EQ(refused.error().message, "F: joint A would go at 102 a second, and its limit is 100");
}

TEST_F(MakesMoves, RefusesATargetThatIsNotOnePositionAJoint) {
  EXPECT_EQ(maker_.check_joint_target("F", {{1, 2}}, 1).error().message,
            "F: 2 positions are given, and the mechanism has 3 joints");
  EXPECT_EQ(maker_.check_joint_target("F", {{1, 2, 3}}, 0).error().message, "F: the speed must be above 0");
  EXPECT_TRUE(maker_.check_joint_target("F", {{1, 2, 3}}, 1));
  device_.change(nullptr);
  EXPECT_THAT(maker_.check_joint_target("F", {{1, 2, 3}}, 1).error().message, HasSubstr("no mechanism is loaded"));
}

}  // namespace
}  // namespace rmac::gateway
