#include "time_law/law_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

/// A path of two lines, 10 mm and 30 mm long.
class LawGrid : public testing::Test {
 protected:
  LawGrid() {
    PathBuilder builder(test::mill());
    for (const double x : {10.0, 40.0}) {
      Move move;
      move.feed_mm_s = 50;
      move.geometry = LineGeometry{builder.end_pose(), {{x, 0, 0}, {0, 0, 1}}};
      for (auto& segment : *builder.build(move)) segments_.push_back(segment);
    }
  }
  [[nodiscard]] std::vector<double> grid(const GridEnd& begin, const GridEnd& end, double coarsest) const {
    return law_grid({segments_, starts_}, begin, end, coarsest);
  }

  PathSegments segments_;
  std::vector<double> starts_{0, 10};
};

TEST_F(LawGrid, HoldsItsEndsAndTheBordersOfSegments) {
  const auto nodes = grid({1, 0, 0.5}, {39, 40, 0.5}, 3);
  EXPECT_EQ(nodes.front(), 1);
  EXPECT_EQ(nodes.back(), 39);
  EXPECT_NE(std::find(nodes.begin(), nodes.end(), 10.0), nodes.end());
  EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end()));
}

TEST_F(LawGrid, IsFineAtItsEndsAndGrowsWithTheDistanceFromThemUpToTheCoarsestStep) {
  const auto nodes = grid({0, 0, 0.01}, {40, 40, 0.02}, 2);
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const double step = nodes[i + 1] - nodes[i];
    EXPECT_LE(step, 2 + 1e-12);
    EXPECT_LE(step, 0.01 + 0.35 * nodes[i] + 1e-12) << "at " << nodes[i];
    EXPECT_LE(step, 0.02 + 0.35 * (40 - nodes[i]) + 1e-12) << "at " << nodes[i];
  }
  EXPECT_GT(nodes[nodes.size() / 2] - nodes[nodes.size() / 2 - 1], 1.9) << "and no finer than it must be";
}

TEST_F(LawGrid, LeavesNoSliverBeforeABorder) {
  const auto nodes = grid({0, 0, 3}, {40, 40, 3}, 3);
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    EXPECT_GT(nodes[i + 1] - nodes[i], 0.49 * (nodes[i] - nodes[i - 1])) << "at " << nodes[i];
  }
}

TEST_F(LawGrid, OfAShortWayHasEnoughNodesForALaw) {
  EXPECT_GE(grid({1, 1, 5}, {1.5, 1.5, 5}, 5).size(), 6U);
}

}  // namespace
}  // namespace rmac
