#include "gateway/queue/built_move.hpp"

#include <gtest/gtest.h>

#include "unit/motion/planner/planner_bench.hpp"

namespace rmac::gateway {
namespace {

Move to(std::int64_t id, double x) {
  return {.id = id, .geometry = PathTargetGeometry{{{x, 0, 0}, {0, 0, 1}}}, .feed_mm_s = 50};
}

TEST(BuildMoves, BuildsEachBehindTheOneBefore) {
  PathBuilder builder(test::mill());
  builder.restart(std::vector<double>(3, 0.0), {});
  const Move first = to(1, 5), second = to(1, 8);
  const auto built = build_moves(builder, {{&first, {true, false}}, {&second, {false, true}}});
  ASSERT_TRUE(built) << built.error().message;
  ASSERT_EQ(built->size(), 2U);
  EXPECT_EQ((*built)[1].as_sent.start.tip[0], 5);
  EXPECT_TRUE((*built)[0].part.first);
  EXPECT_TRUE((*built)[1].part.last);
  EXPECT_NEAR((*built)[1].segments.front()->length(), 3, 1e-9);
  EXPECT_EQ(builder.end_pose().tip[0], 8);
}

TEST(BuildMoves, LeavesTheBuilderWhereItStoodWhenALaterPartIsRefused) {
  PathBuilder builder(test::mill());
  builder.restart(std::vector<double>(3, 0.0), {});
  const Move fine = to(1, 5), out_of_travel = to(1, 500);
  EXPECT_FALSE(build_moves(builder, {{&fine, {}}, {&out_of_travel, {}}}));
  EXPECT_EQ(builder.end_pose().tip[0], 0) << "the first part would be a move that nobody queued";
  EXPECT_FALSE(build_moves(builder, {{&out_of_travel, {}}}));
  EXPECT_EQ(builder.end_pose().tip[0], 0);
}

}  // namespace
}  // namespace rmac::gateway
