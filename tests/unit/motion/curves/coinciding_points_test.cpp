// NURBS of which control points coincide, so that the parameter stands still: straight stretches are travelled as
// lines, and what bends there is refused.
#include <gmock/gmock.h>

#include <random>

#include "unit/motion/curves/curve_checks.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac::test {
namespace {

constexpr int kSeeds = 200;

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  std::size_t count(std::size_t low, std::size_t high) {
    return std::uniform_int_distribution<std::size_t>(low, high)(random_);
  }
  Vector direction() {
    Vector v{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const double length = std::hypot(v[0], v[1], v[2]);
    for (double& c : v) c /= length;
    return v;
  }

 private:
  std::mt19937 random_;
};

std::vector<double> on_line(const Vector& from, const Vector& along, double at) {
  return {from[0] + at * along[0], from[1] + at * along[1], from[2] + at * along[2]};
}

/// Clamped, with inner knots a step apart.
std::vector<double> clamped_knots(std::size_t degree, std::size_t points) {
  std::vector<double> knots(degree, 0);
  for (std::size_t i = 0; i + degree <= points; ++i) knots.push_back(static_cast<double>(i));
  knots.insert(knots.end(), degree, knots.back());
  return knots;
}

Vector tip_of(const std::vector<double>& point) {
  return {point[0], point[1], point[2]};
}

struct End {
  Vector tip, tangent, bend;
};

End end_of(const Curve& curve, bool last) {
  CurvePoint point;
  curve.evaluate(last ? curve.length() : 0, 2, last ? -1 : 1, point);
  const auto vector = [&](std::size_t order) {
    return Vector{point.d[order][0], point.d[order][1], point.d[order][2]};
  };
  return {vector(0), vector(1), vector(2)};
}

double apart(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double total_length(const Curves& curves) {
  double sum = 0;
  for (const auto& curve : curves) sum += curve->length();
  return sum;
}

/// A straight line of any degree, its first or last two points (or both pairs) the same.
NurbsGeometry straight_with_equal_ends(Draw& draw, const Vector& from, const Vector& along, double length) {
  NurbsGeometry geometry;
  Nurbs& nurbs = geometry.curve;
  const std::size_t degree = draw.count(2, 6);
  const std::size_t points = degree + 1 + draw.count(0, 4);
  nurbs.degree = static_cast<int>(degree);
  nurbs.knots = clamped_knots(degree, points);
  const std::size_t which = points == 3 ? draw.count(1, 2) : draw.count(1, 3);
  const bool weighted = draw.count(0, 1) == 1;
  std::vector<double> places{0};
  for (std::size_t i = 1; i < points; ++i) places.push_back(places.back() + draw.uniform(0.1, 1));
  if ((which & 1U) != 0) places[1] = places[0];
  if ((which & 2U) != 0) places[points - 2] = places[points - 1];
  for (const double place : places) {
    nurbs.points.push_back(on_line(from, along, length * place / places.back()));
    if (weighted) nurbs.weights.push_back(draw.uniform(0.3, 3));
  }
  return geometry;
}

TEST(CoincidingPoints, OnALineMakeALine) {
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Vector from{draw.uniform(-9, 9), draw.uniform(-9, 9), draw.uniform(-9, 9)};
    const Vector along = draw.direction();
    const double length = draw.uniform(0.01, 80);
    const NurbsGeometry geometry = straight_with_equal_ends(draw, from, along, length);
    const Curves curves = built(geometry, at(from));
    EXPECT_NEAR(total_length(curves), length, 1e-9);
    double s_before = 0;
    for (const auto& curve : curves) {
      for (int i = 0; i <= 20; ++i) {
        CurvePoint point;
        const double s = curve->length() * i / 20;
        curve->evaluate(s, 3, 1, point);
        const std::vector<double> wanted = on_line(from, along, s_before + s);
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_NEAR(point.d[0][c], wanted[c], 1e-9);
          ASSERT_NEAR(point.d[1][c], along[c], 1e-9);
          ASSERT_NEAR(point.d[2][c] * length, 0, 1e-6);
          ASSERT_NEAR(point.d[3][c] * length * length, 0, 1e-5);
        }
      }
      s_before += curve->length();
    }
  }
}

TEST(CoincidingPoints, OnALineStartACurveThatGoesOnSmoothly) {
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Vector along = draw.direction();
    NurbsGeometry geometry;
    Nurbs& nurbs = geometry.curve;
    const std::size_t degree = draw.count(3, 5);
    const std::size_t points = degree + 1 + draw.count(1, 5);
    nurbs.degree = static_cast<int>(degree);
    nurbs.knots = clamped_knots(degree, points);
    double place = 0;
    for (std::size_t i = 0; i <= degree; ++i) {
      nurbs.points.push_back(on_line({0, 0, 0}, along, place));
      if (i > 0) place += draw.uniform(1, 4);
    }
    const bool turned = draw.count(0, 1) == 1;
    for (std::size_t i = degree + 1; i < points; ++i) {
      std::vector<double> point = on_line({0, 0, 0}, along, place);
      for (double& c : point) c += draw.uniform(-1, 1);
      place += draw.uniform(1, 4);
      nurbs.points.push_back(point);
    }
    if (turned) std::reverse(nurbs.points.begin(), nurbs.points.end());
    const Curves curves = built(geometry, at(tip_of(nurbs.points.front())));
    ASSERT_EQ(curves.size(), 2U);
    const End before = end_of(*curves[0], true);
    const End after = end_of(*curves[1], false);
    EXPECT_LT(apart(before.tip, after.tip), 1e-12);
    EXPECT_LT(apart(before.tangent, after.tangent), 1e-9);
    EXPECT_LT(apart(before.bend, after.bend), 1e-7);
    EXPECT_TRUE(curves[turned ? 1 : 0]->straight());
    for (const auto& curve : curves) expect_sound(*curve, 1e-6);
  }
}

TEST(CoincidingPoints, AsManyAsTheDegreeMakeACornerBetweenLines) {
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    NurbsGeometry geometry;
    Nurbs& nurbs = geometry.curve;
    const std::size_t degree = draw.count(2, 4);
    nurbs.degree = static_cast<int>(degree);
    std::vector<Vector> corners{{0, 0, 0}};
    nurbs.points.push_back({0, 0, 0});
    const std::size_t lines = draw.count(2, 5);
    double polygon = 0;
    for (std::size_t i = 1; i <= lines; ++i) {
      Vector next = corners.back();
      for (double& c : next) c += draw.uniform(-9, 9);
      polygon += apart(corners.back(), next);
      corners.push_back(next);
      nurbs.points.insert(nurbs.points.end(), i < lines ? degree : 1, {next[0], next[1], next[2]});
    }
    nurbs.knots = clamped_knots(degree, nurbs.points.size());
    const Curves curves = built(geometry, at({0, 0, 0}));
    EXPECT_NEAR(total_length(curves), polygon, 1e-9);
    for (const auto& curve : curves) {
      for (int i = 0; i <= 10; ++i) {
        CurvePoint point;
        curve->evaluate(curve->length() * i / 10, 2, 1, point);
        EXPECT_LT(size_of(point, 2, 0, 3), 1e-7) << "curvature";
      }
    }
    for (const Vector& corner : corners) {
      EXPECT_TRUE(std::ranges::any_of(curves, [&](const auto& curve) {
        return apart(end_of(*curve, false).tip, corner) < 1e-9 || apart(end_of(*curve, true).tip, corner) < 1e-9;
      }));
    }
  }
}

TEST(CoincidingPoints, AreTakenInPoseAndJointSpaceToo) {
  const std::vector<double> axis{0, 0.6, 0.8};
  NurbsGeometry pose{NurbsSpace::Pose, {3, 6, {0, 0, 0, 0, 1, 1, 1, 1}, {}, {}}};
  for (const double x : {0.0, 0.0, 7.0, 7.0}) pose.curve.points.push_back({x, 0, 0, axis[0], axis[1], axis[2]});
  const Curves line = built(pose, at({0, 0, 0}, {axis[0], axis[1], axis[2]}));
  ASSERT_EQ(line.size(), 1U);
  EXPECT_NEAR(line[0]->length(), 7, 1e-12);
  pose.curve.points[3] = {7, 0, 0, 0, 0, 1};
  EXPECT_THAT(refusal(pose, at({0, 0, 0}, {axis[0], axis[1], axis[2]})), testing::HasSubstr("stands still"))
      << "the axis turns, and how is the parameter's to say";

  const NurbsGeometry joints{NurbsSpace::Joint, {3, 2, {0, 0, 0, 0, 1, 1, 1, 1}, {{1, 2}, {1, 2}, {4, 6}, {4, 6}}, {}}};
  const std::vector<double> start{1, 2};
  const Curves joint_line = built(joints, {{}, start});
  ASSERT_EQ(joint_line.size(), 1U);
  EXPECT_NEAR(joint_line[0]->length(), 5, 1e-12);
}

TEST(CoincidingPoints, OfALineThatStartsAMicrometreOffAreTakenUp) {
  const NurbsGeometry geometry{
      NurbsSpace::Tip,
      {3, 3, {0, 0, 0, 0, 1, 2, 2, 2, 2}, {{0, 0, 0}, {0, 0, 0}, {5, 0, 0}, {6, 0, 0}, {9, 0, 0}}, {}}};
  const Vector queue_end{0, 0.0006, 0};
  const Curves curves = built(geometry, at(queue_end));
  ASSERT_FALSE(curves.empty());
  EXPECT_LT(apart(end_of(*curves.front(), false).tip, queue_end), 1e-12);
  EXPECT_LT(apart(end_of(*curves.back(), true).tip, {9, 0, 0}), 1e-9);
}

/// Curvature of a polynomial curve of degree 3 at `t`, by its definition.
long double curvature(const Nurbs& bezier, long double t) {
  std::array<long double, 3> first{}, second{};
  for (std::size_t c = 0; c < 3; ++c) {
    std::array<long double, 3> d{};
    for (std::size_t i = 0; i < 3; ++i) {
      d[i] = 3 * (static_cast<long double>(bezier.points[i + 1][c]) - bezier.points[i][c]);
    }
    first[c] = (1 - t) * (1 - t) * d[0] + 2 * t * (1 - t) * d[1] + t * t * d[2];
    second[c] = 2 * ((1 - t) * (d[1] - d[0]) + t * (d[2] - d[1]));
  }
  const long double cross =
      std::hypot(first[1] * second[2] - first[2] * second[1], first[2] * second[0] - first[0] * second[2],
                 first[0] * second[1] - first[1] * second[0]);
  return cross / std::pow(std::hypot(first[0], first[1], first[2]), 3.0L);
}

TEST(CoincidingPoints, WhereTheCurveBendsAreRefusedBecauseCurvatureHasNoBound) {
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    Nurbs nurbs{3, 3, {0, 0, 0, 0, 1, 1, 1, 1}, {{0, 0, 0}, {0, 0, 0}}, {}};
    for (int i = 0; i < 2; ++i) {
      nurbs.points.push_back({draw.uniform(1, 9), draw.uniform(-9, 9), draw.uniform(-9, 9)});
    }
    ASSERT_GT(curvature(nurbs, 1e-8L), 1e5L * curvature(nurbs, 1e-2L)) << "then it should have been taken";
    EXPECT_THAT(refusal({NurbsGeometry{NurbsSpace::Tip, nurbs}}, at({0, 0, 0})),
                testing::AllOf(testing::HasSubstr("stands still at parameter 0 "),
                               testing::HasSubstr("a third of the way to the next")));
    // What the message advises helps.
    for (std::size_t c = 0; c < 3; ++c) nurbs.points[1][c] = nurbs.points[2][c] / 3;
    EXPECT_EQ(refusal({NurbsGeometry{NurbsSpace::Tip, nurbs}}, at({0, 0, 0})), "");
  }
}

TEST(CoincidingPoints, LeaveEveryLimitKept) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    PlannerBench bench(mill());
    Vector from{0, 0, 0};
    bench.planner.command(PathCommand::Run);
    constexpr int kMoves = 12;
    for (int id = 1; id <= kMoves; ++id) {
      Vector to;
      for (double& c : to) c = draw.uniform(-40, 40);
      const double length = apart(from, to);
      const Vector along{(to[0] - from[0]) / length, (to[1] - from[1]) / length, (to[2] - from[2]) / length};
      Move move;
      move.id = id;
      move.feed_mm_s = draw.uniform(5, 150);
      move.geometry = straight_with_equal_ends(draw, from, along, length);
      const auto queued = bench.queue(move);
      ASSERT_TRUE(queued) << queued.error().message;
      from = to;
    }
    ASSERT_TRUE(bench.run());
    EXPECT_EQ(bench.moves_done(), static_cast<std::size_t>(kMoves));
    const auto peaks = bench.peaks();
    constexpr double kAtMost = 1.0005;  // rounding in third differences, as in planner_test.cpp
    EXPECT_LE(peaks.velocity, kAtMost);
    EXPECT_LE(peaks.acceleration, kAtMost);
    EXPECT_LE(peaks.jerk, kAtMost) << "in cycle " << peaks.jerk_cycle;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(bench.record.back().position[c], from[c], 1e-6);
  }
}

}  // namespace
}  // namespace rmac::test
