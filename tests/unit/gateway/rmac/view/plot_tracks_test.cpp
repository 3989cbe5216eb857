#include "gateway/rmac/view/plot_tracks.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "plotted.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::ElementsAre;

constexpr double kCycle_s = 0.001;

// Red when a plot is coarser than it says, when its number of keys is not bounded, or rounding is coarser than its
// bound.
TEST(PlotTracks, HoldEveryValueWithinWhatTheySay) {
  constexpr std::size_t kMost = 300;
  constexpr double kTolerance = 0.01;
  constexpr int kDigits = 4;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed);
    PlotTracks plots;
    plots.start({.row = "few", .name = "few", .unit = "mm", .tolerance = kTolerance, .digits = kDigits});
    plots.start(
        {.row = "many", .name = "many", .unit = "mm", .tolerance = kTolerance, .digits = kDigits, .most_keys = kMost});
    std::vector<Sample> values;
    double value = 0, rate = 0, noise = 0;
    for (int i = 0; i < 20'000; ++i) {
      if (random() % 300 == 0) rate = std::uniform_real_distribution<>(-0.01, 0.01)(random);
      if (random() % 1000 == 0) noise = random() % 2 == 0 ? 0 : 0.05;
      value += rate;
      values.push_back({i * kCycle_s, value + std::uniform_real_distribution<>(-noise, noise)(random)});
      for (const std::size_t plot : {0U, 1U}) plots.add(plot, values.back().t_s, values.back().value);
    }
    plots.end();
    const json told = plots.to_json();
    ASSERT_EQ(told.size(), 2U);
    const double rounding = 0.5 * std::pow(10, -kDigits) + 1e-9;
    for (const json& plot : told) {
      EXPECT_LE(farthest(plot, values), plot["within"].get<double>() + rounding) << "seed " << seed << plot["name"];
      EXPECT_EQ(plot["t"].size(), plot["is"].size());
    }
    EXPECT_EQ(told[0]["within"], kTolerance);
    EXPECT_GT(told[1]["within"], kTolerance);
    EXPECT_LE(told[1]["t"].size(), kMost + 1) << "the last one is always there";
    EXPECT_GT(told[1]["t"].size(), kMost / 20) << "so coarse it need not be";
  }
}

TEST(PlotTracks, NeedNothingForAnHourOfRest) {
  PlotTracks plots;
  plots.start({.row = "torque", .name = "torque", .unit = "N·m", .tolerance = 0.01, .digits = 3});
  for (int i = 0; i < 3'600'000; ++i) plots.add(0, i * kCycle_s, 0.25);
  plots.end();
  EXPECT_THAT(plots.to_json()[0]["is"], ElementsAre(0.25, 0.25));
}

TEST(PlotTracks, TellWhatTheyAreHeldAgainstAndLeaveOutWhatNeverWas) {
  PlotTracks plots;
  const PlotTracks::Kind kind{.row = "motors",
                              .name = "can0 1",
                              .unit = "of rated",
                              .tolerance = 0.01,
                              .digits = 2,
                              .levels = {{"rated", 1}, {"allowed", 3.5}}};
  const std::size_t still = plots.start(kind), turns = plots.start(kind);
  for (int i = 0; i < 10; ++i) plots.add(still, i, 0), plots.add(turns, i, -0.5 * i);
  plots.end();
  const json told = plots.to_json();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0], json({{"row", "motors"},
                           {"name", "can0 1"},
                           {"unit", "of rated"},
                           {"within", 0.01},
                           {"levels", {{{"name", "rated"}, {"is", 1.0}}, {{"name", "allowed"}, {"is", 3.5}}}},
                           {"t", {0.0, 9.0}},
                           {"is", {0.0, -4.5}}}));
}

}  // namespace
}  // namespace rmac::cli
