#include "gateway/queue/way_back.hpp"

#include <gmock/gmock.h>

#include "unit/motion/planner/planner_bench.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

PathBuilder builder_at(double x, double y = 0) {
  PathBuilder builder(test::mill());
  builder.restart(std::vector<double>{x, y, 0}, {});
  return builder;
}

/// A line from 0 to 20 along X, begun and held at 12.
ProgramStep held_at_twelve() {
  const ToolPose start{{0, 0, 0}, {0, 0, 1}}, end{{20, 0, 0}, {0, 0, 1}};
  return {.what = Move{.id = 7, .geometry = LineGeometry{start, end}, .feed_mm_s = 40},
          .start = start,
          .start_joints = {0, 0, 0},
          .from_mm = 12};
}

TEST(WayBack, LeadsToWhereTheStepGoesOnAndThenOnIt) {
  PathBuilder builder = builder_at(12, 0.5);
  const auto rest = build_rest_of(builder, held_at_twelve());
  ASSERT_TRUE(rest) << rest.error().message;
  ASSERT_EQ(rest->size(), 2U);
  EXPECT_TRUE((*rest)[0].as_sent.way_back);
  EXPECT_NEAR((*rest)[0].segments.front()->length(), 0.5, 1e-9);
  EXPECT_EQ(std::get<Move>((*rest)[1].as_sent.what).id, 7);
  EXPECT_NEAR((*rest)[1].segments.front()->length(), 8, 1e-9) << "what was cut is not cut again";
  EXPECT_NEAR(builder.end_pose().tip[0], 20, 1e-12);
}

TEST(WayBack, IsLeftOutWhereTheToolStandsThere) {
  PathBuilder builder = builder_at(12);
  const auto rest = build_rest_of(builder, held_at_twelve());
  ASSERT_TRUE(rest) << rest.error().message;
  ASSERT_EQ(rest->size(), 1U);
  EXPECT_FALSE((*rest)[0].as_sent.way_back);
}

TEST(WayBack, LongerThanAMillimetreIsRefusedAndNothingBuilt) {
  PathBuilder builder = builder_at(12, 1.01);
  const auto rest = build_rest_of(builder, held_at_twelve());
  ASSERT_FALSE(rest);
  EXPECT_THAT(rest.error().message, HasSubstr("1.010 mm from where the program goes on, 12.0000"));
  EXPECT_NEAR(builder.end_pose().tip[0], 12, 1e-12);
}

TEST(WayBack, ToAToolChangeIsAllThereIs) {
  PathBuilder builder = builder_at(3, 0.25);
  ProgramStep change{.what = 4, .start = {{3, 0, 0}, {0, 0, 1}}, .start_joints = {3, 0, 0}};
  const auto rest = build_rest_of(builder, change);
  ASSERT_TRUE(rest) << rest.error().message;
  ASSERT_EQ(rest->size(), 1U);
  EXPECT_TRUE((*rest)[0].as_sent.way_back);
  EXPECT_NEAR(builder.end_pose().tip[1], 0, 1e-12);
}

}  // namespace
}  // namespace rmac::gateway
