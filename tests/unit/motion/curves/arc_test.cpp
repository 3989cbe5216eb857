#include <gmock/gmock.h>

#include <limits>
#include <numbers>
#include <random>

#include "unit/motion/curves/shapes.hpp"

namespace rmac::test {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

using Arc = Shapes;

/// A point of the cylinder of this radius about an axis; `angle` counts about it.
Vector on_cylinder(const Vector& center, const Vector& normal, double radius, double angle, double height) {
  const double lean = std::hypot(normal[2], normal[0]);
  const Vector x{normal[2] / lean, 0, -normal[0] / lean};
  const Vector y{normal[1] * x[2] - normal[2] * x[1], normal[2] * x[0] - normal[0] * x[2],
                 normal[0] * x[1] - normal[1] * x[0]};
  Vector p{};
  for (std::size_t c = 0; c < 3; ++c) {
    p[c] = center[c] + height * normal[c] + radius * (std::cos(angle) * x[c] + std::sin(angle) * y[c]);
  }
  return p;
}

TEST_F(Arc, KeepsRadiusPlaneAndSense) {
  for (int i = 0; i < 300; ++i) {
    const Vector center = vector();
    const Vector normal = axis();
    const double radius = 0.05 + 100 * std::abs(number());
    const double height = 10 * number();
    const auto on_circle = [&](double angle) { return on_cylinder(center, normal, radius, angle, height); };
    const double from = pi * number();
    const double sweep = 0.05 + 3.1 * (1 + number());
    const int rotation = i % 2 == 0 ? 1 : -1;
    const ToolPose start{on_circle(from), axis()};
    const ToolPose end{on_circle(from + rotation * sweep), axis()};
    const auto curves = built(ArcGeometry{center, normal, rotation, false, start, end}, {start, {}});
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_NEAR(curves[0]->length(), radius * sweep, 1e-9);
    expect_ends(*curves[0], start, end);
    expect_steady(*curves[0]);
    expect_sound(*curves[0], 1e-8);
    for (int k = 0; k <= 20; ++k) {
      CurvePoint point;
      curves[0]->evaluate(curves[0]->length() * k / 20, 0, 1, point);
      const Vector wanted = on_circle(from + rotation * sweep * k / 20);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(point.d[0][c], wanted[c], 1e-9);
    }
  }
}

TEST_F(Arc, RunsAllAroundWhenClosed) {
  const ToolPose start{{12, 0, 3}, {0, 0, 1}};
  const auto curves = built(ArcGeometry{{2, 0, 0}, {0, 0, 2}, -1, true, start, start}, {start, {}});
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_NEAR(curves[0]->length(), 20 * pi, 1e-12);
  CurvePoint quarter;
  curves[0]->evaluate(5 * pi, 0, 1, quarter);
  EXPECT_NEAR(quarter.d[0][0], 2, 1e-13);
  EXPECT_NEAR(quarter.d[0][1], -10, 1e-13);
  EXPECT_NEAR(quarter.d[0][2], 3, 1e-13);
  expect_ends(*curves[0], start, start);
}

TEST_F(Arc, EndsExactlyWhereAskedThoughItsCentreIsRounded) {
  const ToolPose start{{10, 0, 0}, {0, 0, 1}};
  const ToolPose end{{0, 10.0008, 0.0005}, {0, 0, 1}};
  const auto curves = built(ArcGeometry{{0, 0, 0}, {0, 0, 1}, 1, false, start, end}, {start, {}});
  ASSERT_EQ(curves.size(), 1U);
  expect_ends(*curves[0], start, end);
  expect_steady(*curves[0]);
}

TEST_F(Arc, IsRefusedWithAmountsWhenItIsASpiral) {
  const ToolPose start{{10, 0, 0}, {0, 0, 1}};
  const auto with_end = [&](const Vector& end) {
    return refusal(ArcGeometry{{0, 0, 0}, {0, 0, 1}, 1, false, start, {end, {0, 0, 1}}}, {start, {}});
  };
  EXPECT_THAT(with_end({0, 10.25, 0}), HasSubstr("radius 10 mm about its centre and its end 10.25 mm"));
  EXPECT_THAT(with_end({0, 10.25, 5}), HasSubstr("radius 10 mm about its centre and its end 10.25 mm"));
  EXPECT_THAT(with_end({10.0000, 0.0005, 0.5}), HasSubstr("coincide (0.0005 mm apart, seen along its axis)"));
  // Nearly all around with a radius that changes: no circle through both has its centre there.
  EXPECT_THAT(with_end({10.0009, -0.002, 0}), HasSubstr("fit no circle about its centre"));
}

TEST_F(Arc, WhoseEndsMeetIsNoFullTurnUnlessClosed) {
  const ToolPose start{{10, 0, 0}, {0, 0, 1}};
  const auto with_end = [&](const Vector& end, int rotation) {
    return built(ArcGeometry{{0, 0, 0}, {0, 0, 1}, rotation, false, start, {end, {0, 0, 1}}}, {start, {}});
  };
  for (const int rotation : {1, -1}) {
    EXPECT_TRUE(with_end(start.tip, rotation).empty());
    for (const double off_mm : {0.0005, -0.0005}) {
      // Rounded to behind the start, it would nearly be a full turn.
      const auto curves = with_end({10, off_mm, 0}, rotation);
      ASSERT_EQ(curves.size(), 1U);
      EXPECT_NEAR(curves[0]->length(), 0.0005, 1e-9);
      expect_ends(*curves[0], start, {{10, off_mm, 0}, {0, 0, 1}});
    }
  }
  const auto around = with_end({10 * std::cos(0.001), -10 * std::sin(0.001), 0}, 1);
  ASSERT_EQ(around.size(), 1U);
  EXPECT_NEAR(around[0]->length(), 20 * std::numbers::pi - 0.01, 1e-6) << "the sweep says so";
  // Ends that meet make no sense of an arc that has none.
  EXPECT_THAT(refusal(ArcGeometry{{0, 0, 0}, {0, 0, 0}, 1, false, start, start}, {start, {}}),
              HasSubstr("normal has no length"));
}

TEST_F(Arc, IsTakenWithCoordinatesRoundedToAMicrometre) {
  const auto rounded = [](Vector v) {
    for (double& c : v) c = std::round(c * 1000) / 1000;
    return v;
  };
  for (int i = 0; i < 3000; ++i) {
    const double radius = 0.05 + 60 * std::abs(number()), from = 4 * number(), sweep = 0.4 + 2.6 * std::abs(number());
    const Vector center = vector();
    const auto at = [&](double angle) {
      return Vector{center[0] + radius * std::cos(angle), center[1] + radius * std::sin(angle), center[2]};
    };
    const ToolPose start{rounded(at(from)), {0, 0, 1}}, end{rounded(at(from + sweep)), {0, 0, 1}};
    const auto curves = built(ArcGeometry{rounded(center), {0, 0, 1}, 1, false, start, end}, {start, {}});
    ASSERT_EQ(curves.size(), 1U);
    expect_ends(*curves[0], start, end);
    EXPECT_NEAR(curves[0]->length(), radius * sweep, 0.01);
  }
}

TEST_F(Arc, MayMissItsCentreByHalfOfItsTolerance) {
  const ToolPose start{{10, 0, 0}, {0, 0, 1}}, end{{0, 10.008, 0}, {0, 0, 1}};
  Move move = move_of(ArcGeometry{{0, 0, 0}, {0, 0, 1}, 1, false, start, end});
  EXPECT_FALSE(make_curves(move, {start, {}}));
  move.tolerance_mm = 0.02;
  EXPECT_TRUE(make_curves(move, {start, {}}));
  move.tolerance_mm = 0.015;
  EXPECT_FALSE(make_curves(move, {start, {}}));
}

TEST_F(Arc, IsRefusedWhenDegenerate) {
  const ToolPose start{{10, 0, 0}, {0, 0, 1}};
  const ToolPose end{{0, 10, 0}, {0, 0, 1}};
  const CurveStart queue{start, {}};
  EXPECT_THAT(refusal(ArcGeometry{{0, 0, 0}, {0, 0, 0}, 1, false, start, end}, queue),
              HasSubstr("normal has no length"));
  EXPECT_THAT(refusal(ArcGeometry{{0, 0, 0}, {0, 0, 1}, 0, false, start, end}, queue), HasSubstr("rotation is 0"));
  EXPECT_THAT(refusal(ArcGeometry{{kNan, 0, 0}, {0, 0, 1}, 1, false, start, end}, queue), HasSubstr("not finite"));
  EXPECT_THAT(refusal(ArcGeometry{{10, 0, 0}, {0, 0, 1}, 1, true, start, start}, queue), HasSubstr("radius is 0 mm"));
  EXPECT_THAT(refusal(ArcGeometry{{0, 0, 0}, {0, 0, 1}, 1, true, start, end}, queue),
              HasSubstr("closed, but its end is 14.14214 mm from its start"));
}

// Red when the pitch is not even, when it turns the other way, when a turn too many or too few is made, or when one of
// its derivatives misses the rise.
TEST_F(Arc, ClimbsEvenlyWhenItsEndIsOffItsPlane) {
  for (int i = 0; i < 300; ++i) {
    const Vector center = vector();
    const Vector normal = axis();
    const double radius = 0.05 + 100 * std::abs(number());
    const double base = 10 * number(), rise = 40 * number();
    const int turns = i % 5, rotation = i % 2 == 0 ? 1 : -1;
    const bool closed = i % 3 == 0;
    const double from = pi * number();
    const double sweep = (closed ? 2 * pi : 0.05 + 3.1 * (1 + number())) + 2 * pi * turns;
    const auto helix = [&](double f) {
      return on_cylinder(center, normal, radius, from + rotation * sweep * f, base + rise * f);
    };
    const ToolPose start{helix(0), axis()}, end{helix(1), axis()};
    const auto curves = built(ArcGeometry{center, normal, rotation, closed, start, end, turns}, {start, {}});
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_NEAR(curves[0]->length(), std::hypot(radius * sweep, rise), 1e-9);
    expect_ends(*curves[0], start, end);
    expect_steady(*curves[0]);
    expect_sound(*curves[0], 1e-8);
    for (int k = 0; k <= 20; ++k) {
      CurvePoint point;
      curves[0]->evaluate(curves[0]->length() * k / 20, 0, 1, point);
      const Vector wanted = helix(k / 20.0);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(point.d[0][c], wanted[c], 1e-9);
    }
  }
}

TEST_F(Arc, MakesAsManyWholeTurnsAsAskedWhereItsEndIsAboveItsStart) {
  const ToolPose start{{10, 0, 0}, {0, 0, 1}};
  const ToolPose above{{10, 0, 5}, {0, 0, 1}};
  const auto length = [&](bool closed, int turns, const ToolPose& end) {
    const auto curves = built(ArcGeometry{{0, 0, 0}, {0, 0, 1}, 1, closed, start, end, turns}, {start, {}});
    return curves.empty() ? 0 : curves[0]->length();
  };
  EXPECT_NEAR(length(false, 1, above), std::hypot(20 * pi, 5), 1e-12);
  EXPECT_NEAR(length(true, 0, above), std::hypot(20 * pi, 5), 1e-12);
  EXPECT_NEAR(length(true, 2, above), std::hypot(60 * pi, 5), 1e-12);
  // Without a rise, turns are laps.
  EXPECT_NEAR(length(true, 2, start), 60 * pi, 1e-12);
  EXPECT_NEAR(length(false, 2, start), 40 * pi, 1e-12);
  EXPECT_THAT(refusal(ArcGeometry{{0, 0, 0}, {0, 0, 1}, 1, false, start, above}, {start, {}}),
              HasSubstr("a helix of whole turns Closed or Turns"));
}

TEST_F(Arc, IsRefusedWhenItsTurnsAreOutOfRange) {
  const ToolPose start{{10, 0, 0}, {0, 0, 1}}, end{{0, 10, 1}, {0, 0, 1}};
  for (const int turns : {-1, 1001}) {
    EXPECT_THAT(refusal(ArcGeometry{{0, 0, 0}, {0, 0, 1}, 1, false, start, end, turns}, {start, {}}),
                HasSubstr("Turns are " + std::to_string(turns) + "; 0 to 1000"));
  }
}

TEST_F(Arc, PassesThroughThreePoints) {
  for (int i = 0; i < 300; ++i) {
    const ToolPose start = pose();
    const ToolPose end = pose();
    const Vector via = vector();
    const auto curves = built(Arc3Geometry{via, start, end}, {start, {}});
    ASSERT_EQ(curves.size(), 1U);
    expect_ends(*curves[0], start, end);
    expect_steady(*curves[0]);
    // The via point lies between: the nearest point of a fine walk is within half a step of it.
    double nearest = 1e9;
    constexpr int kSteps = 20000;
    for (int k = 0; k <= kSteps; ++k) {
      CurvePoint point;
      curves[0]->evaluate(curves[0]->length() * k / kSteps, 0, 1, point);
      nearest = std::min(nearest, std::hypot(point.d[0][0] - via[0], point.d[0][1] - via[1], point.d[0][2] - via[2]));
    }
    EXPECT_LE(nearest, 0.51 * curves[0]->length() / kSteps + 1e-9);
  }
}

TEST_F(Arc, ThroughThreePointsIsRefusedWhenTheyAreInLineOrCoincide) {
  const ToolPose start{{0, 0, 0}, {0, 0, 1}};
  const ToolPose end{{10, 0, 0}, {0, 0, 1}};
  const CurveStart queue{start, {}};
  EXPECT_THAT(refusal(Arc3Geometry{{5, 0, 0}, start, end}, queue), HasSubstr("lie on one line"));
  EXPECT_THAT(refusal(Arc3Geometry{{15, 1e-9, 0}, start, end}, queue), HasSubstr("lie on one line"));
  EXPECT_THAT(refusal(Arc3Geometry{{10, 0, 0.0005}, start, end}, queue), HasSubstr("coincide (0.0005 mm apart)"));
  EXPECT_THAT(refusal(Arc3Geometry{{5, 5, 0}, start, start}, queue), HasSubstr("coincide (0 mm apart)"));
  EXPECT_TRUE(built(Arc3Geometry{start.tip, start, start}, queue).empty()) << "all three are one point";
  EXPECT_THAT(refusal(Arc3Geometry{{kNan, 5, 0}, start, end}, queue), HasSubstr("not finite"));
}

TEST_F(Arc, HasNodesAtMostATenthOfARadianApart) {
  const ToolPose start{{5, 0, 0}, {0, 0, 1}};
  const auto curves = built(ArcGeometry{{0, 0, 0}, {0, 0, 1}, 1, true, start, start}, {start, {}});
  ASSERT_EQ(curves.size(), 1U);
  const auto nodes = curves[0]->nodes();
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) EXPECT_LE((nodes[i + 1] - nodes[i]) / 5, 0.1 + 1e-12);
}

}  // namespace
}  // namespace rmac::test
