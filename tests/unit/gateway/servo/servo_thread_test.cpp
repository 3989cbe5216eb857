#include "gateway/servo/servo_thread.hpp"

#include <gmock/gmock.h>
#include <sys/mman.h>

#include <array>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

/// Keeps the real time of the monotonic clock, and says that one deadline was missed every time.
class LateClock final : public Clock {
 public:
  std::uint64_t wait_for_cycle() noexcept override { return clock_->wait_for_cycle() + 1; }
  std::int64_t late_ns() const noexcept override { return clock_->late_ns(); }
  void restart() noexcept override { clock_->restart(); }

 private:
  std::shared_ptr<Clock> clock_ = make_monotonic_clock(0.001);
};

TEST(RealPace, RunsAMovePlannedOnAnotherThread) {
  ControllerOptions options = TestMachine::options();
  options.as_fast_as_computed = false;
  TestMachine machine(options);
  const auto loaded = machine.load_at_zero(TestMachine::mill());
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(6000));
  ASSERT_TRUE(machine.line(1, {0, 0, 0}, {2, 0, 0}));
  ASSERT_TRUE(machine.line(2, {2, 0, 0}, {2, 2, 0}));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until_event(Event::Kind::MoveDone, 2));
  EXPECT_NEAR(machine.controller.sample().position_set[1], 2, 1e-6);
}

TEST(RealPace, CountsMissedDeadlines) {
  ControllerOptions options = TestMachine::options();
  options.as_fast_as_computed = false;
  options.clock = std::make_shared<LateClock>();
  TestMachine machine(options);
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().cycle >= 3; }));
  const CycleSample now = machine.controller.sample();
  EXPECT_GE(now.deadline_misses, static_cast<std::uint64_t>(now.cycle));
}

TEST(RealPace, SaysWhatRealTimeLacksAndHowToGrantIt) {
  ControllerOptions options = TestMachine::options();
  options.as_fast_as_computed = false;
  options.real_time = true;
  options.priority = 0;  // SCHED_FIFO has none below 1, whoever asks
  options.degraded_ok = false;
  Controller strict(options);
  const auto refused = strict.start();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("SCHED_FIFO priority 0 is not granted"));
  EXPECT_THAT(refused.error().message, HasSubstr("CAP_SYS_NICE"));

  options.degraded_ok = true;
  Controller degraded(options);
  EXPECT_TRUE(degraded.start());
  EXPECT_THAT(degraded.real_time_shortcomings(), testing::Contains(HasSubstr("SCHED_FIFO")));
  degraded.stop();
  ::munlockall();
}

TEST(SequenceLocked, IsNeverReadHalfWritten) {
  SequenceLocked<std::array<std::uint64_t, 64>> shared;
  std::atomic<bool> stop{false};
  std::thread writer([&] {
    std::array<std::uint64_t, 64> value{};
    while (!stop) {
      for (auto& word : value) ++word;
      shared.write(value);
    }
  });
  for (int i = 0; i < 20000; ++i) {
    const auto value = shared.read();
    ASSERT_EQ(value.front(), value.back());
  }
  stop = true;
  writer.join();
}

TEST(LatestValue, IsTheLastOneWrittenAndNeverHalfWritten) {
  LatestValue<std::array<std::uint64_t, 64>> shared;
  constexpr std::uint64_t kLast = 20000;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      std::array<std::uint64_t, 64> value{};
      value.fill(i);
      shared.write(value);
    }
  });
  std::uint64_t seen = 0;
  while (seen < kLast) {
    const auto& value = shared.read();
    ASSERT_EQ(value.front(), value.back());
    ASSERT_GE(value.front(), seen);
    seen = value.front();
  }
  writer.join();
}

}  // namespace
}  // namespace rmac::gateway
