#include "gateway/forces/turn_forces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "gateway/threads/sanitized.hpp"
#include "unit/gateway/forces/brute_force.hpp"

namespace rmac::gateway {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

/// As those of an aluminium; each differs from the others.
constexpr ForceCoefficients kMaterial{.ktc = 800, .krc = 170, .kac = 220, .kte = 28, .kre = 31, .kae = 1.4};
constexpr double kRpm = 6000, kFeed = 0.08;
constexpr int kTeeth = 4;

ToolShape shape(double re, double fha = 0, int teeth = kTeeth) {
  return {.dc = 12, .re = re, .apmx = 20, .lcf = 20, .oal = 60, .zefp = teeth, .fha = fha, .shank = {}, .holder = {}};
}

TurnForces forces(const ToolShape& tool, const std::vector<EngagedSlice>& slices, double feed = kFeed,
                  const ForceCoefficients& material = kMaterial) {
  return forces_over_turn(EndMill::of(tool).value(), material, slices, {.across_mm = feed, .along_mm = 0}, kRpm)
      .value();
}

std::vector<EngagedSlice> cut(double depth, Arc arc) {
  return {{.from_mm = 0, .to_mm = depth, .arcs = {arc}}};
}

constexpr Arc kSlot{0, pi}, kUp{0, pi / 2}, kDown{pi / 2, pi};

/// Means of a flat end mill with straight teeth (Altintas, Manufacturing Automation, ch. 2, the averages of milling
/// forces), z turned to the spindle.
std::array<double, 3> textbook(double depth, Arc arc, double feed) {
  const ForceCoefficients& k = kMaterial;
  const auto at = [&](double phi) -> std::array<double, 3> {
    const double na = kTeeth * depth, c = feed;
    return {na * c / (8 * pi) * (k.ktc * std::cos(2 * phi) - k.krc * (2 * phi - std::sin(2 * phi))) +
                na / (2 * pi) * (-k.kte * std::sin(phi) + k.kre * std::cos(phi)),
            na * c / (8 * pi) * (k.ktc * (2 * phi - std::sin(2 * phi)) + k.krc * std::cos(2 * phi)) -
                na / (2 * pi) * (k.kte * std::cos(phi) + k.kre * std::sin(phi)),
            -na / (2 * pi) * (-k.kac * c * std::cos(phi) + k.kae * phi)};
  };
  const auto exit = at(arc.exit), entry = at(arc.entry);
  return {exit[0] - entry[0], exit[1] - entry[1], exit[2] - entry[2]};
}

TEST(MillingForces, MeansOfStraightTeethAreThoseOfTheTextbook) {
  for (const Arc arc : {kSlot, kUp, kDown, Arc{0.3, 1.1}}) {
    const auto wanted = textbook(5, arc, kFeed);
    const TurnForces found = forces(shape(0), cut(5, arc));
    EXPECT_NEAR(found.x_n.mean, wanted[0], 1e-9) << arc.entry << " to " << arc.exit;
    EXPECT_NEAR(found.y_n.mean, wanted[1], 1e-9) << arc.entry << " to " << arc.exit;
    EXPECT_NEAR(found.z_n.mean, wanted[2], 1e-9) << arc.entry << " to " << arc.exit;
  }
}

TEST(MillingForces, MeansOfASlotHaveAFormOfTheirOwn) {
  const double na = kTeeth * 5.0;
  const TurnForces found = forces(shape(0), cut(5, kSlot));
  EXPECT_NEAR(found.x_n.mean, -na / 4 * kMaterial.krc * kFeed - na / pi * kMaterial.kre, 1e-9);
  EXPECT_NEAR(found.y_n.mean, na / 4 * kMaterial.ktc * kFeed + na / pi * kMaterial.kte, 1e-9);
  EXPECT_NEAR(found.z_n.mean, -na / pi * kMaterial.kac * kFeed - na / 2 * kMaterial.kae, 1e-9);
}

TEST(MillingForces, SumOverShortPiecesOfEdgeGivesTheSameForSlotAndHalfImmersion) {
  for (const Arc arc : {kSlot, kUp, kDown}) {
    const auto slices = cut(5, arc);
    const auto wanted = test::brute_force(shape(0), kMaterial, slices, {.across_mm = kFeed, .along_mm = 0}, 1440, 100);
    const TurnForces found = forces(shape(0), slices);
    EXPECT_NEAR(found.x_n.mean, wanted.mean(0), 0.001 * std::abs(wanted.mean(0))) << arc.entry;
    EXPECT_NEAR(found.y_n.mean, wanted.mean(1), 0.001 * std::abs(wanted.mean(1))) << arc.entry;
    EXPECT_NEAR(found.z_n.mean, wanted.mean(2), 0.001 * std::abs(wanted.mean(2))) << arc.entry;
    EXPECT_NEAR(found.y_n.peak, wanted.peak(1), 0.002 * std::abs(wanted.peak(1))) << arc.entry;
  }
}

TEST(MillingForces, ATwoToothedCutterInASlotPeaksWhereTheChipIsThickest) {
  const TurnForces found = forces(shape(0, 0, 2), cut(5, kSlot));
  // The nearest position that is looked at is half a degree beside it.
  EXPECT_NEAR(found.tangential_n.peak, 5 * (kMaterial.ktc * kFeed * std::cos(0.5 * pi / 180) + kMaterial.kte), 1e-6);
}

TEST(MillingForces, UpMillingPeaksWhereTheEdgeLeaves) {
  const double exit = 0.7;  // a fraction of a step of the tool's positions beside one
  const TurnForces found = forces(shape(0, 0, 1), cut(5, {0, exit}));
  EXPECT_NEAR(found.tangential_n.peak, 5 * (kMaterial.ktc * kFeed * std::sin(exit) + kMaterial.kte), 1e-5);
}

TEST(MillingForces, FourTeethInASlotShearSteadily) {
  const ForceCoefficients shear{.ktc = 800, .krc = 170, .kac = 0};
  const TurnForces found = forces(shape(0), cut(5, kSlot), kFeed, shear);
  EXPECT_NEAR(found.y_n.peak, found.y_n.mean, 1e-6 * found.y_n.mean);
  EXPECT_NEAR(found.x_n.peak, found.x_n.mean, 1e-6 * std::abs(found.x_n.mean));
}

TEST(MillingForces, ZeroFeedLeavesTheEdgeForcesAlone) {
  for (const double re : {0.0, 2.0, 6.0}) {
    ForceCoefficients edge = kMaterial;
    edge.ktc = edge.krc = edge.kac = 0;
    const TurnForces still = forces(shape(re), cut(5, kUp), 0), rubs = forces(shape(re), cut(5, kUp), 0, edge);
    EXPECT_DOUBLE_EQ(still.total_n.peak, rubs.total_n.peak) << re;
    EXPECT_DOUBLE_EQ(still.torque_nm.mean, rubs.torque_nm.mean) << re;
    // A quarter of the profile's length for each of four teeth.
    const double profile = re * std::acos((re - std::min(re, 5.0)) / std::max(re, 1e-9)) + std::max(0.0, 5 - re);
    EXPECT_NEAR(still.tangential_n.mean, kTeeth * profile * kMaterial.kte / 4, 1e-9) << re;
  }
}

TEST(MillingForces, HelixLeavesTheMeansOfShearAndLengthensTheEdge) {
  const double helix = 40;
  ForceCoefficients shear = kMaterial, edge = kMaterial;
  shear.kte = shear.kre = shear.kae = 0;
  edge.ktc = edge.krc = edge.kac = 0;
  const auto slices = cut(15, kUp);
  EXPECT_NEAR(forces(shape(0, helix), slices, kFeed, shear).y_n.mean, forces(shape(0), slices, kFeed, shear).y_n.mean,
              1e-9);
  EXPECT_NEAR(forces(shape(0, helix), slices, kFeed, edge).y_n.mean * std::cos(helix * pi / 180),
              forces(shape(0), slices, kFeed, edge).y_n.mean, 1e-9);
  EXPECT_LT(forces(shape(0, helix), slices, kFeed, shear).y_n.peak, forces(shape(0), slices, kFeed, shear).y_n.peak);
}

TEST(MillingForces, TheOtherSideMirrorsWhatIsAcrossTheFeed) {
  const Arc arc{0.2, 1.3}, mirrored{pi - 1.3, pi - 0.2};
  for (const double re : {0.0, 6.0}) {
    for (const bool tangential : {true, false}) {
      const ForceCoefficients k =
          tangential ? ForceCoefficients{.ktc = 800, .kte = 28} : ForceCoefficients{.krc = 170, .kre = 31};
      const TurnForces one = forces(shape(re, 30), cut(4, arc), kFeed, k);
      const TurnForces other = forces(shape(re, 30), cut(4, mirrored), kFeed, k);
      const double sign = tangential ? -1 : 1;
      EXPECT_NEAR(one.x_n.mean, sign * other.x_n.mean, 1e-9);
      EXPECT_NEAR(one.y_n.mean, -sign * other.y_n.mean, 1e-9);
      EXPECT_NEAR(one.torque_nm.mean, other.torque_nm.mean, 1e-12);
    }
  }
}

TEST(MillingForces, TorqueOfACylinderIsTangentialForceTimesItsRadius) {
  const TurnForces found = forces(shape(0, 35), cut(12, {0.4, 2.2}));
  EXPECT_NEAR(found.torque_nm.mean, found.tangential_n.mean * 6 / 1000, 1e-12);
  EXPECT_NEAR(found.torque_nm.peak, found.tangential_n.peak * 6 / 1000, 1e-9);
  EXPECT_NEAR(found.power_w.mean, found.torque_nm.mean * 2 * pi * kRpm / 60, 1e-9);
  EXPECT_NEAR(found.power_w.peak, found.torque_nm.peak * 2 * pi * kRpm / 60, 1e-9);
}

TEST(MillingForces, PowerIsThatOfTheChipAndOfTheEdge) {
  // Depth 5, width 4 of a cutter of radius 6, up-milling.
  const double depth = 5, width = 4;
  const Arc arc{0, std::acos(1 - width / 6)};
  const double feed_mm_s = kFeed * kTeeth * kRpm / 60, rate = depth * width * feed_mm_s;
  const double helix = 30, edge = kTeeth * depth / std::cos(helix * pi / 180) * kMaterial.kte * arc.exit / (2 * pi);
  const double speed_m_s = 0.006 * 2 * pi * kRpm / 60;
  const auto slices = cut(depth, arc);
  EXPECT_NEAR(removal_rate_mm3_s(EndMill::of(shape(0)).value(), slices, {kFeed, 0}, kRpm), rate, 1e-9 * rate);
  const double power = kMaterial.ktc * rate / 1000 + edge * speed_m_s;  // N/mm² · mm³/s = mW
  EXPECT_NEAR(forces(shape(0, helix), slices).power_w.mean, power, 1e-9 * power);
}

TEST(MillingForces, ABallTakesTheSegmentThatItMeets) {
  const double depth = 1.5, r = 6, feed_mm_s = kFeed * kTeeth * kRpm / 60;
  const double half = std::acos(1 - depth / r), segment = r * r * (half - std::sin(half) * std::cos(half));
  const double rate = removal_rate_mm3_s(EndMill::of(shape(6, 30)).value(), cut(depth, kSlot), {kFeed, 0}, kRpm);
  EXPECT_NEAR(rate, segment * feed_mm_s, 1e-6 * rate);
  // And shears it, whatever the radius at which it does.
  const ForceCoefficients shear{.ktc = 800};
  EXPECT_NEAR(forces(shape(6, 30), cut(depth, kSlot), kFeed, shear).power_w.mean, 0.8 * segment * feed_mm_s, 1e-4);
}

TEST(MillingForces, ABallAtSmallDepthIsPushedUp) {
  const double depth = 0.05, r = 6, k = std::acos(1 - depth / r);
  const ForceCoefficients edge{.kte = 28, .kre = 31};
  const TurnForces found = forces(shape(6), cut(depth, kSlot), kFeed, edge);
  EXPECT_NEAR(found.z_n.mean, kTeeth / 2.0 * edge.kre * r * std::sin(k), 1e-9);
  EXPECT_NEAR(found.torque_nm.mean, kTeeth / 2.0 * edge.kte * r * depth / 1000, 1e-12);
  EXPECT_GT(found.z_n.mean, 10 * std::abs(found.x_n.mean));
}

TEST(MillingForces, SlicesThatJoinGiveWhatTheWholeGives) {
  for (const double re : {0.0, 2.0, 6.0}) {
    std::vector<EngagedSlice> slices;
    for (int i = 0; i < 10; ++i) slices.push_back({.from_mm = i * 0.9, .to_mm = (i + 1) * 0.9, .arcs = {{0.4, 2.2}}});
    const TurnForces parts = forces(shape(re, 30), slices), whole = forces(shape(re, 30), cut(9, {0.4, 2.2}));
    EXPECT_NEAR(parts.y_n.mean, whole.y_n.mean, 1e-6 * whole.y_n.mean) << re;
    EXPECT_NEAR(parts.total_n.peak, whole.total_n.peak, 2e-3 * whole.total_n.peak) << re;
  }
}

/// Where each of the three ways leaves a chip, the force changes with it by its column: along y as a feed that is
/// turned by 90° does, along z as one that plunges.
TEST(MillingForces, ChangeWithTheFeedByTheStiffnessOfTheChip) {
  constexpr Arc kBothWays{0.2, 1.3}, kTurned{kBothWays.entry + pi / 2, kBothWays.exit + pi / 2};
  constexpr double kMore = 0.03;
  for (const double re : {0.0, 2.0, 6.0}) {
    for (const double helix : {0.0, 35.0}) {
      const EndMill mill = EndMill::of(shape(re, helix)).value();
      const auto mean = [&](Arc arc, double across, double along) {
        const std::vector<EngagedSlice> slices = cut(5, arc);
        const TurnForces found =
            forces_over_turn(mill, kMaterial, slices, {.across_mm = across, .along_mm = along}, kRpm).value();
        return Eigen::Vector3d(found.x_n.mean, found.y_n.mean, found.z_n.mean);
      };
      const std::vector<EngagedSlice> slices = cut(5, kBothWays);
      const Eigen::Matrix3d stiffness = chip_stiffness(mill, kMaterial, slices, {.across_mm = kFeed}, 8).value().mean;
      const double close = 1e-6 * stiffness.norm() * kMore;
      const Eigen::Vector3d faster = mean(kBothWays, kFeed + kMore, 0) - mean(kBothWays, kFeed, 0);
      EXPECT_LT((stiffness.col(0) * kMore - faster).norm(), close) << re << " " << helix;
      const Eigen::Vector3d turned = mean(kTurned, kFeed + kMore, 0) - mean(kTurned, kFeed, 0);
      const Eigen::Vector3d aside(-turned[1], turned[0], turned[2]);
      EXPECT_LT((stiffness.col(1) * kMore - aside).norm(), close) << re << " " << helix;
      const Eigen::Vector3d plunging = mean(kBothWays, kFeed, -kMore) - mean(kBothWays, kFeed, 0);
      EXPECT_LT((-stiffness.col(2) * kMore - plunging).norm(), close) << re << " " << helix;
    }
  }
}

TEST(MillingForces, RandomEngagementsAgreeWithASumOverShortPiecesOfEdge) {
  for (unsigned seed = 0; seed < (kSanitized ? 8 : 40); ++seed) {
    std::mt19937 random(seed);
    const auto between = [&random](double low, double high) {
      return std::uniform_real_distribution(low, high)(random);
    };
    ToolShape tool = shape(0);
    tool.dc = between(2, 30), tool.lcf = between(0.6, 2) * tool.dc, tool.zefp = 1 + static_cast<int>(between(0, 8));
    const double kind = between(0, 3);
    tool.re = kind < 1 ? 0 : kind < 2 ? between(0.05, 0.45) * tool.dc : tool.dc / 2;
    tool.fha = between(0, 1) < 0.2 ? 0 : between(5, 55);
    std::vector<EngagedSlice> slices;
    double z = between(0, 1) < 0.5 ? 0 : between(0, 0.2) * tool.lcf;
    for (int i = static_cast<int>(between(1, 5)); i > 0; --i) {
      const double to = z + between(0.05, 0.15) * tool.lcf, entry = between(0, 2.5);
      slices.push_back({.from_mm = z, .to_mm = to, .arcs = {{entry, entry + between(0.1, pi)}}});
      if (between(0, 1) < 0.3) slices.back().arcs = {{0.1, between(0.2, 1.2)}, {1.5, between(1.6, 3)}};
      z = to;
    }
    const ToothFeed feed{.across_mm = between(0.001, 0.02) * tool.dc,
                         .along_mm = between(0, 1) < 0.5 ? 0 : between(-0.01, 0.01) * tool.dc};
    // Straight edges enter and leave at once, and where a tool rises a chip ends somewhere along the edge: so many
    // positions, or so short pieces, have to find it.
    const int angles = tool.fha == 0 ? 7200 : 1440, pieces = feed.along_mm != 0 && tool.re > 0 ? 400 : 40;
    const auto wanted = test::brute_force(tool, kMaterial, slices, feed, angles, pieces);
    const TurnForces found = forces_over_turn(EndMill::of(tool).value(), kMaterial, slices, feed, kRpm).value();
    double scale = 0;
    for (const auto& at : wanted.at) scale = std::max(scale, std::hypot(at[0], at[1], at[2]));
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", RE " << tool.re << " of " << tool.dc << ", helix "
                                    << tool.fha);
    EXPECT_NEAR(found.x_n.mean, wanted.mean(0), 1e-3 * scale);
    EXPECT_NEAR(found.y_n.mean, wanted.mean(1), 1e-3 * scale);
    EXPECT_NEAR(found.z_n.mean, wanted.mean(2), 1e-3 * scale);
    EXPECT_NEAR(found.torque_nm.mean, wanted.mean(3), 1e-3 * wanted.peak(3));
    EXPECT_NEAR(found.tangential_n.mean, wanted.tangential_mean, 1e-3 * scale);
    EXPECT_NEAR(found.total_n.peak, scale, 2e-2 * scale);
    EXPECT_NEAR(found.torque_nm.peak, wanted.peak(3), 2e-2 * wanted.peak(3));
  }
}

TEST(MillingForces, WhatCannotBeSaysSoInOneLine) {
  const EndMill mill = EndMill::of(shape(0)).value();
  const auto refusal = [&](double depth, ToothFeed feed, double rpm) {
    return forces_over_turn(mill, kMaterial, cut(depth, kSlot), feed, rpm).error().message;
  };
  EXPECT_EQ(refusal(20.5, {kFeed, 0}, kRpm), "the cut is 20.5 mm deep, and the tool cuts up to LCF, 20 mm");
  EXPECT_EQ(refusal(5, {kFeed, 0}, 0), "the spindle stands: without its speed there is no feed per tooth");
  EXPECT_THAT(refusal(5, {80, 0}, kRpm), HasSubstr("allowed is 0 to its radius, 6 mm: is the feed in mm/s"));
  EXPECT_THAT(refusal(5, {-0.1, 0}, kRpm), HasSubstr("the feed per tooth is -0.1 mm across"));
}

TEST(MillingForces, AToolWithoutTeethIsRefused) {
  EXPECT_EQ(EndMill::of(shape(0, 0, 0)).error().message,
            "its Shape does not say how many teeth it has; give ZEFP in the tool table");
}

}  // namespace
}  // namespace rmac::gateway
