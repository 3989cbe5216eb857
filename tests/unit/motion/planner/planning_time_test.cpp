#include "planner/planning_time.hpp"

#include <gtest/gtest.h>

#include "rmac/motion/planner.hpp"

namespace rmac {
namespace {

TEST(PlanningTime, LeavesTwoCyclesAtFirst) {
  EXPECT_EQ(PlanningTime().lead(), 2);
}

TEST(PlanningTime, LeavesAsLongAsTheLastPlanTookBesideTheTwo) {
  PlanningTime time;
  time.begin(100);
  time.learn({.cycle = 111});
  EXPECT_EQ(time.lead(), 2 + 10);
}

TEST(PlanningTime, DoesNotChangeWhileNoPlanIsMade) {
  PlanningTime time;
  time.begin(100);
  time.learn({.cycle = 111});
  time.learn({.cycle = 500});
  EXPECT_EQ(time.lead(), 2 + 10);
}

TEST(PlanningTime, LearnsNothingFromWhatNoPlanCameOf) {
  PlanningTime time;
  time.begin(100);
  time.learn({.cycle = 111});
  for (std::int64_t cycle = 200; cycle < 220; ++cycle) {
    time.begin(cycle);
    time.withdraw();
    time.learn({.cycle = cycle + 1});
  }
  EXPECT_EQ(time.lead(), 2 + 10);
}

TEST(PlanningTime, ForgetsALongOneBitByBit) {
  PlanningTime time;
  time.begin(100);
  time.learn({.cycle = 111});
  time.begin(200);
  time.learn({.cycle = 201});
  EXPECT_EQ(time.lead(), 2 + 9);
  time.begin(300);
  time.learn({.cycle = 301});
  EXPECT_EQ(time.lead(), 2 + 9) << "8.1 is not yet 8";
  time.begin(400);
  time.learn({.cycle = 401});
  EXPECT_EQ(time.lead(), 2 + 8);
}

TEST(PlanningTime, LeavesMoreThanTwiceAsLongOnceForEachRefusedPlan) {
  PlanningTime time;
  time.begin(0);
  time.learn({.cycle = 5});
  EXPECT_EQ(time.lead(), 2 + 4);
  time.learn({.cycle = 6, .last_refused = 3});
  EXPECT_EQ(time.lead(), 2 + 9);
  time.learn({.cycle = 7, .last_refused = 3});
  EXPECT_EQ(time.lead(), 2 + 9) << "the same refusal";
  time.learn({.cycle = 8, .last_refused = 4});
  EXPECT_EQ(time.lead(), 2 + 19);
}

TEST(PlanningTime, LeavesAtMost64CyclesBesideTheTwo) {
  PlanningTime time;
  time.begin(0);
  time.learn({.cycle = 10000});
  EXPECT_EQ(time.lead(), 2 + 64);
  time.learn({.cycle = 10001, .last_refused = 1});
  EXPECT_EQ(time.lead(), 2 + 64);
}

}  // namespace
}  // namespace rmac
