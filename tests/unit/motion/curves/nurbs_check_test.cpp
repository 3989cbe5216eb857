#include <gmock/gmock.h>

#include <limits>
#include <random>

#include "unit/motion/curves/curve_checks.hpp"

namespace rmac::test {
namespace {

using testing::HasSubstr;

/// A sound cubic, to be spoilt.
Nurbs sound_cubic() {
  return {3, 3, {0, 0, 0, 0, 1, 2, 2, 2, 2}, {{0, 0, 0}, {1, 2, 0}, {3, 2, 0}, {4, 0, 0}, {6, 1, 0}}, {}};
}

std::string refusal_of(const Nurbs& nurbs, NurbsSpace space = NurbsSpace::Tip) {
  return refusal(NurbsGeometry{space, nurbs}, at({0, 0, 0}));
}

TEST(Nurbs, IsRefusedInTheWrongShape) {
  Nurbs nurbs = sound_cubic();
  nurbs.degree = 0;
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("has degree 0; 1 to 25 are possible"));
  nurbs.degree = 26;
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("has degree 26"));
  nurbs = sound_cubic();
  nurbs.dimension = 2;
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("2 coordinates a point; a tip curve has x y z, here 3"));
  EXPECT_THAT(refusal_of(sound_cubic(), NurbsSpace::Pose), HasSubstr("a pose curve has x y z i j k, here 6"));
  EXPECT_THAT(refusal_of(sound_cubic(), NurbsSpace::Joint), HasSubstr("a joint curve has one a joint, here 0"));
  nurbs = sound_cubic();
  nurbs.points.resize(3);
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("has 3 points; degree 3 needs at least 4"));
  nurbs = sound_cubic();
  nurbs.points[2].pop_back();
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("point 2 has 2 coordinates instead of 3"));
  nurbs = sound_cubic();
  nurbs.weights = {1, 1};
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("has 2 weights for 5 points"));
}

TEST(Nurbs, IsRefusedWithBadKnots) {
  Nurbs nurbs = sound_cubic();
  nurbs.knots.pop_back();
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("has 8 knots; 5 points of degree 3 need 9"));
  nurbs = sound_cubic();
  nurbs.knots[4] = 2.5;
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("knot 5 (2) is less than knot 4 (2.5); knots must not decrease"));
  nurbs.knots[4] = kNan;
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("knot 4 is not a finite number"));
  nurbs.knots.assign(9, 1);
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("leave no range"));
  nurbs = sound_cubic();
  nurbs.knots[4] = 1e-14;
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("too little for their range"));
  nurbs = sound_cubic();
  nurbs.knots[4] = 0;
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("knot 4 (0) occurs more than 4 times"));
  const Nurbs apart{1, 3, {0, 0, 1, 1, 2, 2}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {}};
  EXPECT_THAT(refusal_of(apart), HasSubstr("would come apart"));
}

TEST(Nurbs, IsRefusedWithBadNumbers) {
  Nurbs nurbs = sound_cubic();
  nurbs.points[3][1] = kNan;
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("point 3 holds a number that is not finite"));
  nurbs.points[3][1] = 1e300;
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("point 3 (1e+300) lies further than 1e+07 away"));
  nurbs = sound_cubic();
  nurbs.weights = {1, 1, 0, 1, 1};
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("weight 2 (0) is not a positive number"));
  nurbs.weights[2] = -1;
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("weight 2 (-1)"));
  nurbs.weights[2] = kNan;
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("weight 2 (nan)"));
  nurbs.weights[2] = 1e12;
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("weights differ by the factor 1e+12"));
}

TEST(Nurbs, HasNoCurveWhereAllOfItsPointsAreOne) {
  Nurbs nurbs = sound_cubic();
  nurbs.points.assign(5, {0, 0, 0});
  const auto curves = make_curves(move_of(NurbsGeometry{NurbsSpace::Tip, nurbs}), at({0, 0, 0}));
  ASSERT_TRUE(curves) << curves.error().message;
  EXPECT_TRUE(curves->empty());
}

TEST(Nurbs, PassesOverASpanOfWhichAllPointsAreOne) {
  const auto corner =
      make_curves(move_of(NurbsGeometry{NurbsSpace::Tip,
                                        {1, 3, {0, 0, 1, 2, 3, 3}, {{0, 0, 0}, {3, 0, 0}, {3, 0, 0}, {3, 9, 0}}, {}}}),
                  at({0, 0, 0}));
  ASSERT_TRUE(corner) << corner.error().message;
  double length = 0;
  for (const auto& curve : *corner) length += curve->length();
  EXPECT_NEAR(length, 12, 1e-9);
}

TEST(Nurbs, IsRefusedWithoutDirection) {
  Nurbs nurbs = sound_cubic();
  nurbs.points[1] = nurbs.points[0];
  EXPECT_THAT(refusal_of(nurbs), HasSubstr("stands still at parameter 0 "));
  const Nurbs cusp{3, 3, {2, 2, 2, 2, 5, 5, 5, 5}, {{0, 0, 0}, {10, 10, 0}, {0, 10, 0}, {10, 0, 0}}, {}};
  EXPECT_THAT(refusal_of(cusp), HasSubstr("stands still at parameter 3.5 "));
}

TEST(Nurbs, IsRefusedAtCuspsBetweenRoundParameters) {
  // The derivative vanishes at u = 1/3: x' = (u - 1/3)(…), y' likewise, as a cubic Bézier curve of x = y² kind.
  const double z = 1.0 / 3;
  // (u - z)², (u - z)³ in Bernstein form of degree 3.
  const auto square = [&](double i) { return z * z - 2 * z * i / 3 + (i > 1 ? (i - 1) * i / 6 : 0); };
  const auto cube = [&](double i) {
    return -z * z * z + 3 * z * z * i / 3 - 3 * z * (i > 1 ? (i - 1) * i / 6 : 0) + (i > 2 ? 1 : 0);
  };
  Nurbs nurbs{3, 3, {0, 0, 0, 0, 1, 1, 1, 1}, {}, {}};
  for (const double i : {0., 1., 2., 3.}) nurbs.points.push_back({square(i), cube(i), 0});
  EXPECT_THAT(refusal(NurbsGeometry{NurbsSpace::Tip, nurbs}, at({square(0), cube(0), 0})),
              HasSubstr("stands still at parameter 0.333333"));
}

TEST(Nurbs, IsRefusedWhenTheAxisVanishes) {
  const Nurbs nurbs{1, 6, {0, 0, 1, 1}, {{0, 0, 0, 0, 0, 1}, {10, 0, 0, 0, 0, -1.7}}, {}};
  EXPECT_THAT(refusal_of(nurbs, NurbsSpace::Pose), HasSubstr("shrinks to nothing near parameter 0.37037"));
  const Nurbs none{1, 6, {0, 0, 1, 1}, {{0, 0, 0, 0, 0, 0}, {10, 0, 0, 0, 0, 1}}, {}};
  EXPECT_THAT(refusal_of(none, NurbsSpace::Pose), HasSubstr("shrinks to nothing near parameter"));
}

TEST(Nurbs, IsRefusedWhenItStartsElsewhere) {
  EXPECT_THAT(refusal(NurbsGeometry{NurbsSpace::Tip, sound_cubic()}, at({0, 0.003, 0})),
              HasSubstr("starts 0.003 mm from where the queue ends (0, 0.003, 0)"));
  const Nurbs pose{1, 6, {0, 0, 1, 1}, {{0, 0, 0, 0, 1e-5, 1}, {10, 0, 0, 0, 0, 1}}, {}};
  EXPECT_THAT(refusal_of(pose, NurbsSpace::Pose), HasSubstr("a tool axis 1e-05 from"));
  const Nurbs joints{1, 2, {0, 0, 1, 1}, {{0, 7}, {10, 0}}, {}};
  const std::vector<double> end{0, 6.5};
  EXPECT_THAT(refusal(NurbsGeometry{NurbsSpace::Joint, joints}, {{}, end}),
              HasSubstr("joint 1 at 7, the queue ends with it at 6.5, 0.5 away"));
}

TEST(Nurbs, IsEitherRefusedOrKeepsItsPromisesHoweverWild) {
  std::mt19937 random(99);
  std::uniform_real_distribution<double> number(-1, 1);
  int accepted = 0;
  for (int i = 0; i < 400; ++i) {
    Nurbs nurbs;
    nurbs.degree = 1 + static_cast<int>(random() % 7);
    const auto order = static_cast<std::size_t>(nurbs.degree) + 1;
    const std::size_t count = order + random() % 6;
    for (std::size_t k = 0; k < count; ++k) {
      // Coordinates of all sizes, and points that repeat.
      const double size = std::pow(10.0, 4 * number(random));
      if (k > 0 && random() % 8 == 0) {
        nurbs.points.push_back(nurbs.points.back());
      } else {
        nurbs.points.push_back({size * number(random), size * number(random), random() % 2 == 0 ? 0 : number(random)});
      }
      if (i % 2 == 0) nurbs.weights.push_back(std::pow(10.0, 3 * number(random)));
    }
    nurbs.points.front() = {0, 0, 0};
    double u = 0;
    nurbs.knots.assign(order, u);
    for (std::size_t k = order; k < count; ++k) {
      if (random() % 3 != 0) u += std::pow(10.0, 3 * number(random));
      nurbs.knots.push_back(u);
    }
    nurbs.knots.insert(nurbs.knots.end(), order, u + 1);
    const auto curves = make_curves(move_of(NurbsGeometry{NurbsSpace::Tip, nurbs}), at({0, 0, 0}));
    if (!curves) {
      EXPECT_FALSE(curves.error().message.empty());
      continue;
    }
    ++accepted;
    for (const auto& curve : *curves) {
      CurvePoint last;
      curve->evaluate(0, 3, 1, last);
      for (int k = 0; k <= 200; ++k) {
        CurvePoint point;
        curve->evaluate(curve->length() * k / 200, 3, 1, point);
        ASSERT_NEAR(size_of(point, 1, 0, 3), 1, 1e-12) << "curve " << i;
        for (std::size_t order_of = 0; order_of <= 3; ++order_of) {
          ASSERT_TRUE(std::isfinite(size_of(point, order_of, 0, 3))) << "curve " << i;
        }
        // A chord is never longer than its arc.
        const double chord =
            std::hypot(point.d[0][0] - last.d[0][0], point.d[0][1] - last.d[0][1], point.d[0][2] - last.d[0][2]);
        ASSERT_LE(chord, curve->length() / 200 * (1 + 1e-8) + 1e-9) << "curve " << i;
        last = point;
      }
    }
  }
  EXPECT_GT(accepted, 100) << "too few curves were sound to show anything";
}

}  // namespace
}  // namespace rmac::test
