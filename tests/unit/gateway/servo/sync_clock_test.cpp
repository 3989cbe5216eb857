#include "gateway/servo/sync_clock.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>

namespace rmac::gateway {
namespace {

using namespace std::chrono_literals;
using Time = std::chrono::nanoseconds;

/// A bus on which SYNC comes when a test says; its time passes while somebody waits.
class Timetable final : public fieldbus::CanPort {
 public:
  explicit Timetable(std::deque<Time>& syncs, Time& now) : syncs_(syncs), now_(now) {}
  bool send(const fieldbus::CanFrame&) noexcept override { return false; }
  bool receive(fieldbus::CanFrame& frame) noexcept override {
    if (syncs_.empty() || syncs_.front() > now_) return false;
    syncs_.pop_front();
    frame = {0x080, 0, {}, {}};
    return true;
  }
  void wait(Time at_most) noexcept override {
    now_ = std::min(now_ + at_most, syncs_.empty() ? Time::max() : std::max(syncs_.front(), now_));
  }
  Time now() const noexcept override { return now_; }
  fieldbus::CanHealth health() const noexcept override { return {}; }

 private:
  std::deque<Time>& syncs_;
  Time& now_;
};

class SyncPaced : public testing::Test {
 protected:
  Time now_{5s};
  std::deque<Time> syncs_;
  SyncClock clock_{std::make_unique<Timetable>(syncs_, now_), 0.001};

  struct Run {
    int cycles = 0;
    std::uint64_t missed = 0;
    Time shortest = Time::max(), longest{0};
  };
  Run run_until(Time end) {
    Run run;
    for (Time last = now_; now_ < end; ++run.cycles) {
      run.missed += clock_.wait_for_cycle();
      if (run.cycles > 0) run.shortest = std::min(run.shortest, now_ - last);
      run.longest = std::max(run.longest, now_ - last);
      last = now_;
    }
    return run;
  }
  void every(Time period, int count) {
    for (int i = 1; i <= count; ++i) syncs_.push_back(now_ + i * period);
  }
};

TEST_F(SyncPaced, EachSyncBeginsACycle) {
  every(1ms, 500);
  const Run run = run_until(5500ms);
  EXPECT_EQ(run.cycles, 500);
  EXPECT_EQ(run.missed, 0U);
}

TEST_F(SyncPaced, FollowsAProducerWhoseClockIsAnother) {
  every(1001us, 5000);
  const Run run = run_until(9s);
  EXPECT_EQ(run.missed, 0U);
  EXPECT_EQ(run.shortest, 1001us);
}

TEST_F(SyncPaced, GoesOnWithoutSyncAndCountsEachAsMissed) {
  every(1ms, 100);
  EXPECT_EQ(run_until(5100ms).missed, 0U);
  const Run silent = run_until(5200ms);
  EXPECT_EQ(silent.missed, static_cast<std::uint64_t>(silent.cycles));
  EXPECT_NEAR(silent.cycles, 67, 1) << "one and a half periods each";
  every(1ms, 100);
  (void)run_until(5210ms);
  EXPECT_EQ(run_until(5290ms).missed, 0U) << "whatever its phase, it is followed again";
}

TEST_F(SyncPaced, OneThatIsMissingIsMissedOnce) {
  every(1ms, 100);
  syncs_.erase(syncs_.begin() + 50);
  EXPECT_EQ(run_until(5100ms).missed, 1U);
}

TEST_F(SyncPaced, SyncThatComesTooOftenDoesNotMakeTheMachineFaster) {
  every(250us, 4000);
  const Run run = run_until(6s);
  EXPECT_LE(run.cycles, 1001);
  EXPECT_GE(run.missed, static_cast<std::uint64_t>(run.cycles));
}

TEST_F(SyncPaced, CyclesThatLastTooLongAreCounted) {
  every(1ms, 10);
  (void)clock_.wait_for_cycle();
  now_ += 3400us;
  EXPECT_EQ(clock_.wait_for_cycle(), 2U);
}

TEST_F(SyncPaced, OverSeededJitterTheMachineIsNeverATenthFasterThanItShouldBe) {
  std::mt19937 random(5);
  for (int round = 0; round < 100; ++round) {
    syncs_.clear();
    Time at = now_;
    for (int i = 0; i < 200; ++i) {
      at += Time(std::uniform_int_distribution<std::int64_t>(100'000, 2'500'000)(random));
      syncs_.push_back(at);
    }
    clock_.restart();
    const Time begun = now_;
    const Run run = run_until(at);
    EXPECT_LE(run.cycles * 900us, at - begun + 1ms);
    EXPECT_GE(run.shortest, 400us);
    EXPECT_LE(run.longest, 1500us);
  }
}

TEST(SyncClock, SaysWhatIsWrongWithItsInterface) {
  const auto refused = SyncClock::on("can-not", 0.001);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("can-not"), std::string::npos) << refused.error().message;
}

}  // namespace
}  // namespace rmac::gateway
