// Held to a tool that swings tooth by tooth, in another way and without the product's forces.
#include "gateway/chatter/cut_in_time.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "gateway/chatter/cut_stability.hpp"
#include "gateway/threads/sanitized.hpp"
#include "unit/gateway/chatter/straight_teeth.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;
using test::Oscillator;
using test::StraightTeeth;

double softest(std::span<const Oscillator> tools) {
  return std::ranges::min(tools, {}, &Oscillator::stiffness_n_mm).stiffness_n_mm;
}

class CutInTimes : public testing::TestWithParam<unsigned> {
 protected:
  double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  std::mt19937 random_{GetParam()};
};
// A sanitizer makes minutes of each second.
INSTANTIATE_TEST_SUITE_P(Seeds, CutInTimes, testing::Range(1u, kSanitized ? 2u : 31u));

// Few degrees or many, with the waves of several teeth or less than one between two of them.
TEST_P(CutInTimes, BeginToChatterWhereTheToolDoes) {
  std::vector<Oscillator> tools(1 + random_() % 3);
  for (Oscillator& one : tools) {
    one = {between(200, 2500), between(0.01, 0.06), between(4e3, 2e4),
           Vector3d(between(-1, 1), between(-1, 1), between(-0.2, 0.2)).normalized()};
  }
  const double width = between(0.25, test::kPi), entry = GetParam() % 2 == 0 ? 0 : test::kPi - width;
  StraightTeeth teeth{1 + static_cast<int>(random_() % 4), 1, {entry, entry + width}, test::kMaterial};
  const ChipStiffness stiffness = test::stiffness_of(teeth);
  const CutInTime cut(stiffness.over_pitch, test::modes_of(tools));
  const CutStability stability(stiffness.mean, test::modes_of(tools));
  const double period_s = between(0.001, 0.008), by_mean = stability.at(period_s).share;
  // Not in the pockets between lobes, where material would hold the tool as stiffly as its holder does.
  const double most = std::min(2.5 * by_mean, 0.8 * softest(tools) / stiffness.mean.norm());
  for (double depth = 0.4 * by_mean; depth < most; depth *= 1.3) {
    teeth.depth_mm = depth;
    const double growth = test::growth(teeth, tools, period_s, 300);
    if (growth > 1e-6 && growth < 1e6) continue;  // at the limit: less than 6 % from tooth to tooth
    if (!cut.can_tell(depth / 2, period_s)) continue;
    EXPECT_EQ(cut.grows(depth, period_s), growth > 1) << depth << " of " << by_mean << " mm by the mean: " << growth;
  }
}

TEST_P(CutInTimes, HaveTheirLimitWhereTheyBeginToGrow) {
  const Oscillator tool{between(400, 1500), between(0.01, 0.06), between(2e3, 2e4), Vector3d::UnitY()};
  const StraightTeeth teeth{2, 1, {test::kPi - between(0.3, 1), test::kPi}, test::kMaterial};
  const double period_s = between(0.002, 0.008);
  const ChipStiffness stiffness = test::stiffness_of(teeth);
  const CutInTime cut(stiffness.over_pitch, test::modes_of(std::vector{tool}));
  const double near = CutStability(stiffness.mean, test::modes_of(std::vector{tool})).at(period_s).share;
  const double limit = cut.limit(near, period_s);
  if (limit <= near / 2 || limit >= 2 * near) return;  // it is beyond
  std::set<bool> grows;
  for (double share = limit / 1.03; share < 1.03 * limit; share *= 1.005) grows.insert(cut.grows(share, period_s));
  EXPECT_EQ(grows.size(), 2u) << limit << " of " << near;
}

// Whoever has measured twenty modes waits for no minutes: the mean tells of them.
TEST(CutInTime, TellsNothingThatWouldTakeLong) {
  const auto over_pitch = test::stiffness_of({2, 1, test::kDown, test::kMaterial}).over_pitch;
  const Oscillator slow{100, 0.03, 6e3, Vector3d::UnitX()}, fast{12000, 0.03, 6e3, Vector3d::UnitX()};
  EXPECT_TRUE(CutInTime(over_pitch, test::modes_of(std::vector{fast})).can_tell(1, 0.005));
  EXPECT_FALSE(CutInTime(over_pitch, test::modes_of(std::vector{fast, slow})).can_tell(1, 0.005));
  EXPECT_FALSE(CutInTime(over_pitch, test::modes_of(std::vector{slow})).can_tell(1, 30));
}

// A round tool has one mode for all directions across it, told once.
TEST(CutInTime, TakesAModeOfManyDirectionsForOneInEach) {
  const StraightTeeth teeth{2, 1, {2.4, test::kPi}, test::kMaterial};
  const Oscillator x{900, 0.03, 6e3, Vector3d::UnitX()}, y{900, 0.03, 6e3, Vector3d::UnitY()};
  VibrationMode round = x.mode();
  round.directions = Vector3d(1, 1, 0).asDiagonal();
  const auto over_pitch = test::stiffness_of(teeth).over_pitch;
  const double apart = CutInTime(over_pitch, test::modes_of(std::vector{x, y})).limit(1, 0.004);
  EXPECT_NEAR(CutInTime(over_pitch, std::vector{round}).limit(1, 0.004), apart, 1e-6);
}

TEST(CutInTime, NeverGrowsWhereNothingGivesWayOrNothingIsCut) {
  const std::vector modes{Oscillator{400, 0.03, 8e3, Vector3d::UnitX()}.mode()};
  EXPECT_FALSE(CutInTime({}, modes).grows(1e3, 0.01));
  EXPECT_FALSE(CutInTime(test::stiffness_of({4, 2, test::kSlot, test::kMaterial}).over_pitch, {}).grows(1e3, 0.01));
}

// The mean over a turn is that of its moments, for teeth with a helix too.
TEST(ChipStiffness, IsInTheMeanWhatItIsFromMomentToMoment) {
  for (const double helix : {0.0, 30.0, 55.0}) {
    for (const Arc arc : {test::kSlot, test::kUp, Arc{2.2, 2.9}}) {
      const ChipStiffness stiffness = test::stiffness_of({3, 4, arc, test::kMaterial}, helix);
      Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
      for (const Eigen::Matrix3d& each : stiffness.over_pitch) sum += each / 72;
      EXPECT_LT((sum - stiffness.mean).norm(), 0.03 * stiffness.mean.norm()) << helix << " " << arc.entry;
    }
  }
}

}  // namespace
}  // namespace rmac::gateway
