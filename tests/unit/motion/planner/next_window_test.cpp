// A window is no longer than a step of the planner can bear, whatever the path does.
#include "planner/next_window.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "time_law/window.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

/// A curve that bends to and fro every `pitch_mm`.
LaidPath zigzag(const PlannerModel& model, double pitch_mm, int bends) {
  Nurbs nurbs;
  nurbs.degree = 5;
  for (int i = 0; i < bends; ++i) nurbs.points.push_back({-40 + pitch_mm * i, i % 2 == 0 ? 0.2 : -0.2, 0});
  for (int i = 0; i < bends + 6; ++i) nurbs.knots.push_back(std::clamp(i - 5, 0, bends - 5));
  PathBuilder builder(model);
  builder.restart(std::vector<double>{-40, 0.2, 0}, {});
  Move move;
  move.id = 1;
  move.feed_mm_s = 200;
  move.geometry = NurbsGeometry{NurbsSpace::Tip, nurbs};
  LaidPath path(model.joints, model.period_s);
  path.add(builder.build(move).value());
  return path;
}

/// A rose of five leaves, within `tolerance_mm` of lines of `line_mm`: coarse ones, which take a tube.
LaidPath rose_in_lines(const PlannerModel& model, double line_mm, double tolerance_mm) {
  const auto corner = [](double angle) {
    const double r = 30 + 10 * std::cos(5 * angle);
    return ToolPose{{r * std::cos(angle), r * std::sin(angle), 0}, {0, 0, 1}};
  };
  PathBuilder builder(model);
  ToolPose from = corner(0);
  builder.restart(std::vector<double>{from.tip[0], from.tip[1], 0}, {});
  LaidPath path(model.joints, model.period_s);
  for (double angle = 0; angle < 6;) {
    angle += line_mm / std::hypot(30 + 10 * std::cos(5 * angle), 50 * std::sin(5 * angle));
    Move move;
    move.feed_mm_s = 200;
    move.tolerance_mm = tolerance_mm;
    move.geometry = LineGeometry{from, corner(angle)};
    path.add(builder.build(move).value());
    from = corner(angle);
  }
  return path;
}

std::size_t nodes_between(const LaidPath& path, double from, double to) {
  std::size_t nodes = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    for (const double local : path.segment(i)->nodes()) {
      const double s = path.start(i) + local;
      nodes += s >= from && s <= to ? 1U : 0U;
    }
  }
  return nodes;
}

TEST(NextWindow, EndsWhereThePathBendsTooOften) {
  const PlannerModel model = test::mill();
  LaidPath path = zigzag(model, 0.1, 700);
  const WindowEnd end = next_window_end(path, model.joints, {0, 0, 0}, kRampsAhead, 1, std::nullopt);
  EXPECT_GT(nodes_between(path, 0, path.end()), 2000U);
  EXPECT_LE(nodes_between(path, 0, end.s), 310U);
  EXPECT_GT(nodes_between(path, 0, end.s), 290U);
  EXPECT_FALSE(end.hard);
}

TEST(NextWindow, IsLongEnoughToStopInWhateverThePathDoes) {
  const PlannerModel model = test::mill();
  LaidPath path = zigzag(model, 0.1, 700);
  for (const double v : {20.0, 60.0, 100.0}) {
    const WindowEnd end = next_window_end(path, model.joints, {0, v, 0}, kRampsAhead, 1, std::nullopt);
    EXPECT_GE(end.s, std::min(3 * ramp_length(v, 1000, 10'000), path.end())) << v;
  }
}

TEST(NextWindow, OnASmoothPathHoldsAllItsRamps) {
  const PlannerModel model = test::mill();
  LaidPath path = zigzag(model, 10, 9);
  const WindowEnd end = next_window_end(path, model.joints, {0, 0, 0}, 1, 1, std::nullopt);
  EXPECT_GE(end.s, std::min(ramp_length(200, 1000, 10'000), path.end()));
}

TEST(NextWindow, IsGivenUpOnceItsWorkIsUsedUp) {
  const PlannerModel model = test::mill();
  LaidPath path = zigzag(model, 10, 9);
  const WindowEnd end = next_window_end(path, model.joints, {0, 0, 0}, kRampsAtOnce, 1, std::nullopt);
  const auto law = [&](long work_left) {
    return plan_window(path.view(), model.joints, {{0, 0, 0}, end.s, {}, nullptr, false, true, &work_left});
  };
  EXPECT_FALSE(law(100));
  EXPECT_TRUE(law(kMostWorkOnLaw));
}

class CoarseRose : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(CoarseRose, AreLaidByOnePartOfAFitAtATime) {
  const PlannerModel model = test::mill();
  LaidPath path = rose_in_lines(model, GetParam().first, GetParam().second);
  int parts = 0;
  for (WindowEnd end{0, false, 0, true}; end.in_work; ++parts) {
    ASSERT_LT(parts, 300) << "it has an end";
    const std::uint64_t before = path.work();
    end = next_window_end(path, model.joints, {0, 0, 0}, kRampsAhead, 1, std::nullopt);
    EXPECT_LE(path.work(), before + 1);
  }
  EXPECT_GT(parts, 5) << "several windows, each of several rounds";
  const double laid = path.end();
  const WindowEnd known = next_window_end(path, model.joints, {0, 0, 0}, kRampsAhead, 1, std::nullopt);
  EXPECT_FALSE(known.in_work);
  EXPECT_EQ(path.end(), laid) << "what is known takes no more";
}

INSTANTIATE_TEST_SUITE_P(Tubes, CoarseRose,
                         testing::Values(std::pair{1.0, 0.01}, std::pair{0.7, 0.003}, std::pair{0.5, 0.002}));

}  // namespace
}  // namespace rmac
