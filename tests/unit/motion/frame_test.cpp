#include "rmac/motion/frame.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <random>

#include "rmac/motion/frame_check.hpp"

namespace rmac {
namespace {

using testing::HasSubstr;

class FrameAlgebra : public testing::Test {
 protected:
  double number() { return range_(random_); }
  Vector vector() { return {10 * number(), 10 * number(), 10 * number()}; }
  Frame frame() { return normalized({vector(), {number(), number(), number(), number()}}); }

  static void expect_near(const Vector& a, const Vector& b) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-12);
  }

 private:
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> range_{-1, 1};
};

TEST_F(FrameAlgebra, ComposeAppliesInnerThenOuter) {
  for (int i = 0; i < 1000; ++i) {
    const Frame outer = frame();
    const Frame inner = frame();
    const Vector point = vector();
    expect_near(apply_to_point(compose(outer, inner), point), apply_to_point(outer, apply_to_point(inner, point)));
    expect_near(apply_to_vector(compose(outer, inner), point), apply_to_vector(outer, apply_to_vector(inner, point)));
  }
}

TEST_F(FrameAlgebra, InverseBringsPointsAndPosesBack) {
  for (int i = 0; i < 1000; ++i) {
    const Frame there = frame();
    const ToolPose pose{vector(), z_axis(frame())};
    const ToolPose back = apply_to_pose(inverse(there), apply_to_pose(there, pose));
    expect_near(back.tip, pose.tip);
    expect_near(back.axis, pose.axis);
    expect_near(compose(there, inverse(there)).p, {0, 0, 0});
  }
}

TEST_F(FrameAlgebra, RotationKeepsLengthAndHandedness) {
  for (int i = 0; i < 1000; ++i) {
    const Frame f = frame();
    const Vector x = apply_to_vector(f, {1, 0, 0});
    const Vector y = apply_to_vector(f, {0, 1, 0});
    expect_near({x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]}, z_axis(f));
    EXPECT_NEAR(std::hypot(x[0], x[1], x[2]), 1, 1e-14);
  }
}

TEST_F(FrameAlgebra, QuarterTurnAboutZCarriesXToY) {
  const double h = std::sqrt(0.5);
  expect_near(apply_to_vector({{5, 5, 5}, {h, 0, 0, h}}, {1, 0, 0}), {0, 1, 0});
  expect_near(apply_to_point({{5, 6, 7}, {h, 0, 0, h}}, {1, 0, 0}), {5, 7, 7});
}

TEST_F(FrameAlgebra, FrameFromAxisHasThatAxis) {
  for (int i = 0; i < 1000; ++i) {
    const Vector axis = z_axis(frame());
    const Frame f = frame_from_axis({1, 2, 3}, {3 * axis[0], 3 * axis[1], 3 * axis[2]});
    expect_near(z_axis(f), axis);
    expect_near(f.p, {1, 2, 3});
    EXPECT_TRUE(check_frame(f, "f"));
  }
  for (const double tilt : {0.0, 1e-9, -1e-12}) {
    for (const double z : {1.0, -1.0}) expect_near(z_axis(frame_from_axis({0, 0, 0}, {tilt, 0, z})), {tilt, 0, z});
  }
}

TEST_F(FrameAlgebra, CheckRefusesQuaternionsThatAreNotUnit) {
  EXPECT_TRUE(check_frame({{0, 0, 0}, {1 + 5e-7, 0, 0, 0}}, "the part frame"));
  const auto refused = check_frame({{0, 0, 0}, {1, 1, 0, 0}}, "the part frame");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::InvalidParameterValue);
  EXPECT_THAT(refused.error().message, HasSubstr("the part frame: the quaternion q has length 1.41421"));
  EXPECT_FALSE(check_frame({{0, 0, 0}, {0, 0, 0, 0}}, "f"));
}

TEST_F(FrameAlgebra, CheckRefusesNumbersThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(check_frame({{0, nan, 0}, {1, 0, 0, 0}}, "f").error().message, HasSubstr("origin p"));
  EXPECT_THAT(check_frame({{0, 0, 0}, {infinity, 0, 0, 0}}, "f").error().message, HasSubstr("quaternion q"));
}

}  // namespace
}  // namespace rmac
