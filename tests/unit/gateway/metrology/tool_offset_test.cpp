#include "gateway/metrology/tool_offset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

Frame seeded_frame(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Frame frame;
  frame.p = {unit(random), unit(random), unit(random)};
  frame.q = {1, 0.01 * unit(random), 0.01 * unit(random), 0.01 * unit(random)};
  return normalized(frame);
}

/// A point of a surface that lies `deeper` than nominal, as it is measured in a part that lies at `frame`.
SurfacePoint cut_point(const Vector& nominal, const Vector& normal, double deeper, const Frame& frame) {
  Vector at = nominal;
  for (std::size_t i = 0; i < 3; ++i) at[i] -= deeper * normal[i];
  return {"cut", nominal, normal, apply_to_pose(frame, {at, {0, 0, 1}}).tip};
}

TEST(ToolOffset, TellsLengthByFloorsAndRadiusByWalls) {
  std::mt19937 random(20261122);  // NOLINT(cert-msc51-cpp): the same parts every time
  std::uniform_real_distribution<double> wrong(-0.1, 0.1), place(-30, 30);
  for (int i = 0; i < 200; ++i) {
    const Frame frame = seeded_frame(random);
    const double longer = wrong(random), larger = wrong(random);
    std::vector<SurfacePoint> points;
    for (int k = 0; k < 4; ++k) {
      const double turn = place(random);
      points.push_back(cut_point({place(random), place(random), -5}, {0, 0, 1}, longer, frame));
      points.push_back(
          cut_point({place(random), place(random), -3}, {std::cos(turn), std::sin(turn), 0}, larger, frame));
    }
    // An edge of 45 degrees tells both, and so neither.
    points.push_back(cut_point({1, 2, 3}, {std::sqrt(0.5), 0, std::sqrt(0.5)}, 7, frame));
    const ToolOffset found = tool_offset(points, frame, {0, 0, 1});
    ASSERT_TRUE(found.length_mm && found.radius_mm);
    EXPECT_NEAR(*found.length_mm, longer, 1e-9);
    EXPECT_NEAR(*found.radius_mm, larger, 1e-9);
  }
}

TEST(ToolOffset, TellsNothingOfWhatWasNotMeasured) {
  const std::vector<SurfacePoint> floor{cut_point({0, 0, 0}, {0, 0, 1}, 0.02, {})};
  const ToolOffset found = tool_offset(floor, {}, {0, 0, 1});
  EXPECT_NEAR(found.length_mm.value_or(0), 0.02, 1e-12);
  EXPECT_FALSE(found.radius_mm);
  EXPECT_FALSE(tool_offset({}, {}, {0, 0, 1}).length_mm);
}

}  // namespace
}  // namespace rmac::gateway
