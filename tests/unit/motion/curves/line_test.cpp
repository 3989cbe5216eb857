#include <gmock/gmock.h>

#include <limits>
#include <numbers>
#include <random>

#include "unit/motion/curves/shapes.hpp"

namespace rmac::test {
namespace {

using std::numbers::pi;
using testing::AllOf;
using testing::HasSubstr;

using Line = Shapes;
using JointLine = Shapes;

TEST_F(Line, RunsStraightWithTheAxisTurningInStep) {
  for (int i = 0; i < 200; ++i) {
    const ToolPose start = pose();
    const ToolPose end = pose();
    const auto curves = built(LineGeometry{start, end}, {start, {}});
    ASSERT_EQ(curves.size(), 1U);
    expect_ends(*curves[0], start, end);
    expect_steady(*curves[0]);
    expect_sound(*curves[0], 1e-9);
    EXPECT_TRUE(curves[0]->breaks().empty());
  }
}

TEST_F(Line, MeasuresDegreesWhereTheTipRests) {
  const Vector tip{1, 2, 3};
  const ToolPose start{tip, {0, 0, 1}};
  const ToolPose end{tip, {std::sin(pi / 6), 0, std::cos(pi / 6)}};
  const auto curves = built(LineGeometry{start, end}, {start, {}});
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_NEAR(curves[0]->length(), 30, 1e-12);
  expect_ends(*curves[0], start, end);
  expect_sound(*curves[0], 1e-9);
  CurvePoint middle;
  curves[0]->evaluate(15, 1, 1, middle);
  EXPECT_NEAR(middle.d[0][3], std::sin(pi / 12), 1e-14);
  EXPECT_NEAR(size_of(middle, 1, 3, 6), pi / 180, 1e-15);
  EXPECT_EQ(size_of(middle, 1, 0, 3), 0);
}

TEST_F(Line, BeginsWhereTheQueueEndsWhenTheStartIsWithinTolerance) {
  const ToolPose queue_end{{5, 5, 5}, {0, 0, 1}};
  const ToolPose end{{6, 5, 5}, {0, 0, 1}};
  const auto curves = built(LineGeometry{{{5, 5.0009, 5}, {0, 0, 1}}, end}, {queue_end, {}});
  ASSERT_EQ(curves.size(), 1U);
  expect_ends(*curves[0], queue_end, end);
}

TEST_F(Line, IsRefusedWhenItStartsElsewhere) {
  EXPECT_THAT(
      refusal(LineGeometry{{{0, 0, 0.002}, {0, 0, 1}}, {{1, 0, 0}, {0, 0, 1}}}, at({0, 0, 0})),
      HasSubstr("starts 0.002 mm from where the queue ends (0, 0, 0); at most 0.001 mm is allowed: go to its start "
                "by MoveToPathTarget first"));
  const Vector tilted{std::sin(2e-6), 0, std::cos(2e-6)};
  EXPECT_THAT(refusal(LineGeometry{{{0, 0, 0}, tilted}, {{1, 0, 0}, {0, 0, 1}}}, at({0, 0, 0})),
              AllOf(HasSubstr("a tool axis 2e-06 from that at the end of the queue"),
                    HasSubstr("turn the tool by MoveToPathTarget first")));
}

TEST_F(Line, HasNoCurveWhereAPointIsRepeated) {
  const ToolPose here{{1, 1, 1}, {0, 0, 1}};
  EXPECT_TRUE(built(LineGeometry{here, here}, {here, {}}).empty());
  const ToolPose rounded{{1, 1, 1 + 5e-7}, {0, 0, 1}};
  EXPECT_TRUE(built(LineGeometry{here, rounded}, {here, {}}).empty());
}

TEST_F(Line, HasNoCurveForATargetWhereTheToolStands) {
  const ToolPose here{{1, 1, 1}, {0, 0, 1}};
  const auto curves = make_curves(move_of(PathTargetGeometry{here}), {here, {}});
  ASSERT_TRUE(curves) << curves.error().message;
  EXPECT_TRUE(curves->empty());
}

TEST_F(Line, IsRefusedWhenTheAxisTurnsHalfAround) {
  EXPECT_THAT(refusal(LineGeometry{{{0, 0, 0}, {0, 0, 1}}, {{1, 0, 0}, {0, 0, -1}}}, at({0, 0, 0})),
              HasSubstr("turn by 180 degrees"));
}

TEST_F(Line, IsRefusedWithNumbersThatAreNone) {
  EXPECT_THAT(refusal(LineGeometry{{{0, 0, 0}, {0, 0, 1}}, {{kNan, 0, 0}, {0, 0, 1}}}, at({0, 0, 0})),
              HasSubstr("the end holds a number that is not finite"));
  EXPECT_THAT(refusal(LineGeometry{{{0, 0, 0}, {0, 0, 1.1}}, {{1, 0, 0}, {0, 0, 1}}}, at({0, 0, 0})),
              HasSubstr("tool axis of the start has length 1.1"));
  EXPECT_THAT(refusal(PathTargetGeometry{{{0, 0, 0}, {0, kNan, 1}}}, at({0, 0, 0})), HasSubstr("the target holds"));
}

TEST_F(Line, LeadsToAPathTargetFromTheQueuesEnd) {
  const ToolPose start = pose();
  const ToolPose end = pose();
  const auto curves = built(PathTargetGeometry{end}, {start, {}});
  ASSERT_EQ(curves.size(), 1U);
  expect_ends(*curves[0], start, end);
}

TEST_F(JointLine, RunsStraightInJointSpace) {
  const std::vector<double> start{1, -20, 300};
  const std::vector<double> end{4, -16, 312};
  const auto curves = built(JointTargetGeometry{end}, {{}, start});
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_TRUE(curves[0]->in_joint_space());
  EXPECT_EQ(curves[0]->dimension(), 3U);
  EXPECT_NEAR(curves[0]->length(), 13, 1e-13);
  expect_sound(*curves[0], 1e-9);
  CurvePoint point;
  curves[0]->evaluate(13, 1, -1, point);
  for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(point.d[0][j], end[j], 1e-12);
  EXPECT_NEAR(size_of(point, 1, 0, 3), 1, 1e-15);
}

TEST_F(JointLine, IsRefusedWithWrongTargets) {
  const std::vector<double> start{1, 2};
  EXPECT_THAT(refusal(JointTargetGeometry{{1, 2, 3}}, {{}, start}), HasSubstr("has 3 values, the machine has 2"));
  EXPECT_THAT(refusal(JointTargetGeometry{{1, kNan}}, {{}, start}), HasSubstr("joint 1 is not a finite number"));
}

TEST_F(JointLine, HasNoCurveForATargetWhereTheJointsStand) {
  const std::vector<double> start{1, 2};
  const auto curves = make_curves(move_of(JointTargetGeometry{{1, 2}}), {{{}, {0, 0, 1}}, start});
  ASSERT_TRUE(curves) << curves.error().message;
  EXPECT_TRUE(curves->empty());
}

}  // namespace
}  // namespace rmac::test
