#include "gateway/rmac_cam/cam_queue.hpp"

#include "unit/gateway/rmac_cam/standing_mill.hpp"

namespace rmac::gateway {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const LineGeometry kLine{{{0, 0, 0}, {0, 0, 1}}, {{10, 0, 0}, {0, 0, 1}}};
const PathTargetGeometry kPathTarget{{{10, 0, 0}, {0, 0, 1}}};
const JointTargetGeometry kJointTarget{{3, 4, 0}};

class MoveQueue : public StandingMill {
 protected:
  CamQueue queue_{device_, supervisor_, path_, maker_, tools_};
};

TEST_F(MoveQueue, TakesAMoveAtWhatIsInForce) {
  ASSERT_TRUE(path_.set_feedrate(600));
  ASSERT_TRUE(path_.set_tolerance(0.05));
  ASSERT_TRUE(queue_.add(7, kLine));
  ASSERT_EQ(queued_.size(), 1U);
  EXPECT_EQ(queued_[0].id, 7);
  EXPECT_EQ(queued_[0].feed_mm_s, 10);
  EXPECT_EQ(queued_[0].tolerance_mm, 0.05);
  EXPECT_EQ(queue_.moves_left(), 1);
}

TEST_F(MoveQueue, BoundsAJointMoveByItsJointsFromWhereTheQueueEnds) {
  ASSERT_TRUE(joints_.set_accel_rise(1, 200));
  ASSERT_TRUE(queue_.add(1, kJointTarget)) << "it needs no feed";
  EXPECT_DOUBLE_EQ(queued_[0].accel_rise_mm_s2, 200 / 0.8);
  ASSERT_TRUE(queue_.add(2, JointTargetGeometry{{3, 5, 0}}));
  EXPECT_DOUBLE_EQ(queued_[1].accel_rise_mm_s2, 200);
}

TEST_F(MoveQueue, TakesNoPathMoveWithoutAFeed) {
  for (const Geometry& geometry : {Geometry(kLine), Geometry(kPathTarget)}) {
    const auto refused = queue_.add(7, geometry);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, MinorCode::SpeedLimit);
    EXPECT_THAT(refused.error().message, HasSubstr("move 7: no feed is set"));
  }
  EXPECT_EQ(queue_.moves_left(), 0);
}

TEST_F(MoveQueue, CutsOnlyWhileTheToolsSpindleTurns) {
  ASSERT_TRUE(tools_.set_tool({.number = 1, .length_mm = 50}));
  supervisor_.set_mounted(1);
  ASSERT_TRUE(path_.set_feedrate(600));
  EXPECT_THAT(queue_.add(1, kLine).error().message, HasSubstr("tool 1 needs the spindle turning"));
  EXPECT_TRUE(queue_.add(2, kPathTarget)) << "positioning does not cut";
  EXPECT_TRUE(queue_.add(3, kJointTarget));
  supervisor_.set_spindle(0, -500);
  EXPECT_TRUE(queue_.add(4, LineGeometry{{{3, 4, 0}, {0, 0, 1}}, {{10, 0, 0}, {0, 0, 1}}}));
}

TEST_F(MoveQueue, FindsJointsInThePartFrameFromTheToolsTip) {
  supervisor_.set_frames({{{100, 0, 0}, {1, 0, 0, 0}}, {{0, 0, -50}, {1, 0, 0, 0}}});
  const auto joints = queue_.joints_at({{-90, 5, -40}, {0, 0, 1}});
  ASSERT_TRUE(joints) << joints.error().message;
  EXPECT_THAT(*joints, ElementsAre(10, 5, 10));
}

TEST_F(MoveQueue, GivesJointsBeyondTheTravelSoThatTheMoveSaysWhichLeavesIt) {
  EXPECT_THAT(queue_.joints_at({{0, 70, 0}, {0, 0, 1}}).value(), ElementsAre(0, 70, 0));
}

TEST_F(MoveQueue, FindsNoJointsForAPoseOutOfReach) {
  sdk::DeviceObject plane = TestMachine::plane_mill();
  put_in(plane);
  const auto refused = queue_.joints_at({{1, 2, 3}, {0, 0, 1}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::TravelLimit);
  EXPECT_THAT(refused.error().message, HasSubstr("no joint positions give the pose with the tip at 1, 2, 3 mm"));
}

TEST_F(MoveQueue, NeedsAMechanism) {
  device_.change(nullptr);
  EXPECT_EQ(queue_.add(1, kLine).error().message, "move: no mechanism is loaded; load one with Device.Load");
  EXPECT_THAT(queue_.joints_at({}).error().message, HasSubstr("MoveToJointTarget: no mechanism is loaded"));
}

}  // namespace
}  // namespace rmac::gateway
