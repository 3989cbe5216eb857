#include "gateway/metrology/shapes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/gateway/metrology/measured.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

constexpr int kTrials = 40;

struct Ball {
  Vector centre;
  double radius;
};

std::vector<Vector> on_sphere(Chance& chance, const Ball& ball, int count, double sigma) {
  std::vector<Vector> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(plus(ball.centre, chance.direction(), ball.radius + chance.noise(sigma)));
  }
  return points;
}

/// On the part of a sphere that a probe reaches from above: down to `reach` from the pole.
std::vector<Vector> on_cap(Chance& chance, const Ball& ball, int count, double reach_rad) {
  std::vector<Vector> points;
  for (int i = 0; i < count; ++i) {
    const double turn = chance.within(0, 2 * M_PI), from_pole = reach_rad * std::sqrt(chance.within(0, 1));
    points.push_back(plus(
        ball.centre, {std::sin(from_pole) * std::cos(turn), std::sin(from_pole) * std::sin(turn), std::cos(from_pole)},
        ball.radius));
  }
  return points;
}

std::vector<Vector> on_circle(Chance& chance, const Frame& frame, double radius, int count, double arc_rad,
                              double sigma) {
  std::vector<Vector> points;
  for (int i = 0; i < count; ++i) {
    const double turn = arc_rad * (i + 0.5) / count, r = radius + chance.noise(sigma);
    points.push_back(apply_to_point(frame, {r * std::cos(turn), r * std::sin(turn), chance.noise(sigma)}));
  }
  return points;
}

std::vector<Vector> on_cylinder(Chance& chance, const Frame& frame, double radius, double height, int count,
                                double sigma) {
  std::vector<Vector> points;
  for (int i = 0; i < count; ++i) {
    const double turn = chance.within(0, 2 * M_PI), r = radius + chance.noise(sigma);
    points.push_back(apply_to_point(frame, {r * std::cos(turn), r * std::sin(turn), chance.within(0, height)}));
  }
  return points;
}

TEST(Sphere, IsFoundExactlyWithoutNoise) {
  Chance chance(1);
  for (int i = 0; i < kTrials; ++i) {
    const Ball ball{chance.place(2000), chance.within(1, 100)};
    for (const auto& points : {on_sphere(chance, ball, 4 + i % 20, 0), on_cap(chance, ball, 12, 1.0)}) {
      const auto fit = fit_sphere(points);
      ASSERT_TRUE(fit) << fit.error().message;
      EXPECT_LT(distance(fit->centre, ball.centre), 1e-8) << "trial " << i;
      EXPECT_NEAR(fit->radius_mm, ball.radius, 1e-8) << "trial " << i;
      EXPECT_LT(fit->quality.worst_mm, 1e-9);
    }
  }
}

TEST(Sphere, IsFoundWithoutBiasUnderNoise) {
  // Geometric distances, not algebraic ones: of the mean of many fits, centre and radius are the true ones but for
  // sigma²/radius, which is 0.02 µm here.
  Chance chance(2);
  const Ball ball{{10, -20, 30}, 5};
  constexpr int kFits = 400, kPoints = 25;
  constexpr double kSigma = 0.01;
  Vector mean{};
  double radius = 0, rms = 0;
  for (int i = 0; i < kFits; ++i) {
    const auto fit = fit_sphere(on_sphere(chance, ball, kPoints, kSigma));
    ASSERT_TRUE(fit) << fit.error().message;
    mean = plus(mean, fit->centre, 1.0 / kFits);
    radius += fit->radius_mm / kFits;
    rms += fit->quality.rms_mm * fit->quality.rms_mm / kFits;
  }
  const double of_mean = kSigma * std::sqrt(3.0 / kPoints / kFits);
  EXPECT_LT(distance(mean, ball.centre), 5 * of_mean);
  EXPECT_NEAR(radius, ball.radius, 5 * kSigma / std::sqrt(1.0 * kPoints * kFits));
  EXPECT_NEAR(std::sqrt(rms), kSigma * std::sqrt((kPoints - 4.0) / kPoints), 0.02 * kSigma);
}

TEST(Sphere, OfPointsInOnePlaneIsRefusedWithTheFreedomThatIsNotHeld) {
  Chance chance(3);
  for (const double sigma : {0.0, 1e-6}) {
    for (int i = 0; i < kTrials; ++i) {
      const Frame frame = chance.frame(500, M_PI);
      const auto fit = fit_sphere(on_circle(chance, frame, 12, 9, 2 * M_PI, sigma));
      ASSERT_FALSE(fit) << "trial " << i;
      EXPECT_THAT(fit.error().message, HasSubstr("centre along"));
      EXPECT_THAT(fit.error().message, HasSubstr("not held"));
    }
  }
  EXPECT_THAT(fit_sphere(std::vector<Vector>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).error().message,
              HasSubstr("needs 4 points, and there are 3"));
  EXPECT_FALSE(fit_sphere(std::vector<Vector>(7, Vector{1, 2, 3})));
}

TEST(Plane, IsFoundAndItsDeviationsAreWhatWasAdded) {
  Chance chance(4);
  for (int i = 0; i < kTrials; ++i) {
    const Frame frame = chance.frame(1000, M_PI);
    std::vector<Vector> points;
    for (int j = 0; j < 12; ++j) {
      points.push_back(apply_to_point(frame, {chance.within(-50, 50), chance.within(-50, 50), 0}));
    }
    const auto fit = fit_plane(points);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_NEAR(std::abs(dot(fit->normal, z_axis(frame))), 1, 1e-12);
    EXPECT_LT(fit->quality.worst_mm, 1e-10);
  }
  const auto line = fit_plane(std::vector<Vector>{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {5, 5, 0}});
  ASSERT_FALSE(line);
  EXPECT_THAT(line.error().message, HasSubstr("turn about the line (0.707, 0.707, 0.000)"));
}

TEST(Line, IsFoundAndABlobHasNone) {
  Chance chance(5);
  for (int i = 0; i < kTrials; ++i) {
    const Vector from = chance.place(100), way = chance.direction();
    std::vector<Vector> points;
    for (int j = 0; j < 5; ++j) points.push_back(plus(from, way, chance.within(0, 80)));
    const auto fit = fit_line(points);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_NEAR(std::abs(dot(fit->direction, way)), 1, 1e-12);
    EXPECT_LT(fit->quality.worst_mm, 1e-10);
  }
  EXPECT_FALSE(fit_line(std::vector<Vector>{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}}));
  EXPECT_FALSE(fit_line(std::vector<Vector>{{1, 0, 0}, {1, 0, 0}}));
}

TEST(Circle, IsFoundExactlyWithoutNoiseAndNotOfAShortArc) {
  Chance chance(6);
  for (int i = 0; i < kTrials; ++i) {
    const Frame frame = chance.frame(1000, M_PI);
    const double radius = chance.within(1, 50);
    const auto fit = fit_circle(on_circle(chance, frame, radius, 3 + i % 9, chance.within(2, 6), 0));
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_LT(distance(fit->centre, frame.p), 1e-8) << "trial " << i;
    EXPECT_NEAR(fit->radius_mm, radius, 1e-8) << "trial " << i;
    EXPECT_NEAR(std::abs(dot(fit->normal, z_axis(frame))), 1, 1e-9);
  }
  const auto short_arc = fit_circle(on_circle(chance, {}, 100, 7, 0.05, 0));
  ASSERT_FALSE(short_arc);
  EXPECT_THAT(short_arc.error().message, HasSubstr("not held"));
}

TEST(Cylinder, IsFoundExactlyWithoutNoise) {
  Chance chance(7);
  for (int i = 0; i < kTrials; ++i) {
    const Frame frame = chance.frame(500, M_PI);
    const double radius = chance.within(2, 40), height = chance.within(5, 100);
    const auto points = on_cylinder(chance, frame, radius, height, 9 + i % 12, 0);
    const auto fit = fit_cylinder(points);
    ASSERT_TRUE(fit) << "trial " << i << ": " << fit.error().message;
    EXPECT_NEAR(std::abs(dot(fit->axis, z_axis(frame))), 1, 1e-9) << "trial " << i;
    EXPECT_NEAR(fit->radius_mm, radius, 1e-7) << "trial " << i;
    const Vector off = plus(fit->point, frame.p, -1);
    EXPECT_LT(distance(off, plus({}, z_axis(frame), dot(off, z_axis(frame)))), 1e-6) << "trial " << i;
  }
}

TEST(Cylinder, OfOneRingOfPointsIsRefused) {
  Chance chance(8);
  const auto ring = fit_cylinder(on_circle(chance, chance.frame(100, M_PI), 20, 12, 2 * M_PI, 0));
  ASSERT_FALSE(ring);
  EXPECT_THAT(ring.error().message, HasSubstr("not held"));
}

}  // namespace
}  // namespace rmac::gateway
