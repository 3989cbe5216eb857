// The ring of samples and the recorder that reads it, without a controller: a thread of the test is the servo thread.
#include "gateway/servo/cycle_history.hpp"

#include <gtest/gtest.h>

#include <mutex>
#include <thread>

#include "gateway/record/flight_recorder.hpp"
#include "unit/gateway/device_driver_manager/fixtures.hpp"

namespace rmac::gateway {
namespace {

TEST(CycleHistory, GivesTheLastCyclesWholeWhileMoreAreAdded) {
  CycleHistory history(64);
  EXPECT_EQ(history.latest().cycle, 0);
  constexpr std::int64_t kLast = 5'000;
  std::thread servo([&] {
    CycleSample sample;
    for (std::int64_t cycle = 1; cycle <= kLast; ++cycle) {
      sample.cycle = cycle;
      sample.position.fill(static_cast<double>(cycle));
      sample.samples_lost = static_cast<std::uint64_t>(cycle);
      history.add(sample);
    }
  });
  CycleSample sample;
  std::int64_t seen = 0;
  while (seen < kLast) {
    for (std::int64_t cycle : {history.newest(), history.oldest(), history.newest() - 10}) {
      if (!history.read(cycle, sample)) continue;
      ASSERT_EQ(sample.cycle, cycle);
      ASSERT_EQ(sample.position.back(), static_cast<double>(cycle));
      ASSERT_EQ(sample.samples_lost, static_cast<std::uint64_t>(cycle));
    }
    const CycleSample latest = history.latest();
    ASSERT_GE(latest.cycle, seen);
    seen = latest.cycle;
  }
  servo.join();
  EXPECT_EQ(history.oldest(), kLast - 63);
  EXPECT_TRUE(history.read(kLast - 63, sample));
  EXPECT_FALSE(history.read(kLast - 64, sample)) << "overwritten";
  EXPECT_FALSE(history.read(kLast + 1, sample)) << "not yet";
}

TEST(FlightRecorder, MissesNoCycleOfAServoThreadThatWaitsForIt) {
  constexpr double kPeriod_s = 0.001;
  constexpr std::int64_t kShown = 100;
  const test::TemporaryFolder folder;
  const FlightRecorderOptions options{folder.path(), kShown * kPeriod_s, 1000};
  CycleHistory history(FlightRecorder::history_cycles(options, kPeriod_s));
  std::atomic<bool> ends{false};
  std::mutex cycles;  // a cycle that is asked for is still there
  std::vector<std::string> asked;
  {
    FlightRecorder recorder(options, kPeriod_s, history);
    std::thread servo([&] {
      CycleSample sample;
      sample.joint_count_with_held = sample.joint_count = sample.actuator_count = 2;
      while (!ends) {
        if (history.would_overwrite()) {
          std::this_thread::yield();
          continue;
        }
        const std::scoped_lock cycle(cycles);
        ++sample.cycle;
        sample.position.fill(static_cast<double>(sample.cycle));
        history.add(sample);
      }
    });
    while (asked.size() < 30) {
      const std::scoped_lock cycle(cycles);
      FlightHead head;
      head.cause = asked.size() % 2 == 0 ? FlightCause::Fault : FlightCause::Demand;
      head.cycle = history.newest();
      if (head.cycle < 2 * kShown) continue;
      if (auto name = recorder.request(std::move(head))) asked.push_back(*name);
    }
    std::size_t told = 0;
    while (told < asked.size()) {
      for (const auto& [head, written] : recorder.take_outcomes()) {
        EXPECT_TRUE(written) << written.error().message;
        EXPECT_EQ(head.first_cycle, head.cycle - kShown + 1);
        EXPECT_GE(head.last_cycle, head.cycle);
        ++told;
      }
      std::this_thread::yield();
    }
    ends = true;
    servo.join();
  }
  EXPECT_EQ(FlightFolder(folder.path()).list().size(), asked.size());
}

}  // namespace
}  // namespace rmac::gateway
