// What is left of a curve that is cut: its nodes lead the planner's grid, so the cut may not leave one hardly off an
// end.
#include "path/trimmed_curve.hpp"

#include <random>

#include "unit/motion/curves/curve_checks.hpp"

namespace rmac::test {
namespace {

std::shared_ptr<const Curve> wave(std::mt19937& random) {
  std::uniform_real_distribution<double> aside(-3, 3);
  NurbsGeometry geometry;
  geometry.curve.degree = 3;
  geometry.curve.dimension = 3;
  for (int i = 0; i < 12; ++i) geometry.curve.points.push_back({4.0 * i, i == 0 ? 0 : aside(random), 0});
  geometry.curve.knots.assign(4, 0);
  for (int i = 1; i < 9; ++i) geometry.curve.knots.push_back(i);
  geometry.curve.knots.insert(geometry.curve.knots.end(), 4, 9);
  geometry.space = NurbsSpace::Tip;
  return std::move(built(geometry, at({0, 0, 0})).front());
}

TEST(TrimmedCurve, HasNoNodeHardlyOffItsEndsWhereverItIsCut) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> decade(-9, -1);
  for (int i = 0; i < 200; ++i) {
    const auto curve = wave(random);
    const auto nodes = curve->nodes();
    ASSERT_GT(nodes.size(), 8U);
    const double begin = nodes[2] - std::pow(10, decade(random)), end = nodes[6] + std::pow(10, decade(random));
    for (const Direction direction : {Direction::Forward, Direction::Backward}) {
      const TrimmedCurve part(curve, begin, end, direction);
      const auto left = part.nodes();
      ASSERT_GE(left.size(), 3U);
      EXPECT_EQ(left.front(), 0);
      EXPECT_EQ(left.back(), part.length());
      EXPECT_TRUE(std::is_sorted(left.begin(), left.end()));
      const std::size_t last = left.size() - 1;
      EXPECT_GE(left[1] - left[0], 0.2 * (left[2] - left[1]));
      EXPECT_GE(left[last] - left[last - 1], 0.2 * (left[last - 1] - left[last - 2]));
      for (std::size_t k = 1; k < last; ++k) {
        const double there = direction == Direction::Forward ? begin + left[k] : end - left[k];
        const auto same = [&](double node) { return std::abs(node - there) < 1e-12 * (1 + there); };
        EXPECT_TRUE(std::any_of(nodes.begin(), nodes.end(), same)) << "a node that the curve does not have";
      }
    }
  }
}

}  // namespace
}  // namespace rmac::test
