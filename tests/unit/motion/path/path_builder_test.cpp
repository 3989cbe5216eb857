#include "rmac/motion/path_builder.hpp"

#include <gtest/gtest.h>

#include "rmac/motion/move_name.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

using test::kUp;
using test::mill;
using test::PlannerBench;

TEST(PathBuilder, RefusesTravelBeyondALimitNamingJointAmountAndPlace) {
  PlannerBench bench(mill());
  Move move;
  move.id = 7;
  move.feed_mm_s = 30;
  move.geometry = LineGeometry{{{0, 0, 0}, kUp}, {{0, 52.5, 0}, kUp}};
  const auto refused = bench.queue(move);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::TravelLimit);
  EXPECT_EQ(refused.error().message,
            "move 7 takes joint Y to 52.5000 mm, 2.5000 mm beyond its limit of 50.0000 mm, 52.5000 mm along the move; "
            "nothing was queued");
  // A jog has no number of a client.
  move.id = kPositioningMoveId;
  EXPECT_TRUE(bench.queue(move).error().message.starts_with("this move takes joint Y to 52.5000 mm"));
  // The queue's end is where it was: the next move starts from there.
  move.geometry = LineGeometry{{{0, 0, 0}, kUp}, {{0, 10, 0}, kUp}};
  EXPECT_TRUE(bench.queue(move));
}

TEST(PathBuilder, FindsTheBulgeOfAnArcBetweenItsEnds) {
  PlannerBench bench(mill());
  Move move;
  move.feed_mm_s = 30;
  move.geometry = PathTargetGeometry{{{45, -10, 0}, kUp}};
  ASSERT_TRUE(bench.queue(move));
  ArcGeometry arc;
  arc.center = {45, 0, 0};
  arc.start = {{45, -10, 0}, kUp};
  arc.end = {{45, 10, 0}, kUp};
  move.geometry = arc;
  const auto refused = bench.queue(move);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("joint X"), std::string::npos) << refused.error().message;
}

TEST(PathBuilder, RefusesAFeedOfZero) {
  PlannerBench bench(mill());
  Move move;
  move.id = 3;
  move.geometry = LineGeometry{{{0, 0, 0}, kUp}, {{1, 0, 0}, kUp}};
  const auto refused = bench.queue(move);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "move 3: the feed is 0; set one above 0 mm/min with SetFeedrate");
}

}  // namespace
}  // namespace rmac
