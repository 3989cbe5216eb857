#include "planner/planning_time.hpp"

#include <gtest/gtest.h>

namespace rmac {
namespace {

TEST(PlanningTime, LeavesTwoCyclesAtFirst) {
  EXPECT_EQ(PlanningTime().lead(), 2);
}

TEST(PlanningTime, LeavesAsLongAsThePlanBeforeTookAndForgetsItSlowly) {
  PlanningTime time;
  time.began(100);
  time.heard({.cycle = 111});
  EXPECT_EQ(time.lead(), 2 + 10);
  time.heard({.cycle = 500});
  EXPECT_EQ(time.lead(), 2 + 10) << "no plan was made";
  time.began(500);
  time.heard({.cycle = 501});
  EXPECT_EQ(time.lead(), 2 + 9);
}

TEST(PlanningTime, LeavesTwiceAsLongOnceForEachPlanThatCameTooLate) {
  PlanningTime time;
  time.began(0);
  time.heard({.cycle = 5, .last_refused = 0});
  EXPECT_EQ(time.lead(), 2 + 4);
  time.heard({.cycle = 6, .last_refused = 3});
  EXPECT_EQ(time.lead(), 2 + 9);
  time.heard({.cycle = 7, .last_refused = 3});
  EXPECT_EQ(time.lead(), 2 + 9);
}

TEST(PlanningTime, LeavesNoMoreThan64CyclesBesideTheTwo) {
  PlanningTime time;
  time.began(0);
  time.heard({.cycle = 10000});
  EXPECT_EQ(time.lead(), 2 + 64);
}

}  // namespace
}  // namespace rmac
