#include "gateway/requests/stop_mark.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

TEST(StopMark, OvertakesNothingBeforeAStop) {
  const StopMark mark;
  EXPECT_EQ(mark.overtaker(Effect::Starts, 0), nullptr);
  EXPECT_EQ(mark.overtaker(Effect::Queues, 0), nullptr);
}

TEST(StopMark, AStopOvertakesStartsAndMovesThatStandBeforeIt) {
  StopMark mark;
  mark.set(Effect::Stops, "StopNow of panel", 100);
  for (const Effect effect : {Effect::Starts, Effect::Queues}) {
    ASSERT_NE(mark.overtaker(effect, 99), nullptr);
    EXPECT_EQ(*mark.overtaker(effect, 99), "StopNow of panel");
    EXPECT_EQ(mark.overtaker(effect, 100), nullptr) << "what comes after the stop runs";
  }
  for (const Effect effect : {Effect::None, Effect::Holds, Effect::Stops})
    EXPECT_EQ(mark.overtaker(effect, 0), nullptr);
}

TEST(StopMark, AHoldOvertakesStartsAndLetsMovesBeQueued) {
  StopMark mark;
  mark.set(Effect::Holds, "FeedHold of panel", 100);
  EXPECT_NE(mark.overtaker(Effect::Starts, 99), nullptr);
  EXPECT_EQ(mark.overtaker(Effect::Queues, 99), nullptr);
}

TEST(StopMark, ALaterHoldDoesNotUnmarkWhatAStopOvertook) {
  StopMark mark;
  mark.set(Effect::Stops, "StopNow of panel", 100);
  mark.set(Effect::Holds, "FeedHold of cam-tool", 50);
  EXPECT_NE(mark.overtaker(Effect::Queues, 99), nullptr);
  EXPECT_EQ(*mark.overtaker(Effect::Starts, 99), "FeedHold of cam-tool") << "the last stop is named";
}

TEST(StopMark, WhatIsNoStopMarksNothing) {
  StopMark mark;
  for (const Effect effect : {Effect::None, Effect::Queues, Effect::Starts})
    mark.set(effect, "CycleStart of panel", 100);
  EXPECT_EQ(mark.overtaker(Effect::Starts, 0), nullptr);
}

}  // namespace
}  // namespace rmac::gateway
