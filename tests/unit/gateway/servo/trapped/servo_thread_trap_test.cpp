#include <gmock/gmock.h>
#include <unistd.h>

#include <memory>
#include <mutex>

#include "places.hpp"
#include "trapping_clock.hpp"
#include "unit/gateway/device_driver_manager/fixtures.hpp"
#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using verifier::TrapCounts;

TEST(Trap, CatchesWhatAnArmedThreadDoesAndNothingElse) {
  std::thread([] {
    const bool system_calls = verifier::prepare_trap();
    (void)verifier::take_trap_counts();
    std::mutex mutex;
    const auto misbehave = [&mutex] {
      delete new volatile int(1);
      const std::lock_guard lock(mutex);
      (void)::getppid();
    };
    misbehave();
    TrapCounts counts = verifier::take_trap_counts();
    EXPECT_EQ(counts.allocations + counts.locks + counts.system_calls, 0U);
    verifier::arm_trap();
    misbehave();
    verifier::disarm_trap();
    counts = verifier::take_trap_counts();
    EXPECT_EQ(counts.allocations, 2U);
    EXPECT_EQ(counts.locks, 1U);
    EXPECT_EQ(counts.system_calls, system_calls ? 1U : 0U);
    EXPECT_FALSE(counts.first.empty());
  }).join();
}

class ServoThreadUnderTrap : public testing::Test {
 protected:
  ControllerOptions options(std::shared_ptr<Clock> clock) const {
    ControllerOptions real_pace = TestMachine::options();
    real_pace.as_fast_as_computed = false;
    real_pace.module_folders.emplace_back(RMAC_BINARY_DIR "/drivers/modules");
    real_pace.clock = std::move(clock);
    real_pace.flight_recorder = {folder_.path(), 1, 20};
    return real_pace;
  }
  static sdk::DeviceObject with_law(sdk::DeviceObject device, const char* law, const std::vector<double>& gains) {
    for (auto* joints : {&device.joints, &device.held_joints}) {
      for (sdk::Joint& joint : *joints) {
        joint.servo_law = {law, {}, {}};
        joint.gains = gains;
      }
    }
    return device;
  }
  sdk::RmacCam& cam() { return machine_.controller.cam(); }
  /// At least `count` cycles more.
  void let_run(std::int64_t count) {
    const std::int64_t until = clock_->cycles() + count;
    ASSERT_TRUE(machine_.run_until([&] { return clock_->cycles() >= until; }));
  }
  void stop() {
    ASSERT_TRUE(cam().cycle().stop_now());
    const auto at_rest = [&] {
      const CycleSample now = machine_.controller.sample();
      return !now.moving && now.state == CycleState::Idle;
    };
    ASSERT_TRUE(machine_.run_until(at_rest));
  }
  void expect_clean(const char* after) {
    const TrapCounts counts = verifier::take_trap_counts();
    EXPECT_EQ(counts.allocations, 0U) << after;
    EXPECT_EQ(counts.locks, 0U) << after;
    EXPECT_EQ(counts.system_calls, 0U) << after;
    EXPECT_EQ(counts.first, "") << after;
  }

  test::TemporaryFolder folder_;
  std::shared_ptr<TrappingClock> clock_ = std::make_shared<TrappingClock>(make_monotonic_clock(0.001));
  TestMachine machine_{options(clock_)};
};

TEST_F(ServoThreadUnderTrap, NeitherAllocatesNorLocksNorCallsTheSystem) {
  (void)verifier::take_trap_counts();
  ASSERT_TRUE(machine_.load_at_zero(TestMachine::mill()));
  expect_clean("loading and homing");

  ASSERT_TRUE(cam().path().set_feedrate(3000));
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {20, 5, 0}));
  ASSERT_TRUE(machine_.controller.cam().flow().in_turn(8, {sdk::OutputCall{"Coolant", true}}));
  ASSERT_TRUE(machine_.line(2, {20, 5, 0}, {0, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveStarted, 1));
  let_run(50);
  ASSERT_TRUE(cam().cycle().hold());
  let_run(200);
  ASSERT_TRUE(cam().cycle().resume());
  ASSERT_TRUE(cam().cycle().set_feed_override(150));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 2));
  stop();
  expect_clean("two moves with a hold, an override and a stop");

  for (const auto& [law, gains] : std::vector<std::pair<const char*, std::vector<double>>>{
           {"DMAC_PID_CONTROL", {1550, 140000, 11.1}},
           {"DMAC_FEEDFORWARDFEEDBACK_CONTROL", {1550, 140000, 11.1, 0.16, 0.035, 19, 0}},
           {"DMAC_FUZZY_CONTROL", {0.16, 22, 120, 140000}}}) {
    const auto changed = machine_.load(with_law(TestMachine::mill(), law, gains));
    ASSERT_TRUE(changed) << changed.error().message;
    ASSERT_TRUE(cam().path().set_feedrate(3000));
    ASSERT_TRUE(machine_.line(3, machine_.controller.sample().pose_set.tip, {2, 0, 0}));
    ASSERT_TRUE(machine_.line(4, {2, 0, 0}, {0, 0, 0}));
    ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
    machine_.events.clear();
    ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 4)) << law;
    stop();
    expect_clean(law);
  }

  ASSERT_TRUE(machine_.line(5, {0, 0, 0}, {20, 0, 0}));
  ASSERT_TRUE(machine_.line(6, {20, 0, 0}, {0, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveStarted, 5));
  for (const int joint : {0, 1}) {
    ASSERT_TRUE(machine_.controller.config().loops().set_servo_law(joint, {"DMAC_PID_CONTROL", {}, {}}));
    const std::array<double, 3> gains{1550, 140000, 11.1};
    ASSERT_TRUE(machine_.controller.config().loops().set_gains(joint, gains));
    const auto changed = machine_.controller.config().apply();
    ASSERT_TRUE(changed) << changed.error().message;
    let_run(50);
  }
  EXPECT_TRUE(machine_.controller.sample().moving);
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 6)) << machine_.last(Event::Kind::Fault);
  stop();
  expect_clean("two changes of law in motion");

  const auto plane = machine_.load(TestMachine::plane_mill());
  ASSERT_TRUE(plane) << plane.error().message;
  let_run(100);
  expect_clean("another mechanism");

  ASSERT_TRUE(cam().path().set_feedrate(3000));
  ASSERT_TRUE(machine_.line(7, machine_.controller.sample().pose_set.tip, {20, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveStarted, 7));
  let_run(50);
  ASSERT_TRUE(machine_.controller.record_flight());
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::FlightRecord));
  expect_clean("a flight record that was asked for");
  machine_.events.clear();
  machine_.bus->trip(1, 0x2310);
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::Fault, 7));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::FlightRecord));
  let_run(100);
  expect_clean("a drive's fault and its flight record");
  EXPECT_GT(clock_->cycles(), 1000);
  RecordProperty("cycles", std::to_string(clock_->cycles()));
  if (!clock_->catches_system_calls())
    GTEST_SKIP() << "this kernel has no syscall user dispatch: calls were not caught";
}

}  // namespace
}  // namespace rmac::gateway
