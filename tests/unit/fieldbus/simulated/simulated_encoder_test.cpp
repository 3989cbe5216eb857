#include "rmac/fieldbus/simulated_encoder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace {

using namespace rmac::fieldbus;

constexpr double kTurn = 2 * std::numbers::pi;

TEST(SimulatedEncoder, CountsWholeStepsDownwards) {
  const SimulatedEncoder encoder({.counts_per_revolution = 1000});
  EXPECT_EQ(encoder.counts(0), 0);
  EXPECT_EQ(encoder.counts(0.0105 * kTurn), 10);
  EXPECT_EQ(encoder.counts(-0.0105 * kTurn), -11);
}

TEST(SimulatedEncoder, HasNoiseOfItsSpreadOnceACycleAndTheSameOfTheSameSeed) {
  const EncoderParameters parameters{.counts_per_revolution = 1e6, .noise_counts = 20, .seed = 5};
  SimulatedEncoder encoder(parameters), twin(parameters);
  double sum = 0, squares = 0;
  constexpr int kCycles = 20000;
  for (int i = 0; i < kCycles; ++i) {
    encoder.sample();
    twin.sample();
    const double off = encoder.counts(0) + 0.5;
    ASSERT_EQ(encoder.counts(0), encoder.counts(0)) << "one answer a cycle";
    ASSERT_EQ(twin.counts(0), encoder.counts(0));
    sum += off;
    squares += off * off;
  }
  EXPECT_NEAR(sum / kCycles, 0, 0.5);
  EXPECT_NEAR(std::sqrt(squares / kCycles), 20, 0.5);
  SimulatedEncoder other({.counts_per_revolution = 1e6, .noise_counts = 20, .seed = 6});
  int same = 0;
  for (int i = 0; i < 100; ++i) {
    encoder.sample();
    other.sample();
    same += encoder.counts(0) == other.counts(0) ? 1 : 0;
  }
  EXPECT_LT(same, 20);
}

TEST(SimulatedEncoder, ErrsWithinASignalPeriodAndNotFromOneToTheNext) {
  const SimulatedEncoder encoder({.counts_per_revolution = 1e6, .interpolation_counts = 30, .signal_periods = 500});
  for (int k = 0; k < 500; ++k) {
    const double start = k * kTurn / 500;
    EXPECT_NEAR(encoder.counts(start), k * 2000, 1.1);
    EXPECT_NEAR(encoder.counts(start + kTurn / 2000), k * 2000 + 500 + 30, 1.1);
    EXPECT_NEAR(encoder.counts(start + 3 * kTurn / 2000), k * 2000 + 1500 - 30, 1.1);
  }
}

TEST(SimulatedEncoder, StandsStillWhileItIsFrozenAndWrapsAt32Bits) {
  SimulatedEncoder encoder({.counts_per_revolution = 1000});
  encoder.freeze(true, 1.0005 * kTurn);
  encoder.freeze(true, 2 * kTurn);
  EXPECT_EQ(encoder.counts(3 * kTurn), 1000) << "from the first time";
  encoder.freeze(false, 3 * kTurn);
  encoder.shift(INT32_MAX);
  encoder.shift(1);
  EXPECT_EQ(encoder.counts(0.0005 * kTurn), INT32_MIN);
}

}  // namespace
