#include "rmac/fieldbus/simulated_part.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "rmac/motion/frame.hpp"

// What a probe feels, held against places whose distance is known.

namespace rmac::fieldbus {
namespace {

SimulatedPart turned(double angle_rad) {
  SimulatedPart part;
  part.place.q = {std::cos(angle_rad / 2), 0, 0, std::sin(angle_rad / 2)};
  part.place.p = {100, -50, 7};
  return part;
}

Vector placed(const SimulatedPart& part, const Vector& point) {
  return apply_to_point(part.place, point);
}

TEST(SimulatedPart, ThatHasNothingIsEndlesslyFar) {
  EXPECT_EQ(SimulatedPart{}.distance({1, 2, 3}), std::numeric_limits<double>::infinity());
}

TEST(SimulatedPart, IsAsFarAsTheNearestFaceEdgeOrCornerOfABlock) {
  for (const double angle : {0.0, 0.7, -2.0}) {
    SimulatedPart part = turned(angle);
    part.blocks = {{{-10, -20, -30}, {10, 20, 30}}};
    const auto at = [&](double x, double y, double z) { return part.distance(placed(part, {x, y, z})); };
    for (const double side : {-1.0, 1.0}) {
      EXPECT_NEAR(at(side * 14, 3, 3), 4, 1e-9);
      EXPECT_NEAR(at(3, side * 24, 3), 4, 1e-9);
      EXPECT_NEAR(at(3, 3, side * 34), 4, 1e-9);
      EXPECT_NEAR(at(side * 13, side * 24, 3), 5, 1e-9) << "from an edge";
      EXPECT_NEAR(at(3, side * 23, side * 34), 5, 1e-9);
      EXPECT_NEAR(at(side * 12, side * 22, side * 31), 3, 1e-9) << "from a corner";
      EXPECT_NEAR(at(side * 10, 3, 3), 0, 1e-9);
      EXPECT_NEAR(at(side * 9, 3, 3), -1, 1e-9) << "within";
      EXPECT_NEAR(at(3, side * 18, 3), -2, 1e-9);
    }
    EXPECT_NEAR(at(0, 0, 0), -10, 1e-9);
    part.blocks.push_back({{20, -20, -30}, {30, 20, 30}});
    EXPECT_NEAR(at(16, 0, 0), 4, 1e-9) << "the nearer of two";
    EXPECT_NEAR(at(14, 0, 0), 4, 1e-9);
  }
}

TEST(SimulatedPart, IsHollowWhereABoreIs) {
  SimulatedPart part = turned(0.4);
  part.blocks = {{{-50, -50, -50}, {50, 50, 0}}};
  part.bores = {{.x = 5, .y = -6, .radius = 10, .bottom = -20, .top = 1}};
  std::mt19937 random(4);
  std::uniform_real_distribution<double> angle(-3, 3);
  for (int i = 0; i < 100; ++i) {
    const double a = angle(random);
    const auto at = [&](double radius, double z) {
      return part.distance(placed(part, {5 + radius * std::cos(a), -6 + radius * std::sin(a), z}));
    };
    EXPECT_NEAR(at(7, -5), 3, 1e-9) << "from its wall";
    EXPECT_NEAR(at(7, -19), 1, 1e-9) << "from its bottom";
    EXPECT_NEAR(at(10, -5), 0, 1e-9);
    EXPECT_NEAR(at(12, -8), -2, 1e-9) << "within the wall";
    EXPECT_NEAR(at(4, -23), -3, 1e-9) << "below its bottom";
    EXPECT_NEAR(at(13, -24), -5, 1e-9) << "beside its lower edge";
  }
}

TEST(SimulatedPart, HasSpheresThatStandByThemselves) {
  SimulatedPart part = turned(1);
  part.spheres = {{{1, 2, 3}, 5}, {{40, 2, 3}, 1}};
  EXPECT_NEAR(part.distance({1 + 6, 2 + 6, 3 + 7}), 11 - 5, 1e-9) << "not in the part's place";
  EXPECT_NEAR(part.distance({1, 2, 3}), -5, 1e-9);
  EXPECT_NEAR(part.distance({38, 2, 3}), 1, 1e-9);
  part.bores = {{.x = 0, .y = 0, .radius = 1000, .bottom = -1000, .top = 1000}};
  EXPECT_NEAR(part.distance({1, 2, 3}), -5, 1e-9) << "a bore is in the part, and takes nothing from a sphere";
}

}  // namespace
}  // namespace rmac::fieldbus
