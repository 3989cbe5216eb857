#include <gmock/gmock.h>

#include <numbers>
#include <random>

#include "unit/motion/curves/curve_checks.hpp"

namespace rmac::test {
namespace {

using std::numbers::pi;

/// A point of a rational B-spline by de Boor's recursion in extended precision: another way than the code under test.
std::vector<long double> de_boor(const Nurbs& nurbs, long double u) {
  const auto degree = static_cast<std::size_t>(nurbs.degree);
  std::size_t knot = degree;
  while (knot + 1 < nurbs.points.size() && nurbs.knots[knot + 1] <= static_cast<double>(u)) ++knot;
  std::vector<std::vector<long double>> d;
  for (std::size_t i = knot - degree; i <= knot; ++i) {
    const long double weight = nurbs.weights.empty() ? 1 : nurbs.weights[i];
    std::vector<long double> point;
    for (const double c : nurbs.points[i]) point.push_back(weight * c);
    point.push_back(weight);
    d.push_back(point);
  }
  for (std::size_t r = 1; r <= degree; ++r) {
    for (std::size_t j = degree; j >= r; --j) {
      const long double low = nurbs.knots[knot - degree + j];
      const long double high = nurbs.knots[knot + 1 + j - r];
      const long double share = (u - low) / (high - low);
      for (std::size_t c = 0; c < d[j].size(); ++c) d[j][c] = (1 - share) * d[j - 1][c] + share * d[j][c];
    }
  }
  std::vector<long double> point = d[degree];
  for (std::size_t c = 0; c + 1 < point.size(); ++c) point[c] /= point.back();
  point.pop_back();
  return point;
}

/// Length over [a, b] by Romberg's extrapolation of chord sums, over `coordinates` coordinates.
double chord_length(const Nurbs& nurbs, double a, double b, std::size_t coordinates) {
  constexpr int kLevels = 8;
  std::vector<long double> sums;
  for (int level = 0; level < kLevels; ++level) {
    const int count = 16 << level;
    long double sum = 0;
    auto last = de_boor(nurbs, a);
    for (int i = 1; i <= count; ++i) {
      // The last chord ends just before b, where de Boor's recursion would take the next span.
      const long double end = i == count ? std::nextafter(b, a) : a + (static_cast<long double>(b) - a) * i / count;
      const auto next = de_boor(nurbs, end);
      long double square = 0;
      for (std::size_t c = 0; c < coordinates; ++c) square += (next[c] - last[c]) * (next[c] - last[c]);
      sum += std::sqrt(square);
      last = next;
    }
    sums.push_back(sum);
  }
  long double factor = 4;
  for (int round = 1; round < kLevels; ++round, factor *= 4) {
    for (std::size_t i = sums.size() - 1; i >= static_cast<std::size_t>(round); --i) {
      sums[i] += (sums[i] - sums[i - 1]) / (factor - 1);
    }
  }
  return static_cast<double>(sums.back());
}

class NurbsCurves : public testing::Test {
 protected:
  double number() { return range_(random_); }

  /// A wavy curve along x: no cusps, uneven knots (some doubled or, for `corners`, of full multiplicity).
  Nurbs wave(int degree, std::size_t dimension, std::size_t count, bool rational, bool doubled = false) {
    Nurbs nurbs;
    nurbs.degree = degree;
    nurbs.dimension = dimension;
    for (std::size_t i = 0; i < count; ++i) {
      const double phase = 0.4 * static_cast<double>(i);
      std::vector<double> point{4 * static_cast<double>(i) + number(), 8 * std::sin(phase) + number(), 2 * number()};
      point.resize(dimension, 0.0);
      for (std::size_t c = 3; c < dimension; ++c) point[c] = 0.3 * number() + (c == 5 ? 1 : 0);
      nurbs.points.push_back(point);
      if (rational) nurbs.weights.push_back(1 + 0.5 * number());
    }
    const auto order = static_cast<std::size_t>(degree) + 1;
    nurbs.knots.assign(order, -3);
    double u = -3;
    for (std::size_t i = order; i < count; ++i) {
      const bool again = doubled && degree > 2 && i > order && i % 3 == 0;
      if (!again) u += 0.5 + 0.4 * number();
      nurbs.knots.push_back(u);
    }
    nurbs.knots.insert(nurbs.knots.end(), order, u + 0.7);
    return nurbs;
  }

  static ToolPose start_of(const Nurbs& nurbs) {
    const auto& p = nurbs.points.front();
    ToolPose pose{{p[0], p[1], p[2]}, {0, 0, 1}};
    if (p.size() == 6) {
      const double length = std::hypot(p[3], p[4], p[5]);
      pose.axis = {p[3] / length, p[4] / length, p[5] / length};
    }
    return pose;
  }

  static Curves curves_of(const Nurbs& nurbs, NurbsSpace space) {
    return built(NurbsGeometry{space, nurbs}, {start_of(nurbs), nurbs.points.front()});
  }

  std::mt19937 random_{23};
  std::uniform_real_distribution<double> range_{-1, 1};
};

/// A full circle of radius 10 about the origin as a rational quadratic (The NURBS Book, example 7.2: nine points).
Nurbs circle() {
  const double w = std::sqrt(0.5);
  return {2,
          3,
          {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4},
          {{10, 0, 0},
           {10, 10, 0},
           {0, 10, 0},
           {-10, 10, 0},
           {-10, 0, 0},
           {-10, -10, 0},
           {0, -10, 0},
           {10, -10, 0},
           {10, 0, 0}},
          {1, w, 1, w, 1, w, 1, w, 1}};
}

TEST_F(NurbsCurves, HaveUnitTangentAndTrueDerivatives) {
  for (int i = 0; i < 120; ++i) {
    const int degree = 1 + i % 9;
    const Nurbs nurbs =
        wave(degree, 3, static_cast<std::size_t>(degree) + 2 + static_cast<std::size_t>(i) % 12, i % 2 == 1, i % 4 > 1);
    for (const auto& curve : curves_of(nurbs, NurbsSpace::Tip)) {
      expect_sound(*curve, 1e-6);
      for (int k = 0; k <= 50; ++k) {
        CurvePoint point;
        curve->evaluate(curve->length() * k / 50, 1, 1, point);
        EXPECT_NEAR(size_of(point, 1, 0, 3), 1, 1e-14);
      }
    }
  }
}

TEST_F(NurbsCurves, HaveTheLengthThatChordsTendTo) {
  for (int i = 0; i < 24; ++i) {
    const int degree = 2 + i % 5;
    const Nurbs nurbs = wave(degree, 3, static_cast<std::size_t>(degree) + 4, i % 2 == 1);
    double wanted = 0;
    for (std::size_t k = 0; k + 1 < nurbs.knots.size(); ++k) {
      if (nurbs.knots[k + 1] > nurbs.knots[k]) wanted += chord_length(nurbs, nurbs.knots[k], nurbs.knots[k + 1], 3);
    }
    const auto curves = curves_of(nurbs, NurbsSpace::Tip);
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_NEAR(curves[0]->length(), wanted, 1e-11 * wanted) << "degree " << degree;
  }
}

TEST_F(NurbsCurves, LieOnTheCurveAtTheirArcLength) {
  for (int i = 0; i < 24; ++i) {
    const int degree = 2 + i % 6;
    const Nurbs nurbs = wave(degree, 3, static_cast<std::size_t>(degree) + 4, i % 2 == 1);
    const auto curves = curves_of(nurbs, NurbsSpace::Tip);
    ASSERT_EQ(curves.size(), 1U);
    double s = 0;
    for (std::size_t k = 0; k + 1 < nurbs.knots.size(); ++k) {
      const double low = nurbs.knots[k];
      const double high = nurbs.knots[k + 1];
      if (high == low) continue;
      const double u = low + 0.37 * (high - low);
      const double here = s + chord_length(nurbs, low, u, 3);
      const auto wanted = de_boor(nurbs, u);
      CurvePoint point;
      curves[0]->evaluate(here, 0, 1, point);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(point.d[0][c], static_cast<double>(wanted[c]), 1e-9);
      s += chord_length(nurbs, low, high, 3);
    }
  }
}

TEST_F(NurbsCurves, StepAtConstantFeed) {
  // Equal steps of arc length: what is walked between them, from positions alone, against what was asked for.
  for (int i = 0; i < 10; ++i) {
    const auto curves = curves_of(wave(3, 3, 12, i % 2 == 1), NurbsSpace::Tip);
    ASSERT_EQ(curves.size(), 1U);
    const Curve& curve = *curves[0];
    constexpr int kSteps = 400;
    constexpr int kChords = 64;
    const double step = curve.length() / kSteps;
    for (int k = 0; k < kSteps; ++k) {
      std::array<double, 2> walked{};  // with chords of single and double length
      CurvePoint last;
      CurvePoint last_even;
      curve.evaluate(step * k, 0, 1, last);
      last_even = last;
      const auto apart = [](const CurvePoint& a, const CurvePoint& b) {
        return std::hypot(a.d[0][0] - b.d[0][0], a.d[0][1] - b.d[0][1], a.d[0][2] - b.d[0][2]);
      };
      for (int j = 1; j <= kChords; ++j) {
        CurvePoint next;
        curve.evaluate(step * (k + static_cast<double>(j) / kChords), 0, 1, next);
        walked[0] += apart(next, last);
        last = next;
        if (j % 2 == 0) {
          walked[1] += apart(next, last_even);
          last_even = next;
        }
      }
      const double length = walked[0] + (walked[0] - walked[1]) / 3;
      EXPECT_NEAR(length / step, 1, 1e-8) << "step " << k << " of curve " << i;
    }
  }
}

TEST_F(NurbsCurves, DrawACircleExactly) {
  const auto curves = curves_of(circle(), NurbsSpace::Tip);
  ASSERT_EQ(curves.size(), 1U) << "tangents meet at the doubled knots";
  EXPECT_NEAR(curves[0]->length(), 20 * pi, 1e-11);
  for (int i = 0; i <= 1000; ++i) {
    const double s = curves[0]->length() * i / 1000;
    CurvePoint point;
    curves[0]->evaluate(s, 3, 1, point);
    EXPECT_NEAR(std::hypot(point.d[0][0], point.d[0][1]), 10, 1e-12);
    EXPECT_NEAR(point.d[0][0], 10 * std::cos(s / 10), 1e-10);
    EXPECT_NEAR(point.d[1][1], std::cos(s / 10), 1e-11);
    EXPECT_NEAR(size_of(point, 2, 0, 3), 0.1, 1e-13);
    EXPECT_NEAR(point.d[3][1], -0.01 * std::cos(s / 10), 1e-12);
  }
}

TEST_F(NurbsCurves, AreCutAtCorners) {
  // Three straight legs as a cubic with knots of full multiplicity; the second continues the first.
  Nurbs nurbs;
  const auto leg = [&](double x, double y) { nurbs.points.push_back({x, y, 0}); };
  for (const double x : {0., 1., 2., 3., 4., 5., 6.}) leg(x, 0);
  for (const double y : {1., 2., 3.}) leg(6, y);
  nurbs.knots = {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 3};
  const auto curves = curves_of(nurbs, NurbsSpace::Tip);
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_NEAR(curves[0]->length(), 6, 1e-14);
  EXPECT_NEAR(curves[1]->length(), 3, 1e-14);
  ASSERT_EQ(curves[0]->breaks().size(), 1U);
  EXPECT_NEAR(curves[0]->breaks()[0], 3, 1e-14);
}

TEST_F(NurbsCurves, OfDegreeOneArePolylines) {
  const Nurbs nurbs{1, 3, {0, 0, 1, 2, 3, 3}, {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {3, 9, 0}}, {}};
  const auto curves = curves_of(nurbs, NurbsSpace::Tip);
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_NEAR(curves[0]->length(), 3, 1e-14);
  EXPECT_NEAR(curves[1]->length(), 9, 1e-14);
}

TEST_F(NurbsCurves, BreakOnlyWhereTheThirdDerivativeMayJump) {
  const auto cubic = curves_of(wave(3, 3, 10, false), NurbsSpace::Tip);
  EXPECT_EQ(cubic.at(0)->breaks().size(), 6U);
  const auto quartic = curves_of(wave(4, 3, 10, false), NurbsSpace::Tip);
  EXPECT_TRUE(quartic.at(0)->breaks().empty());
}

TEST_F(NurbsCurves, TakeTheSideAskedForAtABreakThatIsMissedByRounding) {
  const auto curves = curves_of(wave(3, 3, 10, false), NurbsSpace::Tip);
  ASSERT_EQ(curves.size(), 1U);
  for (const double s : curves[0]->breaks()) {
    for (const int side : {-1, 1}) {
      CurvePoint at;
      curves[0]->evaluate(s, 3, side, at);
      for (const double toward : {0.0, 1e9}) {
        CurvePoint beside;
        curves[0]->evaluate(std::nextafter(s, toward), 3, side, beside);
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(beside.d[3][c], at.d[3][c], 1e-9 * size_of(at, 3, 0, 3));
      }
    }
  }
}

TEST_F(NurbsCurves, OfAnyDegreeUpTo25) {
  for (const int degree : {1, 2, 12, 25}) {
    Nurbs nurbs;
    nurbs.degree = degree;
    // A straight line with evenly spaced points: every degree gives the same points.
    for (int i = 0; i <= degree; ++i) nurbs.points.push_back({10.0 * i / degree, 5.0 * i / degree, 0});
    nurbs.knots.assign(static_cast<std::size_t>(degree) + 1, 0);
    nurbs.knots.resize(2 * nurbs.knots.size(), 1);
    const auto curves = curves_of(nurbs, NurbsSpace::Tip);
    ASSERT_EQ(curves.size(), 1U);
    CurvePoint point;
    curves[0]->evaluate(curves[0]->length() / 4, 3, 1, point);
    EXPECT_NEAR(point.d[0][0], 2.5, 1e-12);
    EXPECT_NEAR(point.d[0][1], 1.25, 1e-12);
    EXPECT_NEAR(size_of(point, 3, 0, 3), 0, 1e-9);
  }
}

TEST_F(NurbsCurves, HoldTheToolAxisInTipSpace) {
  const Nurbs nurbs{3, 3, {0, 0, 0, 0, 1, 1, 1, 1}, {{0, 0, 0}, {1, 2, 0}, {3, 2, 0}, {4, 0, 0}}, {}};
  const ToolPose start{{0, 0, 0}, {0.6, 0, 0.8}};
  const auto curves = built(NurbsGeometry{NurbsSpace::Tip, nurbs}, {start, {}});
  ASSERT_EQ(curves.size(), 1U);
  CurvePoint point;
  curves[0]->evaluate(curves[0]->length() / 3, 3, 1, point);
  EXPECT_EQ(curves[0]->dimension(), 6U);
  EXPECT_EQ(point.d[0][3], 0.6);
  EXPECT_EQ(point.d[0][5], 0.8);
  for (const std::size_t order : {1U, 2U, 3U}) EXPECT_EQ(size_of(point, order, 3, 6), 0);
}

TEST_F(NurbsCurves, TurnAUnitAxisInPoseSpace) {
  for (int i = 0; i < 40; ++i) {
    const Nurbs nurbs = wave(2 + i % 4, 6, 9, i % 2 == 1);
    const auto curves = curves_of(nurbs, NurbsSpace::Pose);
    ASSERT_EQ(curves.size(), 1U);
    expect_sound(*curves[0], 1e-6);
    for (int k = 0; k <= 50; ++k) {
      CurvePoint point;
      curves[0]->evaluate(curves[0]->length() * k / 50, 1, 1, point);
      EXPECT_NEAR(size_of(point, 0, 3, 6), 1, 1e-14);
      EXPECT_NEAR(size_of(point, 1, 0, 3), 1, 1e-14);
    }
  }
}

TEST_F(NurbsCurves, MeasureDegreesWhereTheTipRests) {
  const double w = std::sqrt(0.5);
  const Nurbs nurbs{2, 6, {0, 0, 0, 1, 1, 1}, {{1, 2, 3, 1, 0, 0}, {1, 2, 3, 1, 1, 0}, {1, 2, 3, 0, 1, 0}}, {1, w, 1}};
  const auto curves = curves_of(nurbs, NurbsSpace::Pose);
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_NEAR(curves[0]->length(), 90, 1e-10);
  expect_sound(*curves[0], 1e-6);
  CurvePoint point;
  curves[0]->evaluate(30, 0, 1, point);
  EXPECT_NEAR(point.d[0][4], 0.5, 1e-12);
}

TEST_F(NurbsCurves, RunInJointSpaceWithAllJointsInTheLength) {
  for (const std::size_t joints : {1U, 4U, 7U}) {
    Nurbs nurbs = wave(3, 7, 9, false);
    nurbs.dimension = joints;
    for (auto& point : nurbs.points) point.resize(joints);
    const auto curves = built(NurbsGeometry{NurbsSpace::Joint, nurbs}, {{}, nurbs.points.front()});
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_TRUE(curves[0]->in_joint_space());
    EXPECT_EQ(curves[0]->dimension(), joints);
    expect_sound(*curves[0], 1e-6);
    CurvePoint point;
    curves[0]->evaluate(curves[0]->length() / 2, 1, 1, point);
    EXPECT_NEAR(size_of(point, 1, 0, joints), 1, 1e-14);
  }
}

TEST_F(NurbsCurves, RunOverUnclampedKnots) {
  Nurbs nurbs = wave(3, 3, 9, false);
  for (std::size_t i = 0; i < nurbs.knots.size(); ++i) nurbs.knots[i] = static_cast<double>(i);
  const auto point = de_boor(nurbs, 3);
  const Vector tip{static_cast<double>(point[0]), static_cast<double>(point[1]), static_cast<double>(point[2])};
  const auto curves = built(NurbsGeometry{NurbsSpace::Tip, nurbs}, at(tip));
  ASSERT_EQ(curves.size(), 1U);
  expect_sound(*curves[0], 1e-6);
  double wanted = 0;
  for (int u = 3; u < 9; ++u) wanted += chord_length(nurbs, u, u + 1, 3);
  EXPECT_NEAR(curves[0]->length(), wanted, 1e-10);
}

TEST_F(NurbsCurves, KeepTheirDigitsFarFromTheOriginAndOnWideKnots) {
  Nurbs near = wave(3, 3, 10, true);
  Nurbs far = near;
  for (double& knot : far.knots) knot = 1e6 + 1e3 * knot;
  const auto a = curves_of(near, NurbsSpace::Tip);
  const auto b = curves_of(far, NurbsSpace::Tip);
  ASSERT_EQ(a.size(), 1U);
  ASSERT_EQ(b.size(), 1U);
  EXPECT_NEAR(a[0]->length(), b[0]->length(), 1e-7);
  for (auto& p : near.points) p[0] += 10000;
  const auto c = curves_of(near, NurbsSpace::Tip);
  ASSERT_EQ(c.size(), 1U);
  EXPECT_NEAR(a[0]->length(), c[0]->length(), 1e-9);
}

TEST_F(NurbsCurves, SurviveNearCusps) {
  for (const double gap : {1e-1, 1e-3, 1e-5}) {
    // A cubic whose legs cross; with the gap closed it has a cusp at u = 1/2.
    const Nurbs nurbs{3, 3, {0, 0, 0, 0, 1, 1, 1, 1}, {{0, 0, 0}, {10, 10, 0}, {gap, 10, 0}, {10, 0, 0}}, {}};
    const auto curves = curves_of(nurbs, NurbsSpace::Tip);
    ASSERT_EQ(curves.size(), 1U) << gap;
    EXPECT_NEAR(curves[0]->length(), chord_length(nurbs, 0, 1, 3), 1e-3);
    for (std::size_t i = 0; i + 1 < curves[0]->nodes().size(); ++i) {
      EXPECT_GE(curves[0]->nodes()[i + 1] - curves[0]->nodes()[i], 0.99e-5);
    }
    EXPECT_LT(curves[0]->nodes().size(), 500U) << gap;
  }
}

TEST_F(NurbsCurves, BeginWhereTheQueueEndsWithTheirOwnTangent) {
  const Nurbs nurbs = wave(3, 3, 10, true);
  const auto exact = curves_of(nurbs, NurbsSpace::Tip);
  ToolPose queue_end = start_of(nurbs);
  queue_end.tip[1] += 0.0009;
  const auto shifted = built(NurbsGeometry{NurbsSpace::Tip, nurbs}, {queue_end, {}});
  ASSERT_EQ(shifted.size(), 1U);
  CurvePoint a;
  CurvePoint b;
  shifted[0]->evaluate(0, 2, 1, a);
  exact.at(0)->evaluate(0, 2, 1, b);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(a.d[0][c], queue_end.tip[c], 1e-13);
    EXPECT_NEAR(a.d[1][c], b.d[1][c], 1e-12);
    EXPECT_NEAR(a.d[2][c], b.d[2][c], 1e-11);
  }
  shifted[0]->evaluate(shifted[0]->length(), 1, -1, a);
  exact[0]->evaluate(exact[0]->length(), 1, -1, b);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a.d[0][c], b.d[0][c], 1e-12);
}

TEST_F(NurbsCurves, HaveNodesSpacedByCurvature) {
  for (int i = 0; i < 10; ++i) {
    const auto curves = curves_of(wave(3, 3, 12, false), NurbsSpace::Tip);
    ASSERT_EQ(curves.size(), 1U);
    const auto nodes = curves[0]->nodes();
    EXPECT_GE(nodes.size(), 4 * (curves[0]->breaks().size() + 1));
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      const double step = nodes[k + 1] - nodes[k];
      CurvePoint a;
      CurvePoint b;
      curves[0]->evaluate(nodes[k], 2, 1, a);
      curves[0]->evaluate(nodes[k + 1], 2, -1, b);
      const double one = size_of(a, 2, 0, 3);
      const double two = size_of(b, 2, 0, 3);
      if (step < 2e-3) continue;
      EXPECT_LE(std::max(one, two) * step, 0.1);
      EXPECT_TRUE(std::abs(one - two) <= 0.2 * std::max(one, two) || std::abs(one - two) * step <= 0.006);
    }
  }
}

}  // namespace
}  // namespace rmac::test
