#include "gateway/metrology/sphere.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/gateway/metrology/measured.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

constexpr int kSpheres = 40;

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

std::vector<Vector> on_circle(Chance& chance, const Frame& frame, double radius, int count, double sigma) {
  std::vector<Vector> points;
  for (int i = 0; i < count; ++i) {
    const double turn = 2 * M_PI * (i + 0.5) / count, r = radius + chance.noise(sigma);
    points.push_back(apply_to_point(frame, {r * std::cos(turn), r * std::sin(turn), chance.noise(sigma)}));
  }
  return points;
}

TEST(Sphere, IsFoundExactlyWithoutNoise) {
  Chance chance(1);
  for (int i = 0; i < kSpheres; ++i) {
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
    for (int i = 0; i < kSpheres; ++i) {
      const Frame frame = chance.frame(500, M_PI);
      const auto fit = fit_sphere(on_circle(chance, frame, 12, 9, sigma));
      ASSERT_FALSE(fit) << "trial " << i;
      EXPECT_THAT(fit.error().message, HasSubstr("centre along"));
      EXPECT_THAT(fit.error().message, HasSubstr("not held"));
    }
  }
  EXPECT_THAT(fit_sphere(std::vector<Vector>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).error().message,
              HasSubstr("needs 4 points, and there are 3"));
  EXPECT_FALSE(fit_sphere(std::vector<Vector>(7, Vector{1, 2, 3})));
}

}  // namespace
}  // namespace rmac::gateway
