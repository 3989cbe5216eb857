#include "gateway/simulators/vdrive/axis/position_targets.hpp"

#include <gtest/gtest.h>

namespace rmac::vdrive {
namespace {

constexpr std::uint16_t kIdle = 0x0F, kNew = 0x1F, kNewAtOnce = 0x3F, kNewRelative = 0x5F;

/// What a controlword finds of a drive that operates and is on its way to a target.
constexpr PositionTargets::Seen moving(double written) {
  return {.active = true, .at_target = false, .at_rest = false, .written = written};
}
constexpr PositionTargets::Seen resting(double written) {
  return {.active = true, .at_target = false, .at_rest = true, .written = written};
}

TEST(PositionTargets, AreTakenOnTheRiseOfBitFourAndAcknowledgedUntilItFalls) {
  PositionTargets targets;
  EXPECT_TRUE(targets.control(kNew, resting(100)));
  EXPECT_EQ(targets.target(), 100);
  EXPECT_TRUE(targets.acknowledges());
  EXPECT_FALSE(targets.control(kNew, resting(200))) << "no rise";
  EXPECT_EQ(targets.target(), 100);
  EXPECT_FALSE(targets.control(kIdle, resting(200)));
  EXPECT_FALSE(targets.acknowledges());
}

TEST(PositionTargets, WaitForTheOneUnderWayAndFollowIt) {
  PositionTargets targets;
  EXPECT_TRUE(targets.control(kNew, resting(100)));
  targets.control(kIdle, moving(0));
  EXPECT_FALSE(targets.control(kNew, moving(200)));
  EXPECT_EQ(targets.target(), 100);
  EXPECT_TRUE(targets.has_next());
  targets.control(kIdle, moving(0));
  EXPECT_TRUE(targets.acknowledges()) << "there is no room for a third";
  EXPECT_FALSE(targets.control(kNew, moving(300)));
  targets.control(kIdle, moving(0));
  EXPECT_TRUE(targets.arrive());
  EXPECT_EQ(targets.target(), 200) << "the third was not taken";
  EXPECT_FALSE(targets.acknowledges());
  EXPECT_FALSE(targets.arrive()) << "nothing waits any more";
}

TEST(PositionTargets, ReplaceEverythingWhenTheyAreToGoAtOnce) {
  PositionTargets targets;
  EXPECT_TRUE(targets.control(kNew, resting(100)));
  targets.control(kIdle, moving(0));
  EXPECT_FALSE(targets.control(kNew, moving(200)));
  targets.control(kIdle, moving(0));
  EXPECT_TRUE(targets.control(kNewAtOnce, moving(50)));
  EXPECT_EQ(targets.target(), 50);
  EXPECT_FALSE(targets.has_next());
}

TEST(PositionTargets, CountRelativeOnesFromTheLastThatWasTaken) {
  PositionTargets targets;
  EXPECT_TRUE(targets.control(kNew, resting(100)));
  targets.control(kIdle, moving(0));
  EXPECT_FALSE(targets.control(kNewRelative, moving(10)));
  EXPECT_TRUE(targets.arrive());
  EXPECT_EQ(targets.target(), 110);
}

TEST(PositionTargets, GoAtOnceWhereTheLastOneIsReached) {
  PositionTargets targets;
  PositionTargets::Seen arrived = moving(100);
  arrived.at_target = true;
  EXPECT_TRUE(targets.control(kNew, arrived));
}

TEST(PositionTargets, AreNotTakenByADriveThatDoesNotOperate) {
  PositionTargets targets;
  EXPECT_FALSE(targets.control(kNew, {.written = 100}));
  EXPECT_FALSE(targets.acknowledges());
  EXPECT_FALSE(targets.control(kNew, resting(100))) << "the rise was before it operated";
  targets.reset();
  EXPECT_TRUE(targets.control(kNew, resting(100)));
}

TEST(PositionTargets, DropWhatWaitsOnAChangeOfMode) {
  PositionTargets targets;
  EXPECT_TRUE(targets.control(kNew, resting(100)));
  targets.control(kIdle, moving(0));
  EXPECT_FALSE(targets.control(kNew, moving(200)));
  targets.drop_next();
  EXPECT_FALSE(targets.has_next());
  EXPECT_FALSE(targets.acknowledges());
}

}  // namespace
}  // namespace rmac::vdrive
