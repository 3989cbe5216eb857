#include "gateway/cutting/cutting_load.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "unit/gateway/material/solids.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kRpm = 6000, kFeed_mm_s = 20, kRays = 0.2, kDepth = 4, kTop = 20;

Tool mill(int teeth = 3) {
  Tool tool{.number = 7, .length_mm = 60};
  tool.shape = ToolShape{
      .dc = 10, .re = 0, .apmx = 15, .lcf = 15, .oal = 60, .zefp = teeth, .fha = 30, .shank = {}, .holder = {}};
  return tool;
}

WorkMaterial aluminium() {
  return {.name = "Al",
          .also_called = {},
          .coefficients = {.ktc = 800, .krc = 170, .kac = 220, .kte = 28, .kre = 31, .kae = 1.4},
          .tool = "",
          .source = ""};
}

/// What the model says of the slot.
TurnForces slot() {
  const std::vector<EngagedSlice> slices{{.from_mm = 0, .to_mm = kDepth, .arcs = {{0, pi}}}};
  const ToothFeed feed{.across_mm = kFeed_mm_s / (3 * kRpm / 60), .along_mm = 0};
  return forces_over_turn(EndMill::of(*mill().shape).value(), aluminium().coefficients, slices, feed, kRpm).value();
}

/// A tool that goes through a block, 4 mm deep.
class CuttingLoads : public testing::Test {
 protected:
  void go(const Tool& tool, double rpm = kRpm, SpindlePower power = {}, double until = 0) {
    load_.set_tool(tool);
    load_.set_spindle(rpm, power);
    const double every = load_.every_mm();
    const int steps = static_cast<int>((until + 30) / every);
    for (int i = 0; i < steps; ++i) step(-30 + i * every, -30 + (i + 1) * every);
  }
  void step(double from, double to) {
    t_s_ += (to - from) / kFeed_mm_s;
    for (const ProfilePiece& piece : cutting_profile(*mill().shape)) {
      test::remove_along(grid_, piece, 0.005, 1, [&](double t) {
        return ToolAt{{from + t * (to - from), 0.03, kTop - kDepth}, Vector3d::UnitZ()};
      });
    }
    const ToolAt at{{to, 0.03, kTop - kDepth}, Vector3d::UnitZ()};
    load_.cuts(grid_, at, {kFeed_mm_s, 0, 0}, t_s_, {.id = 5, .line = 12, .cutting = true});
  }
  DexelGrid grid_ = test::block(2 * kTop, kRays);
  CuttingLoad load_{aluminium(), kRays};
  double t_s_ = 1;
};

TEST_F(CuttingLoads, OfASlotAreThoseOfTheModel) {
  go(mill());
  const TurnForces wanted = slot();
  EXPECT_NEAR(load_.all().peak_n, wanted.total_n.peak, 0.03 * wanted.total_n.peak);
  EXPECT_NEAR(load_.all().peak_nm, wanted.torque_nm.peak, 0.03 * wanted.torque_nm.peak);
  EXPECT_NEAR(load_.all().peak_w, wanted.power_w.peak, 0.03 * wanted.power_w.peak);
  // It enters the block for its radius, 20 mm before it is in the middle; from there on it is in it whole.
  EXPECT_NEAR(load_.all().time_s, 25 / kFeed_mm_s, 1.1 / kFeed_mm_s);
  EXPECT_LT(load_.all().mean_nm, wanted.torque_nm.mean);
  EXPECT_GT(load_.all().mean_nm, 0.8 * wanted.torque_nm.mean);
  EXPECT_TRUE(load_.not_told().empty());
  ASSERT_EQ(load_.moves().size(), 1u);
  EXPECT_EQ(load_.moves().at(5).peak_n, load_.all().peak_n);
}

TEST_F(CuttingLoads, BeyondWhatTheSpindleHasAreToldWithLineTimeAndPlace) {
  const double steady = slot().torque_nm.mean, has = 0.5 * steady;
  go(mill(), kRpm, {.torque_nm = has, .power_w = 1e6}, 30);
  ASSERT_EQ(load_.overloads().size(), 1u);
  const Overload& found = load_.overloads().front();
  EXPECT_EQ(found.of, Overload::Of::Torque);
  EXPECT_EQ(found.line, 12);
  EXPECT_EQ(found.move_id, 5);
  EXPECT_EQ(found.allowed, has);
  // Not what it takes as it leaves the block.
  EXPECT_NEAR(found.most, steady, 0.03 * steady);
  EXPECT_NEAR(found.place[0], -kTop, 1);  // where its front half is in it for the first time
  EXPECT_NEAR(found.place[2], kTop - kDepth, 1e-9);
  // The cutter meets the block when its middle is 5 mm before it, and leaves it with its front first.
  EXPECT_GT(found.t_s, 1 + 5 / kFeed_mm_s);
  EXPECT_LT(found.t_s, 1 + 11 / kFeed_mm_s);
  EXPECT_GT(found.until_s, 1 + 40 / kFeed_mm_s);
  EXPECT_LT(found.until_s, 1 + 51 / kFeed_mm_s);
}

TEST_F(CuttingLoads, WithinWhatTheSpindleHasAreNoOverload) {
  go(mill(), kRpm, {.torque_nm = 1.05 * slot().torque_nm.mean, .power_w = 1.05 * slot().power_w.mean});
  EXPECT_GT(load_.all().peak_nm, 0);
  EXPECT_TRUE(load_.overloads().empty());
  go(mill(), kRpm, {.torque_nm = 0, .power_w = 0});  // it does not say
  EXPECT_TRUE(load_.overloads().empty());
}

TEST_F(CuttingLoads, OfAToolWithoutTeethAreNotTold) {
  go(mill(0));
  EXPECT_EQ(load_.all().time_s, 0);
  EXPECT_THAT(
      load_.not_told(),
      ElementsAre("forces of tool 7: its Shape does not say how many teeth it has; give ZEFP in the tool table"));
}

TEST_F(CuttingLoads, OfAToolWhoseSpeedIsNotKnownAreNotTold) {
  go(mill(), 0);
  EXPECT_THAT(load_.not_told(), ElementsAre("forces of tool 7: how fast it turns is not known, first in line 12"));
}

TEST_F(CuttingLoads, OfAFeedThatCannotBeAreNotTold) {
  go(mill(), 1);  // a speed in Hz, or a feed in mm/min
  EXPECT_THAT(load_.not_told(), ElementsAre(AllOf(HasSubstr("the feed per tooth is 400 mm"), HasSubstr("line 12"))));
}

}  // namespace
}  // namespace rmac::gateway
