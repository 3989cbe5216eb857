#include "gateway/rmac/view/thinned_track.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "gateway/rmac/view/step_track.hpp"

namespace rmac::cli {
namespace {

using Track = ThinnedTrack<double, NumberWay>;

/// By the keys alone, as a page has it.
double value_at(const Track& track, double t_s) {
  const auto& keys = track.keys();
  const auto after = std::ranges::find_if(keys, [t_s](const Track::Key& key) { return key.t_s >= t_s; });
  if (after == keys.begin()) return after->value;
  if (after == keys.end()) return keys.back().value;
  const auto& before = *(after - 1);
  return before.value + (after->value - before.value) * (t_s - before.t_s) / (after->t_s - before.t_s);
}

/// A walk of rests, ramps and noise.
std::vector<std::pair<double, double>> walk(unsigned seed, std::size_t count) {
  std::mt19937_64 random(seed);
  std::vector<std::pair<double, double>> values;
  double value = 0, rate = 0, noise = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (random() % 40 == 0) rate = static_cast<double>(random() % 3) - 1;
    if (random() % 100 == 0) noise = random() % 2 == 0 ? 0 : 0.3;
    value += rate * 0.1;
    values.emplace_back(static_cast<double>(i) / 60,
                        value + noise * std::uniform_real_distribution<double>(-1, 1)(random));
  }
  return values;
}

// Red when what waits is not held against the new key, or when a coarser track counts its second error alone.
TEST(ThinnedTrack, KeepsEveryValueWithinWhatItSays) {
  constexpr double kTolerance = 0.05, kRounding = 1e-9;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    for (const int coarsenings : {0, 1, 3}) {
      Track track(kTolerance);
      const auto values = walk(seed, 3000);
      for (std::size_t i = 0; i < values.size(); ++i) {
        track.add(values[i].first, values[i].second);
        // In the midst, with values that wait.
        if (i % 1000 == 777 && static_cast<int>(i / 1000) < coarsenings) track.coarsen();
      }
      track.end();
      double worst = 0;
      for (const auto& [t_s, value] : values) worst = std::max(worst, std::abs(value_at(track, t_s) - value));
      EXPECT_LE(worst, track.within() + kRounding) << "seed " << seed << ", coarser " << coarsenings << " times";
      EXPECT_DOUBLE_EQ(track.keys().front().t_s, values.front().first);
      EXPECT_DOUBLE_EQ(track.keys().back().t_s, values.back().first);
      EXPECT_LT(track.keys().size(), values.size());
    }
  }
}

TEST(ThinnedTrack, NeedsFewKeysForRestAndForAStraightWay) {
  Track track(0.01);
  for (int i = 0; i <= 600; ++i) track.add(i, i < 300 ? 0.0 : i - 300.0);
  track.end();
  EXPECT_LE(track.keys().size(), 15U);
  EXPECT_NEAR(value_at(track, 450), 150, 0.01);
}

TEST(StepTrack, KeepsEachChangeUntilThereAreTooMany) {
  StepTrack few(10), many(10);
  for (int i = 0; i < 5; ++i) few.add(i, 7 + i / 2);
  EXPECT_THAT(few.t_s(), testing::ElementsAre(0, 2, 4));
  EXPECT_THAT(few.values(), testing::ElementsAre(7, 8, 9));
  EXPECT_EQ(few.apart_s(), 0);
  for (int i = 0; i < 100'000; ++i) many.add(i / 60.0, i);
  ASSERT_LE(many.t_s().size(), 10U);
  ASSERT_GE(many.t_s().size(), 4U);
  for (std::size_t i = 0; i < many.t_s().size(); ++i) {
    EXPECT_NEAR(many.values()[i], many.t_s()[i] * 60, 1e-6) << "a value has its own time";
    if (i > 0) {
      EXPECT_GE(many.t_s()[i] - many.t_s()[i - 1], many.apart_s() - 1e-9);
    }
  }
}

}  // namespace
}  // namespace rmac::cli
