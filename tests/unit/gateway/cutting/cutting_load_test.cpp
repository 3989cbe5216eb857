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

/// A tool that goes through a block, 4 mm deep.
class CuttingLoads : public testing::Test {
 protected:
  void go(const Tool& tool, double rpm = kRpm, SpindlePower power = {}) {
    load_.set_tool(tool);
    load_.set_spindle(rpm, power);
    const double every = load_.every_mm();
    for (double x = -30; x < 0; x += every) step(x, x + every);
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
  const std::vector<EngagedSlice> slot{{.from_mm = 0, .to_mm = kDepth, .arcs = {{0, pi}}}};
  const ToothFeed feed{.across_mm = kFeed_mm_s / 300, .along_mm = 0};
  const TurnForces wanted =
      forces_over_turn(EndMill::of(*mill().shape).value(), aluminium().coefficients, slot, feed, kRpm).value();
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
  go(mill());
  const CuttingShare free = load_.all();
  EXPECT_TRUE(load_.overloads().empty());
  grid_ = test::block(2 * kTop, kRays);
  load_ = CuttingLoad(aluminium(), kRays);
  t_s_ = 1;
  go(mill(), kRpm, {.torque_nm = 0.9 * free.mean_nm, .power_w = 1e6});
  ASSERT_EQ(load_.overloads().size(), 1u);
  const Overload& found = load_.overloads().front();
  EXPECT_EQ(found.of, Overload::Of::Torque);
  EXPECT_EQ(found.line, 12);
  EXPECT_EQ(found.move_id, 5);
  EXPECT_GT(found.t_s, 1 + 5 / kFeed_mm_s);   // the tip meets the block
  EXPECT_LT(found.t_s, 1 + 11 / kFeed_mm_s);  // it is in it whole
  EXPECT_NEAR(found.until_s, t_s_, 1e-9);
  EXPECT_NEAR(found.place[2], kTop - kDepth, 1e-9);
  EXPECT_DOUBLE_EQ(found.allowed, 0.9 * free.mean_nm);
  EXPECT_GT(found.most, free.mean_nm);
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
