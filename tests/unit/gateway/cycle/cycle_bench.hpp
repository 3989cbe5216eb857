#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gateway/cycle/jogging.hpp"
#include "gateway/cycle/machine_cycle.hpp"
#include "gateway/cycle/move_entry.hpp"
#include "unit/motion/planner/planner_bench.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::gateway {

/// A machine's cycle of three joints and a spindle, without threads: its path is followed exactly, and whatever else
/// the servo loop would tell stands in `status` for the test to change.
class CycleBench {
 public:
  explicit CycleBench(bool virtual_mode = false) : mechanism(make_mechanism(virtual_mode)) {
    mechanism->follower.hold_at(std::vector<double>(3, 0.0));
    status.generation = 1;
    status.follows = true;
    status.joint_count = 3;
    publish();
    const GatewayTurn turn(cycle.lock);
    (void)cycle.install(mechanism, 1, false);
    (void)cycle.news.take();
  }

  /// One cycle: planning until there is nothing to plan, then the setpoint.
  Planning::Pace step() {
    Planning::Pace pace = Planning::Pace::Planning;
    for (int pass = 0; pass < 1000 && pace == Planning::Pace::Planning; ++pass) {
      const PlannerTurn turn(cycle.lock);
      pace = cycle.advance(status);
    }
    follow();
    return pace;
  }
  /// One cycle in which the planner has no turn.
  void follow() {
    ++status.progress.cycle;
    status.t_s += 0.001;
    Setpoint setpoint;
    if (link.stops.stop() && ++stop_wanted > 2) mechanism->follower.leave();
    if (!link.stops.stop()) stop_wanted = 0;
    mechanism->follower.sample(status.progress.cycle, setpoint);
    status.progress.accepted_plan = mechanism->follower.accepted_plan();
    status.progress.last_refused = mechanism->follower.last_refused();
    status.progress.departure = mechanism->follower.departure();
    status.moving = setpoint.moving;
    status.move_id = setpoint.move_id;
    status.s_mm = setpoint.s_mm;
    status.moves_done += setpoint.moves_done;
    const ServoWishes& wished = link.wishes.read();
    outputs = path_outputs.step(wished.outputs, wished.marks_settled, status.moves_done);
    status.marks_passed = path_outputs.passed();
    std::copy(setpoint.position.begin(), setpoint.position.begin() + 3, status.position_set.begin());
    publish();
  }
  /// False when it is not so after a machine's minute.
  template <typename Reached>
  bool run_until(Reached&& reached) {
    for (int i = 0; i < 60000; ++i) {
      if (reached()) return true;
      step();
    }
    return false;
  }
  bool run_to_rest() {
    step();
    step();
    return run_until([&] { return !status.moving && state() != CycleState::Stopping; });
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) step();
  }

  Expected<> queue(std::int64_t id, double x, double feed_mm_s = 50) {
    return entry.prepare().and_then([&] { return entry.add(move_to(id, x, feed_mm_s)); }).map([](bool) {});
  }
  /// Along X, on the way from wherever the queue ends.
  static Move move_to(std::int64_t id, double x, double feed_mm_s = 50) {
    return {.id = id, .geometry = PathTargetGeometry{{{x, 0, 0}, {0, 0, 1}}}, .feed_mm_s = feed_mm_s};
  }
  Expected<> start(sdk::CycleMode mode = sdk::CycleMode::Automatic) {
    return cycle.command([&](CycleSequencer& sequencer, const auto& seen) { return sequencer.start(mode, seen); });
  }
  Expected<> hold() {
    return cycle.command([](CycleSequencer& sequencer, const auto&) { return sequencer.hold(); });
  }
  Expected<> resume() {
    return cycle.command([](CycleSequencer& sequencer, const auto&) { return sequencer.resume(); });
  }
  Expected<> stop_now() {
    return cycle.command([](CycleSequencer& sequencer, const auto& seen) { return sequencer.stop_and_clear(seen); });
  }

  [[nodiscard]] CycleState state() {
    const GatewayTurn turn(cycle.lock);
    return cycle.sequencer.state();
  }
  [[nodiscard]] std::size_t moves_left() {
    const GatewayTurn turn(cycle.lock);
    return cycle.moves_left();
  }
  [[nodiscard]] double x() const { return status.position_set[0]; }
  [[nodiscard]] ServoWishes wishes() {
    const GatewayTurn turn(cycle.lock);
    return cycle.wishes.now();
  }
  /// What was told since it was last asked, in words and codes.
  [[nodiscard]] std::vector<Event> events() {
    const GatewayTurn turn(cycle.lock);
    return cycle.news.take().events;
  }
  /// The last event of a kind since it was last asked; empty when there was none.
  [[nodiscard]] std::string told(Event::Kind kind) {
    std::string message;
    for (const Event& event : events()) message = event.kind == kind ? event.message : message;
    return message;
  }

  void publish() { link.status.write(status); }

  ServoLink link{1};
  PathOutputs path_outputs{link.marks};
  std::uint64_t outputs = 0;  ///< of the last cycle
  ServoStatus status;
  int stop_wanted = 0;  ///< cycles since
  std::shared_ptr<Mechanism> mechanism;
  MachineCycle cycle{{}, link};
  MoveEntry entry{cycle};

  static std::shared_ptr<Mechanism> make_mechanism(bool virtual_mode) {
    const PlannerModel model = test::mill();
    ServoLoopParts parts;
    parts.kinematics = model.kinematics;
    parts.actuator_map = std::make_shared<servo_test::DirectMap>();
    parts.virtual_mode = virtual_mode;
    const auto bus = std::make_shared<ServoBus>(std::make_shared<servo_test::FakeBus>(3));
    for (std::uint32_t i = 0; i < 3; ++i) {
      ServoJoint joint;
      joint.law = std::make_shared<servo_test::RecordingLaw>();
      joint.max_following_error = 1;
      joint.max_effort = 1;
      parts.joints.push_back(joint);
      parts.actuators.push_back({.bus = bus, .axis = i, .scale = {1000, 1, 1, 0}});
    }
    auto loop = ServoLoop::create(std::move(parts));
    if (!loop) throw std::runtime_error(loop.error().message);
    sdk::DeviceObject device;
    device.name = "Bench";
    device.spindles.push_back({"test", 3, 1000, 5, 2.5, 20, 5});
    return std::make_shared<Mechanism>(std::move(device), model, std::shared_ptr<ServoLoop>(std::move(*loop)),
                                       std::vector<ModuleInUse>{});
  }
};

}  // namespace rmac::gateway
