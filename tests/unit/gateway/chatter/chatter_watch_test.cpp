#include "gateway/chatter/chatter_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace rmac::gateway {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// One mode along x, in which a cut is steady at any speed up to 484.5 N/mm.
const std::vector<VibrationMode> kModes{{.frequency_hz = 400,
                                         .damping_ratio = 0.03,
                                         .stiffness_n_mm = 8e3,
                                         .directions = Vector3d::UnitX() * Vector3d::UnitX().transpose()}};
constexpr double kBears = 2 * 0.03 * 1.03 * 8e3;

/// Near the speed at which that is all it bears: 400 Hz and a bit, and eight waves and three quarters between teeth.
ChatterWatch::Look look(double cutting, double t_s = 1, std::int64_t move = 1) {
  return {.cutting_n_mm = -cutting * Vector3d::UnitX() * Vector3d::UnitX().transpose(),
          .over_pitch_n_mm = {},
          .teeth = 2,
          .rpm = 1410,
          .most_rpm = 0,
          .t_s = t_s,
          .line = static_cast<int>(10 * move),
          .move_id = move,
          .place = Vector3d(t_s, 0, 0)};
}

TEST(ChatterWatch, FindsNothingInASteadyCutAndTellsItsRoom) {
  ChatterWatch watch;
  watch.add(look(0.5 * kBears), kModes);
  EXPECT_THAT(watch.found(), testing::IsEmpty());
  EXPECT_GE(watch.least_share(), 2);
  EXPECT_LT(watch.least_share(), 3);
}

TEST(ChatterWatch, TellsNothingOfRoomWhereNothingGivesWay) {
  ChatterWatch watch;
  watch.add(look(1e5), {});
  EXPECT_THAT(watch.found(), testing::IsEmpty());
  EXPECT_TRUE(std::isinf(watch.least_share()));
}

TEST(ChatterWatch, HasOneFindingOfAMoveWithItsWorstPlace) {
  ChatterWatch watch;
  watch.add(look(2 * kBears, 1.0), kModes);
  watch.add(look(4 * kBears, 1.5), kModes);
  watch.add(look(0.1 * kBears, 1.7), kModes);
  watch.add(look(2 * kBears, 2.0), kModes);
  ASSERT_EQ(watch.found().size(), 1u);
  const Chatter& chatter = watch.found().front();
  EXPECT_EQ(chatter.line, 10);
  EXPECT_EQ(chatter.t_s, 1.0);
  EXPECT_EQ(chatter.until_s, 2.0);
  EXPECT_EQ(chatter.place[0], 1.5);
  EXPECT_EQ(chatter.most_t_s, 1.5);
  EXPECT_EQ(chatter.share, watch.least_share());
  EXPECT_LT(chatter.share, 0.5);
  EXPECT_NEAR(chatter.frequency_hz, 410, 20);
}

TEST(ChatterWatch, HasAFindingForEachMove) {
  ChatterWatch watch;
  watch.add(look(4 * kBears, 1, 1), kModes);
  watch.add(look(4 * kBears, 2, 2), kModes);
  EXPECT_EQ(watch.found().size(), 2u);
}

TEST(ChatterWatch, KeepsNoMoreThanAThousandAndTheLeastOfAll) {
  ChatterWatch watch;
  for (int i = 1; i <= 1005; ++i) watch.add(look((i > 1000 ? 8 : 4) * kBears, i, i), kModes);
  EXPECT_EQ(watch.found().size(), ChatterWatch::kMost);
  EXPECT_LT(watch.least_share(), watch.found().back().share);
}

TEST(ChatterWatch, ProposesTheNearestSpeedAtWhichTheCutIsSteady) {
  ChatterWatch watch;
  watch.add(look(1.3 * kBears), kModes);
  ASSERT_EQ(watch.found().size(), 1u);
  const auto rpm = watch.found().front().steady_rpm;
  ASSERT_TRUE(rpm);
  EXPECT_NE(*rpm, 1410);
  ChatterWatch again;
  auto there = look(1.3 * kBears);
  there.rpm = *rpm;
  again.add(there, kModes);
  EXPECT_THAT(again.found(), testing::IsEmpty());
  EXPECT_GE(again.least_share(), 1.1 - 1e-9);
}

TEST(ChatterWatch, ProposesNoSpeedThatTheSpindleDoesNotHave) {
  ChatterWatch watch;
  auto at = look(1.3 * kBears);
  at.most_rpm = 1410;
  watch.add(at, kModes);
  ASSERT_EQ(watch.found().size(), 1u);
  EXPECT_LE(watch.found().front().steady_rpm.value_or(0), 1410);
}

TEST(ChatterWatch, ProposesNoneWhereNoneIsSteady) {
  ChatterWatch watch;
  watch.add(look(100 * kBears), kModes);
  ASSERT_EQ(watch.found().size(), 1u);
  EXPECT_FALSE(watch.found().front().steady_rpm);
}

}  // namespace
}  // namespace rmac::gateway
