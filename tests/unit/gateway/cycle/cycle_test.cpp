#include <gmock/gmock.h>

#include <array>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

/// A mill at rest in its origin, with a feed set.
class Cycle : public testing::Test {
 protected:
  void SetUp() override {
    const auto loaded = machine_.load_at_zero(TestMachine::mill());
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_TRUE(cam().path().set_feedrate(6000));
  }
  sdk::RmacCam& cam() { return machine_.controller.cam(); }
  /// Under way on a line so slow that the machine cannot be at its end before the test has looked: in virtual time it
  /// is at most the sample ring's 4096 cycles ahead of what was dispatched.
  void start_slow_line() {
    ASSERT_TRUE(cam().path().set_feedrate(120));
    ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {40, 0, 0}));
    ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
    ASSERT_TRUE(machine_.run_until([&] { return !machine_.samples.empty() && machine_.samples.back().moving; }));
  }
  CycleState state() { return machine_.controller.sample().state; }
  TestMachine machine_;
};

TEST_F(Cycle, AMoveToWhereTheToolWillStandIsDoneInItsTurn) {
  const ToolPose corner{{10, 0, 0}, {0, 0, 1}};
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, corner.tip));
  ASSERT_TRUE(cam().queue().add(2, PathTargetGeometry{corner}));
  ASSERT_TRUE(cam().queue().add(3, JointTargetGeometry{{10, 0, 0}}));
  ASSERT_TRUE(machine_.line(4, corner.tip, {10, 5, 0}));
  machine_.controller.dispatch();
  EXPECT_EQ(machine_.count(Event::Kind::MoveDone, 2), 0) << "move 1 is before it";
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 4));
  std::vector<std::int64_t> begun, done;
  for (const Event& event : machine_.events) {
    if (event.kind == Event::Kind::MoveStarted) begun.push_back(event.move_id);
    if (event.kind == Event::Kind::MoveDone) done.push_back(event.move_id);
  }
  EXPECT_THAT(begun, testing::ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(done, testing::ElementsAre(1, 2, 3, 4));
}

TEST_F(Cycle, EventsAreToldInTheOrderInWhichTheyHappenedHoweverLate) {
  constexpr std::int64_t kNearlyAll = 4000;  // cycles that the machine may be ahead
  Vector at{0, 0, 0};
  for (std::int64_t id = 1; id <= 6; ++id) {
    const Vector next{id % 2 == 0 ? 0.0 : 5.0, static_cast<double>(id), 0};
    ASSERT_TRUE(machine_.line(id, at, next));
    at = next;
  }
  ASSERT_TRUE(machine_.run_until([&] { return !machine_.samples.empty(); }));
  machine_.events.clear();
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  while (cam().queue().moves_left() > 0) {
    const bool waits = machine_.controller.sample().cycle - machine_.samples.back().cycle >= kNearlyAll;
    if (waits) machine_.controller.dispatch();
  }
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 6));
  EXPECT_EQ(machine_.count(Event::Kind::CycleStateChanged), 1) << "Idle to Running";
  EXPECT_TRUE(std::ranges::is_sorted(machine_.events, {}, &Event::cycle));
}

// Red when what the servo loop reports is told before what happened earlier elsewhere.
TEST_F(Cycle, AFaultIsToldAfterWhatHappenedBeforeItThoughBothAreToldAtOnce) {
  start_slow_line();
  machine_.events.clear();
  ASSERT_TRUE(cam().cycle().hold());
  machine_.bus->trip(1, 0x2310);
  // Other gains have the machine go on though nobody is told of its cycles yet.
  for (double gain = 300; machine_.controller.sample().servo_state != ServoState::Faulted; gain += 0.001) {
    ASSERT_LT(gain, 310);
    ASSERT_TRUE(machine_.controller.config().loops().set_gains(0, std::array{gain, 4.0}));
    (void)machine_.controller.config().apply();
  }
  EXPECT_TRUE(machine_.events.empty());
  ASSERT_TRUE(machine_.run_until([&] { return !machine_.last(Event::Kind::Fault).empty(); }));
  EXPECT_TRUE(std::ranges::is_sorted(machine_.events, {}, &Event::cycle));
  EXPECT_EQ(machine_.events.front().kind, Event::Kind::CycleStateChanged) << "held, then faulted";
}

// Red when an event is told before its own cycle's sample, or after a later one.
TEST_F(Cycle, AnEventIsToldBetweenTheSampleOfItsCycleAndTheNext) {
  std::vector<std::pair<std::int64_t, std::int64_t>> told;  // cycle of the event, and of the last sample before it
  machine_.controller.on_event([&](const Event& event) {
    if (!machine_.samples.empty()) told.emplace_back(event.cycle, machine_.samples.back().cycle);
  });
  start_slow_line();
  ASSERT_TRUE(cam().cycle().hold());
  ASSERT_TRUE(machine_.run_until([&] { return !machine_.samples.back().moving; }));
  ASSERT_TRUE(cam().cycle().stop_now());
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::Stopped));
  ASSERT_GE(told.size(), 4U);
  for (const auto& [event, sample] : told) EXPECT_EQ(event, sample);
}

TEST_F(Cycle, MovesWithoutMotionCountAsQueuedUntilTheirTurn) {
  const ToolPose corner{{10, 0, 0}, {0, 0, 1}};
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, corner.tip));
  for (std::int64_t id = 2; id <= 4; ++id) ASSERT_TRUE(cam().queue().add(id, PathTargetGeometry{corner}));
  ASSERT_TRUE(machine_.line(5, corner.tip, {0, 0, 0}));
  ASSERT_TRUE(cam().queue().add(6, JointTargetGeometry{{0, 0, 0}}));
  EXPECT_EQ(cam().queue().moves_left(), 6);
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Manual));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 4));
  ASSERT_TRUE(machine_.run_until([&] { return cam().queue().moves_left() == 2; })) << "5, and 6 behind it";
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 6));
  ASSERT_TRUE(machine_.run_until([&] { return cam().queue().moves_left() == 0; }));

  ASSERT_TRUE(cam().cycle().set_feed_override(0));
  ASSERT_TRUE(machine_.line(7, {0, 0, 0}, corner.tip));
  ASSERT_TRUE(cam().queue().add(8, PathTargetGeometry{corner}));
  EXPECT_EQ(cam().queue().moves_left(), 2);
  ASSERT_TRUE(cam().cycle().stop_now());
  ASSERT_TRUE(machine_.run_until([&] { return state() == CycleState::Idle; }));
  EXPECT_EQ(cam().queue().moves_left(), 0) << "dropped with the rest";
}

TEST(Queue, IsFullOfMovesWithoutMotionToo) {
  ControllerOptions options = TestMachine::options();
  options.queue_capacity = 5;
  TestMachine machine(options);
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  sdk::RmacCam& cam = machine.controller.cam();
  ASSERT_TRUE(cam.path().set_feedrate(6000));
  ASSERT_TRUE(machine.line(1, {0, 0, 0}, {1, 0, 0}));
  for (std::int64_t id = 2; id <= 5; ++id) ASSERT_TRUE(cam.queue().add(id, JointTargetGeometry{{1, 0, 0}}));
  const auto sixth = cam.queue().add(6, JointTargetGeometry{{1, 0, 0}});
  ASSERT_FALSE(sixth);
  EXPECT_EQ(sixth.error().code, MinorCode::CommandQueueFull);
  EXPECT_THAT(sixth.error().message, HasSubstr("the queue holds 5 moves"));
}

TEST_F(Cycle, AMoveToWhereTheToolStandsIsDoneAtOnceAndTheNextOneRuns) {
  ASSERT_TRUE(cam().queue().add(5, PathTargetGeometry{{{0, 0, 0}, {0, 0, 1}}}));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 5));
  EXPECT_EQ(cam().queue().moves_left(), 0);
  ASSERT_TRUE(cam().positioning().jog_joint(0, 1e-9)) << "nor does a jog that goes nowhere wait for ever";
  EXPECT_EQ(state(), CycleState::Idle);
  ASSERT_TRUE(machine_.line(6, {0, 0, 0}, {1, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Manual));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 6));
  EXPECT_NEAR(machine_.samples.back().position_set[0], 1, 1e-6);
}

TEST_F(Cycle, RunsTheQueueInOrderWhenStartedAutomatically) {
  ASSERT_TRUE(machine_.line(7, {0, 0, 0}, {10, 0, 0}));
  ASSERT_TRUE(machine_.line(8, {10, 0, 0}, {10, 5, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 8));
  std::vector<std::pair<Event::Kind, std::int64_t>> moves;
  for (const Event& event : machine_.events) {
    if (event.kind == Event::Kind::MoveStarted || event.kind == Event::Kind::MoveDone) {
      moves.emplace_back(event.kind, event.move_id);
    }
  }
  EXPECT_THAT(moves, testing::ElementsAre(std::pair{Event::Kind::MoveStarted, 7}, std::pair{Event::Kind::MoveDone, 7},
                                          std::pair{Event::Kind::MoveStarted, 8}, std::pair{Event::Kind::MoveDone, 8}));
  EXPECT_EQ(state(), CycleState::Running) << "having nothing to do is not a stop";
  const CycleSample last = machine_.samples.back();
  EXPECT_NEAR(last.position_set[0], 10, 1e-6);
  EXPECT_NEAR(last.position_set[1], 5, 1e-6);
}

TEST_F(Cycle, MeasuredPositionsFollowTheSetpoints) {
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {20, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 1));
  double worst = 0;
  double feed = 0;
  for (const CycleSample& sample : machine_.samples) {
    worst = std::max(worst, std::abs(sample.position_set[0] - sample.position[0]));
    feed = std::max(feed, sample.feed_actual_mm_s);
  }
  EXPECT_GT(worst, 0) << "measured values are not the setpoints reflected";
  EXPECT_LT(worst, 1.0);
  EXPECT_NEAR(feed, 100, 5);
}

TEST_F(Cycle, NothingMovesBeforeCycleStart) {
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {10, 0, 0}));
  const std::int64_t before = machine_.controller.sample().cycle;
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.sample().cycle > before + 20; }));
  EXPECT_EQ(machine_.peak_velocity(0), 0);
  EXPECT_EQ(cam().queue().moves_left(), 1);
}

TEST_F(Cycle, RunsOneMoveWhenStartedManually) {
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {10, 0, 0}));
  ASSERT_TRUE(machine_.line(2, {10, 0, 0}, {20, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Manual));
  ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::Stopped) > 0; }));
  EXPECT_EQ(machine_.count(Event::Kind::MoveDone, 1), 1);
  EXPECT_EQ(machine_.count(Event::Kind::MoveDone, 2), 0);
  EXPECT_NEAR(machine_.controller.sample().position_set[0], 10, 1e-6);
  EXPECT_EQ(cam().queue().moves_left(), 1);
}

TEST_F(Cycle, HoldStopsOnThePathAndResumeGoesOn) {
  start_slow_line();
  ASSERT_TRUE(cam().cycle().hold());
  ASSERT_TRUE(machine_.run_until([&] {
    const CycleSample now = machine_.controller.sample();
    return now.state == CycleState::Holding && !now.moving;
  }));
  EXPECT_LT(machine_.controller.sample().position_set[0], 40);
  ASSERT_TRUE(cam().cycle().resume());
  ASSERT_TRUE(cam().cycle().set_feed_override(200));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 1));
  EXPECT_NEAR(machine_.controller.sample().position_set[0], 40, 1e-6);
}

TEST_F(Cycle, IsToldAsItIsNowNotAsTheLastSampleSawIt) {
  EXPECT_EQ(machine_.controller.cycle_now().state, CycleState::Idle);
  EXPECT_STREQ(machine_.controller.cycle_now().mode, "");
  start_slow_line();
  ASSERT_TRUE(cam().cycle().stop());
  ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::Stopped) > 0; }));
  EXPECT_EQ(machine_.controller.cycle_now().state, CycleState::Idle);
  ASSERT_TRUE(cam().cycle().set_feed_override(50));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  const CycleNow now = machine_.controller.cycle_now();
  EXPECT_EQ(now.state, CycleState::Running);
  EXPECT_STREQ(now.mode, "AUTOMATIC");
  EXPECT_EQ(now.override_percent, 50);
}

TEST_F(Cycle, StopKeepsTheRestOfTheQueue) {
  start_slow_line();
  ASSERT_TRUE(cam().cycle().stop());
  ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::Stopped) > 0; }));
  EXPECT_EQ(cam().queue().moves_left(), 1);
  const auto refused = cam().cycle().resume();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("nothing is held"));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 1));
}

TEST_F(Cycle, StopNowEmptiesTheQueueAndTheNextMoveBeginsWhereTheMachineStands) {
  start_slow_line();
  ASSERT_TRUE(machine_.line(2, {40, 0, 0}, {0, 0, 0}));
  ASSERT_TRUE(cam().cycle().stop_now());
  EXPECT_FALSE(machine_.line(4, {0, 0, 0}, {1, 0, 0})) << "it would be dropped with the rest";
  ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::Stopped) > 0; }));
  EXPECT_EQ(cam().queue().moves_left(), 0);
  const double at = machine_.controller.sample().position_set[0];
  EXPECT_FALSE(machine_.line(3, {40, 0, 0}, {0, 0, 0}));
  ASSERT_TRUE(machine_.line(3, {at, 0, 0}, {0, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 3));
  EXPECT_EQ(machine_.count(Event::Kind::MoveDone, 1), 0);
}

TEST_F(Cycle, RefusesAFeedThatIsZeroOrAboveTheMaximum) {
  EXPECT_FALSE(cam().path().set_feedrate(0));
  const auto refused = cam().path().set_feedrate(12001);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::SpeedLimit);
  ASSERT_TRUE(cam().path().set_max_feedrate(3000));
  const auto move = machine_.line(1, {0, 0, 0}, {10, 0, 0});
  ASSERT_FALSE(move);
  EXPECT_EQ(move.error().code, MinorCode::SpeedLimit);
}

TEST_F(Cycle, RefusesMovesBeyondTheQueueCapacity) {
  ControllerOptions options = TestMachine::options();
  options.queue_capacity = 2;
  TestMachine small(options);
  ASSERT_TRUE(small.load_at_zero(TestMachine::mill()));
  ASSERT_TRUE(small.controller.cam().path().set_feedrate(6000));
  ASSERT_TRUE(small.line(1, {0, 0, 0}, {1, 0, 0}));
  ASSERT_TRUE(small.line(2, {1, 0, 0}, {2, 0, 0}));
  const auto refused = small.line(3, {2, 0, 0}, {3, 0, 0});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::CommandQueueFull);
}

TEST_F(Cycle, OverrideScalesTheFeed) {
  ASSERT_TRUE(cam().cycle().set_feed_override(50));
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {40, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 1));
  EXPECT_NEAR(machine_.peak_velocity(0), 50, 0.1);
  EXPECT_FALSE(cam().cycle().set_feed_override(201));
}

TEST_F(Cycle, JogMovesOneJointFromRest) {
  ASSERT_TRUE(cam().joints().set_interp_speed(20));
  ASSERT_TRUE(cam().positioning().jog_joint(1, -12.5));
  ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::Stopped) > 0; }));
  EXPECT_NEAR(machine_.controller.sample().position_set[1], -12.5, 1e-6);
  EXPECT_LE(machine_.peak_velocity(1), 40.001);
  EXPECT_EQ(machine_.peak_velocity(0), 0);
  ASSERT_TRUE(cam().positioning().home());
  ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::Stopped) > 1; }));
  EXPECT_NEAR(machine_.controller.sample().position_set[1], 0, 1e-6);
}

TEST_F(Cycle, RefusesAJogOutsideTheLimitsOrWhileAProgramRuns) {
  const auto outside = cam().positioning().jog_joint(0, 51);
  ASSERT_FALSE(outside);
  EXPECT_EQ(outside.error().code, MinorCode::TravelLimit) << outside.error().message;
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  EXPECT_FALSE(cam().positioning().jog_joint(0, 1));
}

TEST_F(Cycle, PartFrameMovesTheProgramOnTheMachine) {
  ASSERT_TRUE(cam().frames().set_part({{5, -3, 0}, {1, 0, 0, 0}}));
  ASSERT_TRUE(machine_.line(1, {-5, 3, 0}, {10, 0, 0}));
  EXPECT_FALSE(cam().frames().set_part({})) << "a move is queued";
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 1));
  EXPECT_NEAR(machine_.controller.sample().position_set[0], 15, 1e-6);
  EXPECT_NEAR(machine_.controller.sample().position_set[1], -3, 1e-6);
  EXPECT_NEAR(machine_.controller.sample().pose_set.tip[0], 10, 1e-6);
}

TEST_F(Cycle, CoolantSwitchesItsOutput) {
  ASSERT_TRUE(cam().spindles().set_coolant(true));
  EXPECT_TRUE(machine_.run_until([&] { return machine_.io->outputs() == std::uint64_t{1} << 5; }));
  ASSERT_TRUE(cam().spindles().set_coolant(false));
  EXPECT_TRUE(machine_.run_until([&] { return machine_.io->outputs() == 0; }));
}

TEST_F(Cycle, MotionWaitsForTheSpindle) {
  ASSERT_TRUE(cam().spindles().set_rpm(0, 900));
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {10, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 1));
  for (const CycleSample& sample : machine_.samples) {
    if (!sample.moving) continue;
    EXPECT_NEAR(sample.spindle_rpm[0], 900, 20);
  }
  EXPECT_FALSE(cam().spindles().set_rpm(0, 1001));
  EXPECT_FALSE(cam().spindles().set_rpm(1, 100));
}

TEST_F(Cycle, ASpindleThatNeverGetsToSpeedFaultsTheMachine) {
  sdk::DeviceObject device = TestMachine::mill();
  device.spindles[0].speed_timeout_s = 0.001;
  ASSERT_TRUE(machine_.load_at_zero(device));
  ASSERT_TRUE(cam().path().set_feedrate(6000));
  ASSERT_TRUE(cam().spindles().set_rpm(0, 1000));
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {10, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::Fault) > 0; }));
  EXPECT_THAT(machine_.last(Event::Kind::Fault), HasSubstr("of 1000 rpm"));
  EXPECT_EQ(machine_.peak_velocity(0), 0);
  EXPECT_FALSE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(cam().cycle().reset());
  EXPECT_EQ(cam().queue().moves_left(), 0);
}

TEST_F(Cycle, ADriveFaultStopsEverythingUntilReset) {
  start_slow_line();
  machine_.bus->trip(1, 0x2310);
  ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::Fault, 1) > 0; }));
  EXPECT_THAT(machine_.last(Event::Kind::Fault),
              HasSubstr("actuator 1 (bus test, axis 1): the drive reports error 2310h"));
  ASSERT_TRUE(machine_.run_until([&] { return state() == CycleState::Faulted; }));
  EXPECT_FALSE(machine_.line(2, {40, 0, 0}, {0, 0, 0}));

  const auto reset = cam().cycle().reset();
  ASSERT_TRUE(reset) << reset.error().message;
  EXPECT_EQ(cam().queue().moves_left(), 0);
  ASSERT_TRUE(machine_.run_until([&] { return state() == CycleState::Idle; }));
  const double at = machine_.controller.sample().position_set[0];
  EXPECT_LT(at, 39);
  ASSERT_TRUE(machine_.line(
      2, {at, machine_.controller.sample().position_set[1], machine_.controller.sample().position_set[2]}, {0, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 2));
}

TEST_F(Cycle, EverySampleIsThereInVirtualTime) {
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {40, 0, 0}));
  ASSERT_TRUE(machine_.line(2, {40, 0, 0}, {-40, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 2));
  for (std::size_t i = 1; i < machine_.samples.size(); ++i) {
    ASSERT_EQ(machine_.samples[i].cycle, machine_.samples[i - 1].cycle + 1);
  }
  EXPECT_EQ(machine_.controller.sample().samples_lost, 0U);
}

}  // namespace
}  // namespace rmac::gateway
