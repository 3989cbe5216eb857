#include <gmock/gmock.h>

#include <atomic>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::int64_t kMove = 7;

sdk::DeviceObject mill_with_sensor() {
  sdk::DeviceObject device = TestMachine::mill();
  device.joints[2].force_sensor = sdk::ForceSensor{"test", 2, 0.01, 0};
  return device;
}

/// A machine on its way, so slow that a fault finds it moving.
void start_slow_line(TestMachine& machine) {
  ASSERT_TRUE(machine.load_at_zero(mill_with_sensor()));
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(120));
  ASSERT_TRUE(machine.line(kMove, {0, 0, 0}, {40, 0, 0}));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until([&] { return !machine.samples.empty() && machine.samples.back().moving; }));
}

/// The cycle in which the samples show the fault first.
std::int64_t faulted_cycle(const TestMachine& machine) {
  for (const CycleSample& sample : machine.samples) {
    if (sample.fault.kind != ServoFault::Kind::None) return sample.cycle;
  }
  return -1;
}

TEST(Watching, SaysWhatHappenedInWhichCycleAndWhatToDo) {
  TestMachine machine;
  start_slow_line(machine);
  machine.bus->set_sensor_lost(true);
  ASSERT_TRUE(machine.run_until([&] { return machine.count(Event::Kind::Fault, kMove) > 0; }));
  // The event may be told a moment before the sample of its cycle.
  ASSERT_TRUE(machine.run_until([&] { return faulted_cycle(machine) >= 0; }));
  const Event stop = *machine.controller.last_stop();
  EXPECT_EQ(stop.kind, Event::Kind::Fault);
  EXPECT_EQ(stop.move_id, kMove);
  EXPECT_EQ(stop.cycle, faulted_cycle(machine));
  EXPECT_THAT(stop.message, AllOf(HasSubstr("joint 2 (Z)"), HasSubstr("force sensor gives no valid value"),
                                  HasSubstr("check the sensor"), HasSubstr("then reset"), HasSubstr("category 1")));
}

TEST(Watching, NamesTheBusThatFailed) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(mill_with_sensor()));
  machine.bus->set_bus_failed(true);
  ASSERT_TRUE(machine.run_until([&] { return !machine.last(Event::Kind::Fault).empty(); }));
  EXPECT_THAT(machine.last(Event::Kind::Fault), HasSubstr("bus test: the bus failed; check the interface, then reset"));
}

TEST(Watching, StopsUnderTheConfiguredCategoryAndGoesOnAfterAReset) {
  ControllerOptions options = TestMachine::options();
  options.stop_categories.sensor_lost = StopCategory::StopKeepPower;
  TestMachine machine(options);
  start_slow_line(machine);
  machine.bus->set_sensor_lost(true);
  ASSERT_TRUE(machine.run_until([&] { return machine.count(Event::Kind::Fault, kMove) > 0; }));
  EXPECT_THAT(machine.controller.last_stop()->message, HasSubstr("category 2"));
  const std::int64_t later = machine.controller.sample().cycle + 500;
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().cycle > later; }));
  const CycleSample held = machine.controller.sample();
  EXPECT_EQ(held.state, CycleState::Faulted);
  EXPECT_EQ(held.velocity_set[0], 0);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(held.statusword[axis] & 0x6F, 0x27) << "operation enabled";

  EXPECT_FALSE(machine.line(8, {0, 0, 0}, {1, 0, 0})) << "nothing moves before a reset";
  machine.bus->set_sensor_lost(false);
  const auto reset = machine.controller.cam().cycle().reset();
  ASSERT_TRUE(reset) << reset.error().message;
  const double x = machine.controller.sample().position_set[0];
  ASSERT_TRUE(machine.controller.cam().positioning().jog_joint(0, 2));
  ASSERT_TRUE(machine.run_until([&] { return std::abs(machine.controller.sample().position[0] - x - 2) < 0.1; }));
}

TEST(Watching, CategoryOneTakesThePowerAway) {
  TestMachine machine;
  start_slow_line(machine);
  machine.bus->set_sensor_lost(true);
  ASSERT_TRUE(machine.run_until([&] {
    const CycleSample now = machine.controller.sample();
    return now.state == CycleState::Faulted && (now.statusword[0] & 0x4F) == 0x40;  // switch on disabled
  }));
}

TEST(Watching, SilentDriveStopsTheOthersWithinTheirLimits) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(1500));
  ASSERT_TRUE(machine.line(kMove, {0, 0, 0}, {40, 20, 10}));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().position_set[0] > 1; }));
  machine.bus->set_online(2, false);
  ASSERT_TRUE(machine.run_until([&] { return machine.count(Event::Kind::Fault, kMove) > 0; }));
  EXPECT_THAT(machine.controller.last_stop()->message,
              AllOf(HasSubstr("axis 2"), HasSubstr("the drive does not answer"), HasSubstr("then reset"),
                    HasSubstr("category 2: every other joint brakes and is held under power")));
  const std::int64_t later = machine.controller.sample().cycle + 500;
  ASSERT_TRUE(machine.run_until([&] { return !machine.samples.empty() && machine.samples.back().cycle > later; }));
  const std::int64_t faulted = faulted_cycle(machine);
  int braking = 0;
  for (std::size_t i = 3; i < machine.samples.size(); ++i) {
    const auto at = [&](std::size_t back, std::size_t j) { return machine.samples[i - back].position_set[j]; };
    if (machine.samples[i].cycle < faulted) continue;
    for (std::size_t j = 0; j < 2; ++j) {
      const JointLimits& joint = machine.controller.mechanism()->joints[j].limits;
      ASSERT_LE(std::abs(at(0, j) - 2 * at(1, j) + at(2, j)), joint.max_acceleration * 1e-6 * 1.001);
      ASSERT_LE(std::abs(at(0, j) - 3 * at(1, j) + 3 * at(2, j) - at(3, j)), joint.max_jerk * 1e-9 * 1.001) << i;
    }
    braking += machine.samples[i].velocity_set[0] > 0 ? 1 : 0;
  }
  EXPECT_GT(braking, 20);
  const CycleSample& held = machine.samples.back();
  EXPECT_EQ(held.velocity_set[0], 0);
  for (std::size_t axis = 0; axis < 2; ++axis) EXPECT_EQ(held.statusword[axis] & 0x6F, 0x27) << "operation enabled";
}

TEST(Watching, OverloadedSpindleStopsTheMachineUnderPower) {
  TestMachine machine;
  sdk::DeviceObject device = TestMachine::mill();
  device.spindles[0].scale.rated_torque_nm = 5;
  ASSERT_TRUE(machine.load_at_zero(device));
  ASSERT_TRUE(machine.controller.cam().spindles().set_rpm(0, 600));
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().spindle_rpm[0] > 595; }));
  machine.bus->push(3, 7);
  ASSERT_TRUE(machine.run_until([&] { return !machine.last(Event::Kind::Fault).empty(); }));
  EXPECT_THAT(machine.controller.last_stop()->message,
              AllOf(HasSubstr("spindle 0 (bus test, axis 3)"), HasSubstr("5 N·m for a tenth of a second"),
                    HasSubstr("may give 5"), HasSubstr("then reset"), HasSubstr("category 2")));
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().spindle_rpm[0] == 0; }));
  EXPECT_EQ(machine.controller.sample().statusword[0] & 0x6F, 0x27) << "operation enabled";
}

TEST(Watching, BoundsThatAreNotDeclaredFollowFromTheJointsSpeed) {
  TestMachine machine;
  start_slow_line(machine);
  // A speed of 200 mm/s goes 0.6 mm in three cycles; a turn of the encoder is 5 mm.
  machine.bus->shift_encoder(1, static_cast<std::int32_t>(0.7 / 5 * 131072));
  ASSERT_TRUE(machine.run_until([&] { return machine.count(Event::Kind::Fault, kMove) > 0; }));
  EXPECT_THAT(machine.controller.last_stop()->message,
              AllOf(HasSubstr("joint 1 (Y)"), HasSubstr("jumped"), HasSubstr("motion explains 0.6")));
}

/// The machine's clock, which misses so many deadlines when it is told to.
class MissingClock final : public Clock {
 public:
  std::int64_t late_ns() const noexcept override { return 0; }
  void restart() noexcept override {}
  [[nodiscard]] std::uint64_t wait_for_cycle() noexcept override {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
    return missed.exchange(0);
  }
  std::atomic<std::uint64_t> missed{0};
};

TEST(Watching, MissedDeadlinesStopTheMachineBeyondTheirBound) {
  ControllerOptions options = TestMachine::options();
  const auto clock = std::make_shared<MissingClock>();
  options.as_fast_as_computed = false;
  options.clock = clock;
  options.max_cycles_lost = 5;
  options.stop_categories.cycles_lost = StopCategory::StopKeepPower;
  TestMachine machine(options);
  ASSERT_TRUE(machine.load(TestMachine::mill()));
  clock->missed = 5;
  const std::int64_t later = machine.controller.sample().cycle + 1500;
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().cycle > later; }));
  EXPECT_FALSE(machine.controller.last_stop().has_value()) << "as many as are allowed";
  clock->missed = 6;
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.last_stop().has_value(); }));
  EXPECT_THAT(machine.controller.last_stop()->message,
              AllOf(HasSubstr("6 deadlines were missed within a second, and 5 are allowed"), HasSubstr("category 2")));
}

}  // namespace
}  // namespace rmac::gateway
