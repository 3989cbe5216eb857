#include "gateway/rmac_cam/settings/cam_frame_settings.hpp"

#include "unit/gateway/rmac_cam/standing_mill.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class FrameSettings : public StandingMill {
 protected:
  CamFrameSettings frames_{device_, supervisor_};
};

TEST_F(FrameSettings, AreInForceAtOnceAndEachByItself) {
  ASSERT_TRUE(frames_.set_part({{1, 2, 3}, {1, 0, 0, 0}}));
  ASSERT_TRUE(frames_.set_tool_interface({{0, 0, -80}, {0, 1, 0, 0}}));
  EXPECT_EQ(frames_.part().p, (Vector{1, 2, 3}));
  EXPECT_EQ(frames_.tool_interface().p, (Vector{0, 0, -80}));
  EXPECT_EQ(supervisor_.wishes().frames.part.p, (Vector{1, 2, 3}));
  EXPECT_EQ(supervisor_.wishes().frames.tool.q[1], 1);
}

TEST_F(FrameSettings, BringQuaternionsToLengthOne) {
  ASSERT_TRUE(frames_.set_part({{0, 0, 0}, {1 + 5e-7, 0, 0, 0}}));
  EXPECT_EQ(frames_.part().q[0], 1);
  EXPECT_THAT(frames_.set_part({{0, 0, 0}, {2, 0, 0, 0}}).error().message, HasSubstr("SetPartFrame: the quaternion"));
  EXPECT_THAT(frames_.set_tool_interface({{0, 0, 0}, {0, 0, 0, 0}}).error().message,
              HasSubstr("SetToolInterfaceFrame: the quaternion"));
}

TEST_F(FrameSettings, StayWhileMovesAreQueued) {
  ASSERT_TRUE(path_.set_feedrate(600));
  ASSERT_TRUE(queue_line(1, {0, 0, 0}, {10, 0, 0}));
  EXPECT_THAT(frames_.set_part({{1, 0, 0}, {1, 0, 0, 0}}).error().message,
              HasSubstr("SetPartFrame needs an empty queue"));
  EXPECT_THAT(frames_.set_tool_interface({{1, 0, 0}, {1, 0, 0, 0}}).error().message,
              HasSubstr("SetToolInterfaceFrame needs an empty queue"));
  EXPECT_EQ(frames_.part().p, (Vector{0, 0, 0}));
}

TEST_F(FrameSettings, NeedAMechanism) {
  device_.change(nullptr);
  EXPECT_THAT(frames_.set_part({}).error().message, HasSubstr("no mechanism is loaded"));
  EXPECT_THAT(frames_.set_tool_interface({}).error().message, HasSubstr("no mechanism is loaded"));
}

}  // namespace
}  // namespace rmac::gateway
