#include "gateway/material/material.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "gateway/material/stock_model.hpp"
#include "rmac/modules/chain_kinematics.hpp"
#include "unit/gateway/material/solids.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;
using test::body_of;

/// A table that turns about x and z below three slides; the tool's tip is in the origin with all joints at its length.
LinkChain trunnion() {
  using modules::ScrewAxis;
  const std::vector<ScrewAxis> axes{{JointType::Linear, {1, 0, 0}, {}},
                                    {JointType::Linear, {0, 1, 0}, {}},
                                    {JointType::Linear, {0, 0, 1}, {}},
                                    {JointType::Rotary, {1, 0, 0}, {0, 0, -20}},
                                    {JointType::Rotary, {0, 0, 1}, {}}};
  const modules::ChainKinematics kinematics{axes, {4, 3, 0, 1, 2}, Frame{}};
  const std::vector<std::string> chain{"C", "A", "base", "X", "Y", "Z"}, names{"X", "Y", "Z", "A", "C"};
  return LinkChain::make(kinematics, chain, names, std::vector<std::pair<double, double>>(5, {-200, 200})).value();
}

constexpr double kLength = 50;

Tool ball() {
  Tool tool{.number = 7, .length_mm = kLength};
  tool.shape = ToolShape{.dc = 4, .re = 2, .apmx = 6, .lcf = 6, .oal = 50, .shank = {{2, 2, 44}}, .holder = {}};
  return tool;
}

class MaterialOnFiveAxes : public testing::Test {
 protected:
  void set_up(const Tool& tool, double resolution = 0.2) {
    const Stock stock = Stock::read(body_of(BoxShape{{20, 20, 20}})).value();
    material_.emplace(trunnion(), model_of(stock, resolution).value(), Frame{}, findings_);
    material_->set_tool(tool);
    before_ = material_->grid().volume_mm3();
  }
  /// Straight in the joints, so many cycles.
  void go(std::array<double, 5> to, int cycles, bool cutting = true, bool turns = true) {
    ++move_;
    const auto from = at_;
    for (int i = 1; i <= cycles; ++i) {
      for (std::size_t j = 0; j < 5; ++j) at_[j] = from[j] + (to[j] - from[j]) * i / cycles;
      auto joints = at_;
      joints[2] += kLength;
      t_s_ += 0.001;
      material_->advance(t_s_, joints, {.id = move_, .line = move_, .cutting = cutting}, turns);
    }
  }
  [[nodiscard]] double removed() {
    material_->finish();
    const RemovedVolume removed = material_->removed();
    EXPECT_NEAR(material_->left_mm3(), before_ - removed.mm3, 1e-9 * before_);
    return removed.mm3;
  }
  [[nodiscard]] std::vector<Finding> met() {
    material_->finish();
    return findings_.sorted();
  }

  FindingList findings_{Frame{}};
  std::optional<Material> material_;
  std::array<double, 5> at_{0, 0, 40, 0, 0};
  int move_ = 0;
  double t_s_ = 0, before_ = 0;
};

TEST_F(MaterialOnFiveAxes, LosesALayerThinnerThanTheRaysAreApart) {
  Tool face{.number = 8, .length_mm = kLength};
  face.shape = ToolShape{.dc = 60, .re = 0, .apmx = 10, .lcf = 10, .oal = 20, .shank = {{10, 10, 10}}, .holder = {}};
  for (const double layer : {0.02, 0.4, 0.6, 0.97}) {
    set_up(face, 1);
    at_ = {-60, 0, 40, 0, 0};
    go({-60, 0, 10 - layer, 0, 0}, 10);
    go({60, 0, 10 - layer, 0, 0}, 100);
    EXPECT_NEAR(removed() / (20 * 20 * layer), 1, 0.02) << layer << " mm off the top";
  }
}

TEST_F(MaterialOnFiveAxes, TellsAShankThatItWouldNotFind) {
  set_up(ball(), 0.5);
  EXPECT_EQ(material_->set_tool(ball()), "");
  set_up(ball(), 2);
  EXPECT_THAT(material_->set_tool(ball()),
              testing::HasSubstr("tool 7: its shank or holder is no thicker than the rays"));
}

TEST_F(MaterialOnFiveAxes, LosesASlotToATipThatGoesAcross) {
  set_up(ball());
  go({-30, 0, 8, 0, 0}, 50);
  go({30, 0, 8, 0, 0}, 600);
  const double above_middle = 0;  // the ball's middle is in the top
  EXPECT_NEAR(removed() / (20 * (std::numbers::pi * 4 / 2 + above_middle)), 1, 0.005);
  EXPECT_TRUE(met().empty());
}

/// The table turns once under a tip that stands: a torus, whatever the cycle is, as strokes follow the joints and not
/// the chords between samples.
TEST_F(MaterialOnFiveAxes, LosesATorusToATableThatTurnsUnderTheTip) {
  for (const int cycles : {12, 4000}) {
    set_up(ball());
    at_ = {6, 0, 40, 0, 0};
    go({6, 0, 8, 0, 0}, 100);
    go({6, 0, 8, 0, 360}, cycles);
    // Half of the torus is in the block: its middle circle lies in the top.
    EXPECT_NEAR(removed() / (2 * std::numbers::pi * 6 * std::numbers::pi * 4 / 2), 1, 0.005) << cycles;
  }
}

TEST_F(MaterialOnFiveAxes, StaysWholeUnderASpindleThatStandsAndSaysSo) {
  set_up(ball());
  go({0, 0, 9, 0, 0}, 200, true, false);
  EXPECT_EQ(removed(), 0);
  ASSERT_EQ(met().size(), 1U);
  const Finding found = met().front();
  EXPECT_EQ(found.second, "tool 7, cutting part");
  EXPECT_EQ(found.why, "the spindle stands");
  EXPECT_TRUE(found.collision);
  EXPECT_FALSE(found.possible);
  EXPECT_NEAR(found.depth_mm, 1, 0.05);
  EXPECT_NEAR(found.place[2], 10, 1);
}

TEST_F(MaterialOnFiveAxes, TellsARapidThroughWhatIsThereAndNotThroughWhatIsGone) {
  set_up(ball());
  go({-30, 0, 8, 0, 0}, 50);
  go({30, 0, 8, 0, 0}, 600);
  // Back through the slot, then beside it.
  go({-30, 0, 8, 0, 0}, 100, false);
  EXPECT_TRUE(met().empty());
  go({-30, 5, 8, 0, 0}, 20, false);
  go({30, 5, 8, 0, 0}, 100, false);
  ASSERT_EQ(met().size(), 1U);
  EXPECT_EQ(met().front().why, "positioning move");
  EXPECT_EQ(met().front().line, 5);
}

TEST_F(MaterialOnFiveAxes, TellsAShankInWhatIsStillThere) {
  set_up(ball());
  go({-30, 0, 5, 0, 0}, 50);
  go({30, 0, 5, 0, 0}, 600);
  EXPECT_TRUE(met().empty()) << "5 mm deep, and it cuts 6";
  go({30, 6, 2, 0, 0}, 50);
  go({-30, 6, 2, 0, 0}, 600);
  ASSERT_FALSE(met().empty()) << "8 mm deep";
  EXPECT_EQ(met().front().second, "tool 7, shank");
  EXPECT_EQ(met().front().why, "it does not cut");
  EXPECT_NEAR(met().front().depth_mm, 2, 0.6);
}

TEST_F(MaterialOnFiveAxes, LosesNothingToAToolWithoutShape) {
  Tool tool = ball();
  tool.shape.reset();
  set_up(tool);
  go({0, 0, 0, 0, 0}, 100);
  EXPECT_EQ(removed(), 0);
}

TEST(StockModel, RefusesWhatDoesNotFitBeforeItIsTakenAndSaysWhatWould) {
  const Stock stock = Stock::read(body_of(BoxShape{{300, 200, 100}})).value();
  const auto fine = model_of(stock, 0.001);
  ASSERT_FALSE(fine);
  EXPECT_EQ(
      fine.error().message,
      "a resolution of 0.001 mm takes 2.09e+03 GB of memory for a stock of 300 x 200 x 100 mm; 0.05 mm takes less "
      "than 2 GB");
  for (const double wrong : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    const auto none = model_of(stock, wrong);
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message, testing::HasSubstr("give one above 0"));
  }
  const auto usual = model_of(stock, std::nullopt);
  ASSERT_TRUE(usual);
  EXPECT_NEAR(usual->layout().pitch[0], 0.2, 1e-9);
  EXPECT_LE(usual->bytes(), 64e6);
}

}  // namespace
}  // namespace rmac::gateway
