#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rmac/motion/time_law.hpp"

namespace rmac {
namespace {

TEST(LawPiece, FollowsItsDifferentialEquationForEverySlope) {
  // a = a0 + slope (s - s0): checked by derivatives of s(t) taken with central differences.
  for (const double slope : {-400.0, -1.0, -1e-6, 0.0, 1e-6, 1.0, 400.0}) {
    const LawPiece piece{0, {5, 3, -2}, slope, 0.2, LawPiece::Kind::Linear};
    for (double t = 0.01; t < 0.2; t += 0.01) {
      const double h = 1e-4;
      const PathState before = piece.at(t - h), here = piece.at(t), after = piece.at(t + h);
      EXPECT_NEAR((after.s - before.s) / (2 * h), here.v, 1e-4 * (1 + std::abs(slope)))
          << "slope " << slope << " t " << t;
      EXPECT_NEAR((after.v - before.v) / (2 * h), here.a, 1e-4 * (1 + std::abs(slope)))
          << "slope " << slope << " t " << t;
      EXPECT_NEAR(here.a, -2 + slope * (here.s - 5), 1e-9 * (1 + std::abs(slope)));
    }
  }
}

TEST(LawPiece, HasAllDigitsOnBothSidesOfItsSeriesEnd) {
  // The series of cosh and sinh, with more terms and digits than the code under test takes.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> decade(-9, 0.3), sign(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.05, z = std::copysign(std::pow(10.0, decade(random)), sign(random)), v = 80,
                 a = 1500 * sign(random);
    long double even = 0, odd = 0, term = 1, next = 0;  // cosh √z, sinh √z / √z, (cosh √z - 1) / z
    for (int k = 0; k < 30; ++k) {
      even += term;
      odd += term / (2 * k + 1);
      next += term / ((2 * k + 1.0L) * (2 * k + 2));
      term *= z / ((2 * k + 1.0L) * (2 * k + 2));
    }
    const PathState at = LawPiece{0, {0, v, a}, z / (t * t), t, LawPiece::Kind::Linear}.at(t);
    const long double s = v * t * odd + a * t * t * next;
    EXPECT_NEAR(at.s, static_cast<double>(s), 1e-14) << "z " << z << " a " << a;
    EXPECT_NEAR(at.v, static_cast<double>(v * even + a * t * odd), 1e-12) << "z " << z << " a " << a;
    EXPECT_NEAR(at.a, static_cast<double>(a + z / (t * t) * s), 1e-10) << "z " << z << " a " << a;
  }
}

}  // namespace
}  // namespace rmac
