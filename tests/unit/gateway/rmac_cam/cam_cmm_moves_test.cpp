#include "gateway/rmac_cam/cam_cmm_moves.hpp"

#include "unit/gateway/rmac_cam/standing_mill.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class CmmMoves : public StandingMill {
 protected:
  [[nodiscard]] const std::vector<double>& target() const {
    return std::get<JointTargetGeometry>(queued_.back().geometry).joints;
  }
  CamCmmMoves moves_{device_, supervisor_, maker_};
};

TEST_F(CmmMoves, GoAtTheirOwnSpeedWhateverFeedIsInForce) {
  ASSERT_TRUE(path_.set_feedrate(600));
  ASSERT_TRUE(moves_.to_point(5, {10, 0, 0}, 40));
  EXPECT_EQ(queued_[0].id, 5);
  EXPECT_EQ(queued_[0].feed_mm_s, 40);
  EXPECT_THAT(moves_.to_point(6, {0, 0, 0}, 201).error().message,
              HasSubstr("MoveToXYZ: 201 mm/s is above the maximum feed of 200 mm/s"));
  EXPECT_EQ(queued_.size(), 1U);
}

TEST_F(CmmMoves, BeginWhereTheQueueEnds) {
  ASSERT_TRUE(moves_.to_point(1, {10, 0, 0}, 40));
  ASSERT_TRUE(moves_.in_arc(2, {{0, 10, 0}, {0, 0, 0}, {0, 0, 1}}, 30));
  const auto& arc = std::get<ArcGeometry>(queued_[1].geometry);
  EXPECT_EQ(arc.start.tip, (Vector{10, 0, 0}));
  EXPECT_EQ(arc.end.tip, (Vector{0, 10, 0}));
  EXPECT_FALSE(arc.closed);
  EXPECT_EQ(queued_[1].feed_mm_s, 30);
}

TEST_F(CmmMoves, AnArcToWhereItBeginsIsAWholeCircle) {
  ASSERT_TRUE(moves_.to_point(1, {10, 0, 0}, 40));
  ASSERT_TRUE(moves_.in_arc(2, {{10, 0, 5e-7}, {0, 0, 0}, {0, 0, 1}}, 30));
  EXPECT_TRUE(std::get<ArcGeometry>(queued_[1].geometry).closed);
}

TEST_F(CmmMoves, TakeJointsFromTheQueuesEnd) {
  ASSERT_TRUE(moves_.all_joints(1, {30, 40, 0}, 100));
  EXPECT_NEAR(queued_[0].joint_speed_fraction, 80.0 / 200, 1e-12) << "Y goes 40 of 50 mm";
  ASSERT_TRUE(moves_.all_joints(2, {30, 30, 0}, 100));
  EXPECT_NEAR(queued_[1].joint_speed_fraction, 100.0 / 200, 1e-12);
  EXPECT_THAT(moves_.all_joints(3, {1, 2}, 100).error().message, HasSubstr("MoveAllAxis: 2 positions are given"));
}

/// The first joint is told to turn, without ends unless the test gives it some.
class RotaryJoint : public CmmMoves {
 protected:
  void SetUp() override {
    sdk::DeviceObject wide = TestMachine::mill();
    for (sdk::Joint& joint : wide.joints) joint.limits.min = -1000, joint.limits.max = 1000;
    put_in(wide);
    turning_ = wide;
    turning_.joints[0].limits.type = JointType::Rotary;
    turning_.joints[0].limits.limit_type = JointLimitType::Infinite;
    describe(turning_);
    stand_at({350, 1, 2});
  }
  sdk::DeviceObject turning_;
};

TEST_F(RotaryJoint, TakesTheShortestWay) {
  ASSERT_TRUE(moves_.rotary_joint(1, 0, 10, 0, 50));
  EXPECT_THAT(target(), testing::ElementsAre(370, 1, 2));
}

TEST_F(RotaryJoint, TurnsInTheSenseThatIsAskedFor) {
  ASSERT_TRUE(moves_.rotary_joint(1, 0, 10, -1, 50));
  EXPECT_EQ(target()[0], 10);
  ASSERT_TRUE(moves_.rotary_joint(2, 0, 0, 1, 50));
  EXPECT_EQ(target()[0], 360);
}

TEST_F(RotaryJoint, StaysWhereItIsThereWhateverTheSense) {
  ASSERT_TRUE(moves_.rotary_joint(1, 0, -10, 1, 50));
  EXPECT_EQ(target()[0], 350);
}

TEST_F(RotaryJoint, StaysWithinItsTravel) {
  turning_.joints[0].limits = {"A", JointType::Rotary, JointLimitType::Limited, -5, 360, 200, 1000, 10000};
  ASSERT_TRUE(moves_.rotary_joint(1, 0, 10, 0, 50));
  EXPECT_EQ(target()[0], 10) << "370 would be nearer";
  ASSERT_TRUE(moves_.rotary_joint(2, 0, 20, 1, 50));
  const auto beyond = moves_.rotary_joint(3, 0, 10, 1, 50);
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, MinorCode::TravelLimit);
  EXPECT_EQ(beyond.error().message,
            "MoveRotaryAxis: joint A cannot turn from 20 to 10 degrees in the positive sense within its travel from -5 "
            "to 360");
}

TEST_F(RotaryJoint, IsNoneThatSlides) {
  EXPECT_EQ(moves_.rotary_joint(1, 1, 10, 0, 50).error().message,
            "MoveRotaryAxis: joint 1 (Y) does not turn; use MoveAllAxis");
  EXPECT_FALSE(moves_.rotary_joint(1, 3, 10, 0, 50));
}

}  // namespace
}  // namespace rmac::gateway
