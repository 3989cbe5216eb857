// What a program does between its moves, in the machine's cycle: at its place, once, and with the queue.
#include <gmock/gmock.h>

#include <random>

#include "gateway/cycle/operating.hpp"
#include "unit/gateway/cycle/cycle_bench.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class BetweenMoves : public testing::Test {
 protected:
  void add(InTurn step) {
    const GatewayTurn turn(bench_.cycle.lock);
    ProgramStep as_sent = step_at(bench_.cycle.builder(), step);
    std::vector<QueueStep> steps;
    steps.emplace_back(std::move(step));
    bench_.cycle.queue.add_steps(std::move(steps), std::move(as_sent));
  }
  void add_dwell(std::int64_t id, double time_s) { add({id, Dwell{time_s}}); }
  /// Runs until `reached`; how long it took.
  template <typename Reached>
  double time_until(Reached&& reached) {
    const double begin = bench_.status.t_s;
    EXPECT_TRUE(bench_.run_until(reached));
    return bench_.status.t_s - begin;
  }
  [[nodiscard]] bool all_done() { return bench_.moves_left() == 0; }
  void retrace(double distance_mm) {
    Operating operating(bench_.cycle);
    const auto way = operating.retrace(distance_mm, {});
    ASSERT_TRUE(way) << way.error().message;
    ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Holding; }));
  }
  void keep_events() {
    for (Event& event : bench_.events()) events_.push_back(std::move(event));
  }
  [[nodiscard]] int count(Event::Kind kind, std::int64_t id) {
    keep_events();
    return static_cast<int>(
        std::ranges::count_if(events_, [&](const Event& event) { return event.kind == kind && event.move_id == id; }));
  }

  CycleBench bench_;
  std::vector<Event> events_;
};

// Red when a dwell is left out, begins before the path rests, lasts longer than a few cycles more, or is not counted.
TEST_F(BetweenMoves, ADwellIsARestOfItsLengthAtItsPlace) {
  std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same dwells every time
  for (int round = 0; round < 10; ++round) {
    const double dwell_s = std::uniform_real_distribution<double>(0.001, 0.5)(random);
    const double from = bench_.x();
    ASSERT_TRUE(bench_.queue(1, from + 2));
    add_dwell(2, dwell_s);
    ASSERT_TRUE(bench_.queue(3, from + 5));
    EXPECT_EQ(bench_.moves_left(), 3U);
    if (round == 0) {
      ASSERT_TRUE(bench_.start());
    }
    ASSERT_TRUE(bench_.run_until([&] { return bench_.moves_left() == 2 && !bench_.status.moving; }));
    EXPECT_NEAR(bench_.x(), from + 2, 1e-9);
    const double rested = time_until([&] { return bench_.status.moving; });
    EXPECT_NEAR(rested, dwell_s, 0.006) << "the rest, and a plan's lead";
    EXPECT_GE(rested, dwell_s - 0.001);
    ASSERT_TRUE(bench_.run_until([&] { return all_done(); }));
    EXPECT_NEAR(bench_.x(), from + 5, 1e-9);
  }
}

// Red when a step is taken for which the moves that another step let go have not been made.
TEST_F(BetweenMoves, StepsAreTakenInTheirOrderEachBehindItsMoves) {
  std::vector<double> at;
  for (int i = 0; i < 6; ++i) {
    add_dwell(10 + i, 0.01);
    ASSERT_TRUE(bench_.queue(20 + i, i + 1));
  }
  add({30, ProgramStop{}});
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] {
    for (const Event& event : bench_.events()) {
      if (event.kind == Event::Kind::MoveStarted) at.push_back(bench_.x());
    }
    return bench_.state() == CycleState::Holding;
  }));
  ASSERT_EQ(at.size(), 7U);
  for (std::size_t i = 0; i < at.size(); ++i) EXPECT_NEAR(at[i], static_cast<double>(i), 1e-9);
}

TEST_F(BetweenMoves, AHoldStopsTheClockOfADwellAndNothingElse) {
  ASSERT_TRUE(bench_.queue(1, 2));
  add_dwell(2, 0.3);
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.wishes().in_turn.has_value(); }));
  bench_.run(100);
  ASSERT_TRUE(bench_.hold());
  bench_.run(1000);
  EXPECT_EQ(count(Event::Kind::MoveDone, 2), 0);
  ASSERT_TRUE(bench_.resume());
  EXPECT_NEAR(time_until([&] { return all_done(); }), 0.2, 0.01);
  EXPECT_EQ(count(Event::Kind::MoveDone, 2), 1);
}

TEST_F(BetweenMoves, AStopHoldsTheProgramAtItsPlaceUntilItIsResumed) {
  ASSERT_TRUE(bench_.queue(1, 2));
  add({2, ProgramStop{.message = "turn it over"}});
  ASSERT_TRUE(bench_.queue(3, 5));
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Holding; }));
  bench_.run(2000);
  EXPECT_EQ(bench_.state(), CycleState::Holding);
  EXPECT_NEAR(bench_.x(), 2, 1e-9);
  EXPECT_EQ(count(Event::Kind::ProgramStopped, 2), 1);
  EXPECT_EQ(count(Event::Kind::MoveDone, 2), 0) << "it is done when somebody goes on";
  ASSERT_TRUE(bench_.resume());
  ASSERT_TRUE(bench_.run_until([&] { return all_done(); }));
  EXPECT_EQ(bench_.state(), CycleState::Running);
  EXPECT_NEAR(bench_.x(), 5, 1e-9);
  EXPECT_EQ(count(Event::Kind::ProgramStopped, 2), 1);
  EXPECT_EQ(count(Event::Kind::MoveDone, 2), 1);
}

// Red when the stop is passed, or done, at the place to which the tool went back, and when it holds once more.
TEST_F(BetweenMoves, AWayBackFromAStopLeadsToItsPlaceAgainBeforeTheProgramGoesOn) {
  for (const auto mode : {sdk::CycleMode::Automatic, sdk::CycleMode::Manual}) {
    SCOPED_TRACE(static_cast<int>(mode));
    const double from = bench_.x();
    ASSERT_TRUE(bench_.queue(1, from + 4));
    add({2, ProgramStop{}});
    ASSERT_TRUE(bench_.start(mode));
    if (mode == sdk::CycleMode::Manual) {
      ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Idle; }));
      ASSERT_TRUE(bench_.start(mode));
    }
    ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Holding; }));
    retrace(3);
    EXPECT_NEAR(bench_.x(), from + 1, 1e-6);
    EXPECT_EQ(count(Event::Kind::MoveDone, 2), 0);
    ASSERT_TRUE(bench_.resume());
    ASSERT_TRUE(bench_.run_until([&] { return count(Event::Kind::MoveDone, 2) == 1; }));
    EXPECT_NEAR(bench_.x(), from + 4, 1e-9);
    EXPECT_EQ(count(Event::Kind::ProgramStopped, 2), 1) << "held once";
    ASSERT_TRUE(bench_.stop_now());
    ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Idle; }));
    events_.clear();
  }
}

// Red when a step that is done is queued anew by a way back over its place.
TEST_F(BetweenMoves, AWayBackOverADwellDoesNotDwellAgain) {
  ASSERT_TRUE(bench_.queue(1, 4));
  add_dwell(2, 1);
  ASSERT_TRUE(bench_.queue(3, 30, 5));
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.x() > 8; }));
  ASSERT_TRUE(bench_.hold());
  ASSERT_TRUE(bench_.run_to_rest());
  retrace(7);
  EXPECT_LT(bench_.x(), 3);
  const double before = bench_.status.t_s;
  ASSERT_TRUE(bench_.resume());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.x() > 5; }));
  EXPECT_LT(bench_.status.t_s - before, 0.8) << "there is no dwell of a second in it";
  EXPECT_EQ(count(Event::Kind::MoveStarted, 2), 1);
  EXPECT_EQ(count(Event::Kind::MoveDone, 2), 1);
}

TEST_F(BetweenMoves, AnInputThatDoesNotComeHoldsTheProgramWhichSaysWhatItWaitsFor) {
  add({1, AwaitInput{.bit = 2, .on = true, .timeout_s = 0.5, .name = "Clamped"}});
  ASSERT_TRUE(bench_.queue(2, 5));
  ASSERT_TRUE(bench_.start());
  bench_.run(450);
  EXPECT_EQ(bench_.state(), CycleState::Running);
  bench_.run(100);
  EXPECT_EQ(bench_.state(), CycleState::Holding);
  EXPECT_THAT(bench_.told(Event::Kind::ProgramStopped), HasSubstr("input Clamped did not go on within 0.5 s"));
  EXPECT_EQ(bench_.x(), 0);
  ASSERT_TRUE(bench_.resume());
  bench_.run(450);
  EXPECT_EQ(bench_.state(), CycleState::Running) << "it waits once more";
  CycleSample sample;
  sample.cycle = 1;
  sample.inputs = 2;
  bench_.link.history.add(sample);
  ASSERT_TRUE(bench_.run_until([&] { return all_done(); }));
  EXPECT_NEAR(bench_.x(), 5, 1e-9);
}

TEST_F(BetweenMoves, IsDroppedWithTheQueue) {
  ASSERT_TRUE(bench_.queue(1, 2));
  add_dwell(2, 10);
  ASSERT_TRUE(bench_.queue(3, 5));
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.wishes().in_turn.has_value(); }));
  ASSERT_TRUE(bench_.stop_now());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Idle; }));
  EXPECT_EQ(bench_.moves_left(), 0U);
  EXPECT_FALSE(bench_.wishes().in_turn);
  ASSERT_TRUE(bench_.queue(4, 3));
  ASSERT_TRUE(bench_.start());
  EXPECT_LT(time_until([&] { return all_done(); }), 1);
  EXPECT_EQ(count(Event::Kind::MoveDone, 2), 0);
}

TEST_F(BetweenMoves, EachIsOneStepOfAManualCycle) {
  ASSERT_TRUE(bench_.queue(1, 2));
  add_dwell(2, 0.1);
  ASSERT_TRUE(bench_.queue(3, 5));
  for (const std::size_t left : {2U, 1U, 0U}) {
    ASSERT_TRUE(bench_.start(sdk::CycleMode::Manual));
    ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Idle; }));
    EXPECT_EQ(bench_.moves_left(), left);
  }
}

TEST_F(BetweenMoves, NothingIsTakenBeforeTheCycleRuns) {
  add_dwell(1, 0.1);
  add({2, ProgramStop{}});
  bench_.run(500);
  EXPECT_EQ(bench_.moves_left(), 2U);
  EXPECT_TRUE(bench_.events().empty());
}

// Red when a feed begins at the speed of the cut before, or the speed changes before its turn.
TEST_F(BetweenMoves, ASpindlesSpeedIsWaitedForBeforeTheNextFeed) {
  ASSERT_TRUE(bench_.queue(1, 5));
  add({2, Switch{.speeds = {{0, 600}}}});
  ASSERT_TRUE(bench_.queue(3, 9));
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.wishes().spindle_rpm[0] != 0 || bench_.x() > 5; }));
  EXPECT_NEAR(bench_.x(), 5, 1e-9);
  EXPECT_FALSE(bench_.status.moving) << "the path rests there";
  bench_.run(2000);
  EXPECT_NEAR(bench_.x(), 5, 1e-9);
  bench_.status.spindle_rpm[0] = 595;
  ASSERT_TRUE(bench_.run_until([&] { return all_done(); }));
  EXPECT_NEAR(bench_.x(), 9, 1e-9);
  EXPECT_EQ(count(Event::Kind::MoveDone, 2), 1);
}

TEST_F(BetweenMoves, NoMoveIsBegunBehindASpindleThatDoesNotComeToItsSpeed) {
  add({2, Switch{.speeds = {{0, 600}}}});
  ASSERT_TRUE(bench_.queue(3, 9));
  ASSERT_TRUE(bench_.start());
  bench_.run(5100);
  EXPECT_EQ(bench_.state(), CycleState::Faulted);
  EXPECT_THAT(bench_.told(Event::Kind::Fault), HasSubstr("spindle 0 turns at 0 of 600 rpm"));
  EXPECT_EQ(bench_.x(), 0);
}

// Red when a way back makes the calls once more.
TEST_F(BetweenMoves, AWayBackOverCallsDoesNotMakeThemAgain) {
  ASSERT_TRUE(bench_.queue(1, 5));
  add({2, Switch{.speeds = {{0, 600}}, .outputs = {{"Coolant", true, 0b10}}}});
  ASSERT_TRUE(bench_.queue(3, 30, 5));
  bench_.status.spindle_rpm[0] = 600;
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.x() > 8; }));
  EXPECT_EQ(bench_.wishes().outputs, 0b10U);
  ASSERT_TRUE(bench_.hold());
  ASSERT_TRUE(bench_.run_to_rest());
  {
    const GatewayTurn turn(bench_.cycle.lock);
    bench_.cycle.wishes.change([](ServoWishes& wish) {
      wish.outputs = 0;
      wish.spindle_rpm[0] = 300;
    });
  }
  bench_.status.spindle_rpm[0] = 300;
  retrace(7);
  EXPECT_LT(bench_.x(), 3);
  ASSERT_TRUE(bench_.resume());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.x() > 9; }));
  EXPECT_EQ(bench_.wishes().outputs, 0U);
  EXPECT_EQ(bench_.wishes().spindle_rpm[0], 300);
}

/// Lines along X, smooth into each other, and behind some of them an output that switches.
class OutputsOnTheWay : public BetweenMoves {
 protected:
  static constexpr std::uint64_t kLaser = 0b100;

  void queue_line(std::int64_t id, double from, double to) {
    const Move move{.id = id,
                    .geometry = LineGeometry{{{from, 0, 0}, {0, 0, 1}}, {{to, 0, 0}, {0, 0, 1}}},
                    .feed_mm_s = 50,
                    .tolerance_mm = 0.01};
    ASSERT_TRUE(bench_.entry.prepare());
    const auto added = bench_.entry.add(move);
    ASSERT_TRUE(added) << added.error().message;
  }
  void queue_switch(std::int64_t id, bool on) {
    add({id, Switch{.outputs = {{"Laser", on, kLaser}}}});
    const GatewayTurn turn(bench_.cycle.lock);
    bench_.cycle.steps.hand_on();
  }
  [[nodiscard]] bool lit() const { return (bench_.outputs & kLaser) != 0; }
};

// Red when an output stops the path, or switches a cycle too late or too early.
TEST_F(OutputsOnTheWay, SwitchInTheCycleThatPassesTheirPlaceAndStopNothing) {
  std::mt19937 random(5);  // NOLINT(cert-msc51-cpp): the same lengths every time
  std::vector<double> ends{0};
  for (int i = 0; i < 40; ++i) ends.push_back(ends.back() + std::uniform_real_distribution<double>(0.2, 2)(random));
  const auto run = [&](CycleBench& bench, bool with_outputs, const auto& each_cycle) {
    std::int64_t id = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const Move move{.id = ++id,
                      .geometry = LineGeometry{{{ends[i], 0, 0}, {0, 0, 1}}, {{ends[i + 1], 0, 0}, {0, 0, 1}}},
                      .feed_mm_s = 50,
                      .tolerance_mm = 0.01};
      ASSERT_TRUE(bench.entry.prepare());
      ASSERT_TRUE(bench.entry.add(move));
      if (!with_outputs) continue;
      const GatewayTurn turn(bench.cycle.lock);
      const InTurn step{++id, Switch{.outputs = {{"Laser", i % 2 == 0, kLaser}}}};
      bench.cycle.queue.add_steps({step}, step_at(bench.cycle.builder(), step));
      bench.cycle.steps.hand_on();
      ASSERT_TRUE(bench.cycle.queue.steps().empty()) << "it waits for no rest";
    }
    ASSERT_TRUE(bench.start());
    ASSERT_TRUE(bench.run_until([&] {
      each_cycle(bench);
      return bench.moves_left() == 0 && !bench.status.moving;
    }));
  };
  std::vector<double> without;
  CycleBench plain;
  run(plain, false, [&](CycleBench& bench) { without.push_back(bench.x()); });
  std::size_t cycle = 0, passed = 0, switched = 0;
  bool was = false;
  run(bench_, true, [&](CycleBench& bench) {
    ASSERT_LT(cycle, without.size());
    ASSERT_EQ(bench.x(), without[cycle]) << "cycle " << cycle;
    ++cycle;
    while (passed + 1 < ends.size() && bench.x() >= ends[passed + 1] - 1e-6) ++passed;
    const bool on = passed % 2 == 1;
    // At the end the machine rests before its last move counts as done.
    if (passed + 1 < ends.size()) {
      ASSERT_EQ(lit(), on) << bench.x();
    }
    switched += lit() != was ? 1U : 0U;
    was = lit();
  });
  EXPECT_EQ(switched, 40U);
  EXPECT_FALSE(lit());
}

TEST_F(OutputsOnTheWay, SwitchOnceWhateverTheToolDoesOverTheirPlace) {
  queue_line(1, 0, 5);
  queue_switch(2, true);
  queue_line(3, 5, 40);
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.x() > 8; }));
  EXPECT_TRUE(lit());
  ASSERT_TRUE(bench_.hold());
  ASSERT_TRUE(bench_.run_to_rest());
  {
    const GatewayTurn turn(bench_.cycle.lock);
    bench_.cycle.wishes.change([](ServoWishes& wish) { wish.outputs = 0; });
  }
  bench_.step();
  EXPECT_FALSE(lit());
  retrace(bench_.x() - 2);
  ASSERT_TRUE(bench_.resume());
  ASSERT_TRUE(bench_.run_until([&] {
    EXPECT_FALSE(lit()) << bench_.x();
    return all_done() || lit();
  }));
}

TEST_F(OutputsOnTheWay, AreDroppedWithTheQueueAndTheNextOnesAreNot) {
  queue_line(1, 0, 30);
  queue_switch(2, true);
  queue_line(3, 30, 40);
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.x() > 5; }));
  ASSERT_TRUE(bench_.stop_now());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Idle; }));
  for (int round = 0; round < 3; ++round) {
    const double from = bench_.x();
    queue_line(4, from, from + 3);
    queue_line(5, from + 3, from + 6);
    queue_switch(6, round % 2 == 0);
    queue_line(7, from + 6, from + 9);
    ASSERT_TRUE(bench_.start());
    ASSERT_TRUE(bench_.run_until([&] {
      if (bench_.x() < from + 6 - 1e-6) {
        EXPECT_EQ(lit(), round % 2 == 1) << bench_.x();
      }
      return all_done();
    }));
    EXPECT_EQ(lit(), round % 2 == 0);
    ASSERT_TRUE(bench_.stop_now());
    ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Idle; }));
  }
}

TEST_F(OutputsOnTheWay, WaitForTheCycleWhereNoMotionLeadsToThem) {
  queue_switch(1, true);
  queue_line(2, 0, 5);
  queue_switch(3, false);
  bench_.run(100);
  EXPECT_FALSE(lit());
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return lit(); }));
  EXPECT_EQ(bench_.x(), 0);
  ASSERT_TRUE(bench_.run_until([&] { return all_done(); }));
  bench_.step();
  EXPECT_FALSE(lit());
  queue_switch(4, true);
  bench_.run(3);
  EXPECT_TRUE(lit()) << "the machine stands there already";
  EXPECT_EQ(bench_.moves_left(), 0U);
}

TEST_F(OutputsOnTheWay, StayOffInAnEmergencyStopThatComesRightBehindTheirPlace) {
  queue_line(1, 0, 5);
  queue_switch(2, true);
  queue_line(3, 5, 40);
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.x() > 4.9; }));
  for (int i = 0; i < 50 && !lit(); ++i) bench_.follow();  // the planner has no turn
  ASSERT_TRUE(lit());
  bench_.status.state = ServoState::Faulted;
  bench_.status.fault.kind = ServoFault::Kind::EmergencyStop;
  bench_.step();
  bench_.follow();
  EXPECT_EQ(bench_.state(), CycleState::EmergencyStop);
  EXPECT_FALSE(lit());
}

TEST_F(OutputsOnTheWay, AreStepsOfTheProgramThatAreDoneWithTheMoveBefore) {
  queue_line(1, 0, 5);
  queue_switch(2, true);
  queue_line(3, 5, 10);
  EXPECT_EQ(bench_.moves_left(), 3U);
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return lit(); }));
  ASSERT_TRUE(bench_.hold());
  ASSERT_TRUE(bench_.run_to_rest());
  const GatewayTurn turn(bench_.cycle.lock);
  EXPECT_EQ(bench_.cycle.moves_left(), 1U);
  const auto left = bench_.cycle.queue.take_program();
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(std::get<Move>(left[0].what).id, 3);
}

TEST_F(BetweenMoves, NoWayBackWhileAToolIsChanged) {
  ASSERT_TRUE(bench_.queue(1, 5));
  {
    const GatewayTurn turn(bench_.cycle.lock);
    bench_.cycle.queue.add_steps({BeginToolChange{}, AskPerson{"insert T4"}, MountTool{.number = 4}},
                                 step_at(bench_.cycle.builder(), 4));
  }
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.told(Event::Kind::ToolWanted) == "insert T4"; }));
  ASSERT_TRUE(bench_.hold());
  ASSERT_TRUE(bench_.run_to_rest());
  Operating operating(bench_.cycle);
  EXPECT_THAT(operating.retrace(3, {}).error().message, HasSubstr("a tool change is under way"));
}

}  // namespace
}  // namespace rmac::gateway
