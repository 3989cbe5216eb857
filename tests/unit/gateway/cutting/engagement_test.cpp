#include "gateway/cutting/engagement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "gateway/threads/sanitized.hpp"
#include "unit/gateway/material/solids.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kMillRadius = 5, kApart = 0.2, kAhead = 0.25, kHalf = 20;

ToolShape shape(double re) {
  return {.dc = 2 * kMillRadius, .re = re, .apmx = 15, .lcf = 15, .oal = 60, .zefp = 3, .shank = {}, .holder = {}};
}

/// A block of which the cutting part has taken what it passes.
class Cutter {
 public:
  explicit Cutter(double re)
      : shape_(shape(re)), mill_(EndMill::of(shape_).value()), grid_(test::block(2 * kHalf, kApart)) {}

  void pass(const Vector3d& from, const Vector3d& to, const Vector3d& axis = Vector3d::UnitZ()) {
    for (const ProfilePiece& piece : cutting_profile(shape_)) {
      test::remove_along(grid_, piece, 0.005, 1, [&](double t) { return ToolAt{from + t * (to - from), axis}; });
    }
  }
  [[nodiscard]] Engagement at(const Vector3d& tip, const Vector3d& way,
                              const Vector3d& axis = Vector3d::UnitZ()) const {
    return engagement_of(mill_, grid_, {tip, axis}, way, kAhead);
  }

 private:
  ToolShape shape_;
  EndMill mill_;
  DexelGrid grid_;
};

double angle_in(const EngagedSlice& slice) {
  double sum = 0;
  for (const Arc& arc : slice.arcs) sum += arc.exit - arc.entry;
  return sum;
}

double depth_of(const Engagement& found) {
  return found.slices.empty() ? 0 : found.slices.back().to_mm;
}

TEST(Engagement, IsNoneInTheAir) {
  const Cutter tool(0);
  EXPECT_TRUE(tool.at({0, 0, kHalf + 0.5}, {1, 0, 0}).slices.empty());
  EXPECT_TRUE(tool.at({kHalf + kMillRadius + 1, 0, 0}, {1, 0, 0}).slices.empty());
}

TEST(Engagement, OfASlotIsHalfATurnDownToItsDepth) {
  for (const double re : {0.0, 2.0, kMillRadius}) {
    Cutter tool(re);
    const Vector3d begin(-30, 0.03, kHalf - 6), end(0, 0.03, kHalf - 6);
    tool.pass(begin, end);
    const Engagement found = tool.at(end, {1, 0, 0});
    ASSERT_FALSE(found.slices.empty());
    EXPECT_NEAR(found.slices.front().from_mm, 0, 1e-9);
    EXPECT_NEAR(depth_of(found), 6, 1e-6) << re;  // the top is where a layer ends
    for (const EngagedSlice& slice : found.slices) EXPECT_NEAR(angle_in(slice), pi, 3 * kApart / kMillRadius) << re;
    EXPECT_FALSE(found.face);
  }
}

TEST(Engagement, BehindTheToolThereIsNone) {
  Cutter tool(0);
  tool.pass({-30, 0, 14}, {0, 0, 14});
  EXPECT_TRUE(tool.at({-5, 0, 14}, {-1, 0, 0}).slices.empty());
}

TEST(Engagement, OfAStepAsideIsThatOfItsWidth) {
  for (unsigned seed = 0; seed < (kSanitized ? 12 : 60); ++seed) {
    std::mt19937 random(seed);
    const auto between = [&random](double low, double high) {
      return std::uniform_real_distribution(low, high)(random);
    };
    const double turned = between(0, 2 * pi), width = between(0.5, 2 * kMillRadius - 0.5), depth = between(1, 12);
    const bool up = between(0, 1) < 0.5;
    const Vector3d way(std::cos(turned), std::sin(turned), 0), left(-way[1], way[0], 0);
    const Vector3d down = (kHalf - depth) * Vector3d::UnitZ(), aside = (up ? width : -width) * left;
    Cutter tool(0);
    tool.pass(-40 * way + down, 40 * way + down);
    tool.pass(-40 * way + down + aside, down + aside);
    const Engagement found = tool.at(down + aside, way);
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", width " << width << ", depth " << depth);
    ASSERT_FALSE(found.slices.empty());
    EXPECT_NEAR(depth_of(found), depth, kApart);
    const double angle = std::acos(1 - width / kMillRadius);
    const double bound = 1.5 * kApart / kMillRadius / std::max(0.3, std::sin(angle)) + 0.03;
    for (const EngagedSlice& slice : found.slices) {
      EXPECT_NEAR(angle_in(slice), angle, bound);
      EXPECT_NEAR(up ? slice.arcs.front().entry : pi - slice.arcs.back().exit, 0, bound);
    }
  }
}

TEST(Engagement, OfAToolThatLeansIsHalfATurnInsideOfTheBlock) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 20; ++i) {
    const Vector3d axis = test::direction(random), way = axis.cross(test::direction(random)).normalized();
    Cutter tool(i % 2 == 0 ? kMillRadius : 1);
    tool.pass(-3 * way - 5 * axis, Vector3d(-5 * axis), axis);
    for (const EngagedSlice& slice : tool.at(-5 * axis, way, axis).slices) {
      EXPECT_NEAR(angle_in(slice), pi, 4 * kApart / kMillRadius) << i << " at " << slice.from_mm;
    }
    EXPECT_NEAR(depth_of(tool.at(-5 * axis, way, axis)), 15, kApart) << i;
  }
}

TEST(Engagement, OfAFlatEndThatGoesDownIsItsFaceToo) {
  Cutter flat(0), ball(kMillRadius);
  const Vector3d begin(0, 0, 30), end(0, 0, kHalf - 3);
  flat.pass(begin, end), ball.pass(begin, end);
  EXPECT_TRUE(flat.at(end, {0, 0, -1}).face);
  EXPECT_FALSE(flat.at(end, {0, 0, 1}).face);
  const Engagement found = ball.at(end, {0, 0, -1});
  EXPECT_FALSE(found.face);
  ASSERT_FALSE(found.slices.empty());
  EXPECT_NEAR(angle_in(found.slices.front()), 2 * pi, 1e-9);
}

}  // namespace
}  // namespace rmac::gateway
