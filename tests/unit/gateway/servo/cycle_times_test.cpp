#include "gateway/servo/cycle_times.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

TEST(TimeCounts, BinsFollowEachOtherWithoutAGap) {
  for (std::size_t bin = 0; bin + 1 < TimeCounts::kBins; ++bin) {
    EXPECT_EQ(TimeCounts::bin_of(TimeCounts::end_of(bin)), bin);
    EXPECT_EQ(TimeCounts::bin_of(TimeCounts::end_of(bin) + 1), bin + 1);
  }
  EXPECT_EQ(TimeCounts::bin_of(-5), 0U);
  EXPECT_EQ(TimeCounts::bin_of(std::numeric_limits<std::int64_t>::max()), TimeCounts::kBins - 1);
}

TEST(TimeHistogram, QuantilesOverSeededTimesAreThoseOfTheTimesToWithinABin) {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    TimeHistogram histogram;
    std::vector<std::int64_t> times(1 + random() % 2000);
    const double spread = std::uniform_real_distribution(1.0, 20.0)(random);
    for (auto& time : times) {
      time = static_cast<std::int64_t>(std::exp(std::uniform_real_distribution(0.0, spread)(random)));
      histogram.add(time);
    }
    std::sort(times.begin(), times.end());
    const TimeCounts counts = histogram.read();
    EXPECT_EQ(counts.count, times.size());
    EXPECT_EQ(counts.largest_ns, times.back());
    for (const double part : {0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const auto rank = static_cast<std::size_t>(std::ceil(part * static_cast<double>(times.size())));
      const std::int64_t exact = times[std::max<std::size_t>(rank, 1) - 1];
      EXPECT_GE(counts.quantile_ns(part), exact);
      EXPECT_LE(counts.quantile_ns(part), exact + exact / TimeCounts::kOctave + 1);
    }
  }
}

TEST(TimeHistogram, HasNothingToTellOfNothing) {
  TimeHistogram histogram;
  EXPECT_EQ(histogram.read().quantile_ns(0.5), 0);
  histogram.add(700);
  histogram.clear();
  EXPECT_EQ(histogram.read().count, 0U);
  EXPECT_EQ(histogram.read().largest_ns, 0);
}

/// A clock that is late by what it is told, without being so.
class ToldClock final : public Clock {
 public:
  std::uint64_t wait_for_cycle() noexcept override { return clock_->wait_for_cycle(); }
  std::int64_t late_ns() const noexcept override { return 12'345; }
  void restart() noexcept override { clock_->restart(); }

 private:
  std::shared_ptr<Clock> clock_ = make_monotonic_clock(0.001);
};

TEST(CycleTimes, CountEveryCycleAtRealPaceSinceTheMechanismWasPutIn) {
  ControllerOptions options = TestMachine::options();
  options.as_fast_as_computed = false;
  options.clock = std::make_shared<ToldClock>();
  TestMachine machine(options);
  const auto cycles = [&] { return machine.controller.cycle_times().compute.read().count; };
  ASSERT_TRUE(machine.run_until([&] { return cycles() > 30; }));
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  ASSERT_TRUE(machine.run_until([&] { return cycles() > 30; }));
  const CycleTimes& times = machine.controller.cycle_times();
  const TimeCounts wake_up = times.wake_up.read();
  EXPECT_EQ(wake_up.largest_ns, 12'345);
  EXPECT_EQ(wake_up.bins[TimeCounts::bin_of(12'345)], wake_up.count);
  EXPECT_LE(wake_up.count, static_cast<std::uint64_t>(machine.controller.sample().cycle));
  EXPECT_GT(times.bus.read().quantile_ns(0.5), 0) << "the simulated drives are computed in the exchange";
  EXPECT_GT(times.compute.read().quantile_ns(0.5), 0);
}

TEST(CycleTimes, KnowNoWakeUpsInVirtualTime) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  EXPECT_EQ(machine.controller.cycle_times().wake_up.read().count, 0U);
  EXPECT_GT(machine.controller.cycle_times().compute.read().count, 0U);
}

}  // namespace
}  // namespace rmac::gateway
