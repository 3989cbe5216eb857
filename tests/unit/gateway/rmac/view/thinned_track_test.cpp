#include "gateway/rmac/view/thinned_track.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "gateway/rmac/view/step_track.hpp"

namespace rmac::cli {
namespace {

struct NumberWay {
  [[nodiscard]] static double between(double a, double b, double share) { return a + (b - a) * share; }
  [[nodiscard]] static double apart(double a, double b) { return std::abs(a - b); }
};
/// The same numbers, each held against the way, or all by how steep it may be.
template <typename Waiting>
class ThinnedTracks : public testing::Test {};
using Kinds = testing::Types<WaitingNumbers, WaitingValues<double, NumberWay>>;
TYPED_TEST_SUITE(ThinnedTracks, Kinds);

/// By the keys alone, as a page has it.
template <typename Track>
double value_at(const Track& track, double t_s) {
  const auto& keys = track.keys();
  const auto after = std::ranges::lower_bound(keys, t_s, {}, &Track::Key::t_s);
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
TYPED_TEST(ThinnedTracks, KeepEveryValueWithinWhatTheySay) {
  constexpr double kTolerance = 0.05, kRounding = 1e-9;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    for (const int coarsenings : {0, 1, 3}) {
      ThinnedTrack<TypeParam> track(kTolerance);
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

TYPED_TEST(ThinnedTracks, NeedFewKeysForRestAndForAStraightWay) {
  ThinnedTrack<TypeParam> track(0.01);
  for (int i = 0; i <= 600; ++i) track.add(i, i < 300 ? 0.0 : i - 300.0);
  track.end();
  EXPECT_LE(track.keys().size(), 15U);
  EXPECT_NEAR(value_at(track, 450), 150, 0.01);
}

TEST(ThinnedNumbers, NeedTwoKeysForAnyNumberOfNumbersOnALine) {
  ThinnedTrack<WaitingNumbers> track(0.01);
  for (int i = 0; i <= 100'000; ++i) track.add(i, 3 - 0.002 * i);
  track.end();
  ASSERT_EQ(track.keys().size(), 2U);
  EXPECT_NEAR(value_at(track, 50'000), -97, 0.01);
}

// Red when a name that comes again is another one, or holds from a wrong time on.
TEST(NamedSteps, KnowANameThatComesAgain) {
  NamedSteps steps(10);
  for (int i = 0; i < 6; ++i) steps.add(i, i / 2 == 1 ? "X velocity" : "feed");
  EXPECT_THAT(steps.names(), testing::ElementsAre("feed", "X velocity"));
  EXPECT_THAT(steps.steps().t_s(), testing::ElementsAre(0, 2, 4));
  EXPECT_THAT(steps.steps().values(), testing::ElementsAre(0, 1, 0));
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
    EXPECT_LE(many.values()[i], many.t_s()[i] * 60 + 1e-6) << "none is told before its time";
    EXPECT_GT(many.values()[i] + 1, (many.t_s()[i] - many.apart_s()) * 60) << "nor long behind it";
    if (i > 0) {
      EXPECT_GE(many.t_s()[i] - many.t_s()[i - 1], many.apart_s() - 1e-9);
    }
  }
}

TEST(StepTrack, NeverLeavesOutWhatHoldsForTwiceAsLongAsItIsCoarse) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> looks(1, 3);
    StepTrack track(20);
    std::vector<std::pair<double, int>> held;  // since when, what
    int look = 0;
    for (int value = 0; value < 200; ++value) {
      held.emplace_back(look / 60.0, value);
      const int until = look + (random() % 10 == 0 ? 600 : looks(random));
      for (; look < until; ++look) track.add(look / 60.0, value);
    }
    ASSERT_GT(track.apart_s(), 0);
    for (std::size_t i = 0; i < held.size(); ++i) {
      const double until_s = i + 1 < held.size() ? held[i + 1].first : look / 60.0;
      const double at_s = held[i].first + 2 * track.apart_s();
      if (at_s >= until_s) continue;
      const auto next = std::ranges::upper_bound(track.t_s(), at_s + 1e-9);
      EXPECT_EQ(track.values()[static_cast<std::size_t>(next - track.t_s().begin()) - 1], held[i].second) << seed;
    }
  }
}

}  // namespace
}  // namespace rmac::cli
