// Limits are held to closed forms, and to a tool that swings tooth by tooth and shares no code with them.
#include "gateway/chatter/cut_stability.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "gateway/threads/sanitized.hpp"
#include "unit/gateway/chatter/straight_teeth.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using std::numbers::pi;
using test::kDown, test::kMaterial, test::kSlot, test::kUp, test::modes_of;
using test::Oscillator;
using test::StraightTeeth;

/// Of all speeds.
ChatterLimit worst(const CutStability& stability) {
  ChatterLimit worst;
  for (double period_s = 0.0004; period_s < 0.02; period_s *= 1.003) {
    const ChatterLimit limit = stability.at(period_s);
    if (limit.share < worst.share) worst = limit;
  }
  return worst;
}

class Seeded : public testing::TestWithParam<unsigned> {
 protected:
  double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  std::vector<Oscillator> oscillators(std::size_t most) {
    std::vector<Oscillator> all(1 + random_() % most);
    for (Oscillator& one : all) {
      one = {between(150, 1500), between(0.01, 0.06), between(3e3, 3e4),
             Vector3d(between(-1, 1), between(-1, 1), between(-0.3, 0.3)).normalized()};
    }
    return all;
  }
  std::mt19937 random_{GetParam()};
};

// S. A. Tobias, J. Tlusty: turning with one mode along the chip.
TEST(CutStability, OfOneModeAlongTheChipIsTheOldFormula) {
  const Vector3d along = Vector3d(1, 2, 0.5).normalized();
  for (const double damping : {0.01, 0.03, 0.1}) {
    const double stiffness = 8e3, cutting = 500;
    const std::vector modes{Oscillator{400, damping, stiffness, along}.mode()};
    const ChatterLimit limit = worst(CutStability(-cutting * along * along.transpose(), modes));
    EXPECT_NEAR(limit.share, 2 * damping * (1 + damping) * stiffness / cutting, 0.002 * limit.share) << damping;
    EXPECT_NEAR(limit.frequency_hz, 400 * std::sqrt(1 + 2 * damping), 2) << damping;
  }
}

// At each speed the limit is where a frequency, the phase that it needs, and the waves between two teeth fit.
TEST(CutStability, OfOneModeHasTheLobesOfItsClosedForm) {
  const double f = 400, damping = 0.03, stiffness = 8e3, cutting = 500;
  const std::vector modes{Oscillator{f, damping, stiffness, Vector3d::UnitX()}.mode()};
  Matrix3d only = Matrix3d::Zero();
  only(0, 0) = -cutting;
  const CutStability stability(only, modes);
  for (double period_s = 0.0015; period_s < 0.02; period_s *= 1.0371) {
    double least = std::numeric_limits<double>::infinity(), before = 0;
    for (double r = 1 + 1e-5; r < 2.4; r += 1e-5) {
      const double re = (1 - r * r), im = 2 * damping * r;  // of the inverse of the receptance
      const double share = (re * re + im * im) / (2 * -re) * stiffness / cutting;
      const double phase = 2 * pi - 2 * std::atan(-re / im);  // 1 - e^(-i·phase) against -1/G
      const double waves = f * r * period_s - std::fmod(phase, 2 * pi) / (2 * pi);
      if (r > 1 + 1e-5 && std::floor(waves) != std::floor(before) && std::floor(waves) >= 0) {
        least = std::min(least, share);
      }
      before = waves;
    }
    EXPECT_NEAR(stability.at(period_s).share / least, 1, 0.02) << period_s;
  }
}

TEST(CutStability, IsGrantedWhereNothingGivesWayOrNothingIsCut) {
  EXPECT_TRUE(std::isinf(CutStability(test::stiffness_of({4, 2, kSlot, kMaterial}).mean, {}).at(0.01).share));
  const std::vector modes{Oscillator{400, 0.03, 8e3, Vector3d::UnitX()}.mode()};
  EXPECT_TRUE(std::isinf(CutStability(Matrix3d::Zero(), modes).at(0.01).share));
  EXPECT_TRUE(std::isinf(CutStability::least_share(0, modes)));
}

using Stability = Seeded;
// A sanitizer makes minutes of each second.
INSTANTIATE_TEST_SUITE_P(Seeds, Stability, testing::Range(1u, kSanitized ? 2u : 25u));

// Four teeth, or six, in a slot change nothing as they turn, so that the mean is all there is.
TEST_P(Stability, OfASlotIsWhereTheToolBeginsToSwing) {
  const auto tools = oscillators(3);
  StraightTeeth teeth{4 + 2 * static_cast<int>(random_() % 2), 1, kSlot, kMaterial};
  const double period_s = between(0.001, 0.006);
  const ChatterLimit limit = CutStability(test::stiffness_of(teeth).mean, modes_of(tools)).at(period_s);
  ASSERT_LT(limit.share, 1e4);
  teeth.depth_mm = 0.93 * limit.share;
  EXPECT_LT(test::growth(teeth, tools, period_s, 600), 1);
  teeth.depth_mm = 1.07 * limit.share;
  EXPECT_GT(test::growth(teeth, tools, period_s, 600), 1);
}

// Tools, round as they are, whose teeth come more slowly than they swing; docs/dynamics.md has what this comes to.
TEST_P(Stability, OfHalfImmersionIsNear) {
  std::vector<Oscillator> tools;
  for (int n = 1 + static_cast<int>(random_() % 2); n > 0; --n) {
    const Oscillator one{between(800, 3000), between(0.01, 0.05), between(1e3, 2e4), Vector3d::UnitX()};
    tools.push_back(one);
    tools.push_back(one);
    tools.back().d = Vector3d::UnitY();
  }
  StraightTeeth teeth{4, 1, GetParam() % 2 == 0 ? kUp : kDown, kMaterial};
  const double period_s = between(0.0015, 0.01);
  const ChatterLimit limit = CutStability(test::stiffness_of(teeth).mean, modes_of(tools)).at(period_s);
  teeth.depth_mm = 0.75 * limit.share;
  EXPECT_LT(test::growth(teeth, tools, period_s, 150), 1);
  teeth.depth_mm = 1.4 * limit.share;
  EXPECT_GT(test::growth(teeth, tools, period_s, 150), 1);
}

TEST_P(Stability, IsNeverLessThanWhatIsFoundAtOnce) {
  const auto tools = oscillators(3);
  const StraightTeeth teeth{2, 1, {between(0, 1), between(1.2, pi)}, kMaterial};
  const Matrix3d cutting = test::stiffness_of(teeth).mean;
  EXPECT_GE(worst(CutStability(cutting, modes_of(tools))).share,
            CutStability::least_share(cutting.norm(), modes_of(tools)));
}

TEST_P(Stability, IsTheSameInAnyFrame) {
  auto tools = oscillators(3);
  const StraightTeeth teeth{3, 1, {between(0, 1), between(1.2, pi)}, kMaterial};
  const Matrix3d cutting = test::stiffness_of(teeth).mean;
  const double period_s = between(0.001, 0.006), share = CutStability(cutting, modes_of(tools)).at(period_s).share;
  const Matrix3d turned =
      Eigen::AngleAxisd(between(-3, 3), Vector3d(between(-1, 1), 0.4, between(-1, 1)).normalized()).toRotationMatrix();
  for (Oscillator& one : tools) one.d = turned * one.d;
  EXPECT_NEAR(CutStability(turned * cutting * turned.transpose(), modes_of(tools)).at(period_s).share, share,
              1e-6 * share);
}

// Twice the depth is half of the share that it bears.
TEST_P(Stability, IsAShareOfTheDepth) {
  const auto tools = oscillators(3);
  const double period_s = between(0.001, 0.006);
  const auto share = [&](double depth) {
    return CutStability(test::stiffness_of({4, depth, kSlot, kMaterial}).mean, modes_of(tools)).at(period_s).share;
  };
  EXPECT_NEAR(share(2) / share(1), 0.5, 1e-9);
}

}  // namespace
}  // namespace rmac::gateway
