#include "gateway/cycle/parking.hpp"

#include <fmt/format.h>

#include <utility>

#include "gateway/queue/way_back.hpp"

namespace rmac::gateway {
namespace {

tl::unexpected<Error> refuse(const std::string& why) {
  return failure(MinorCode::Other, "ParkProgram: " + why);
}

}  // namespace

Expected<> Parking::check_held(const ServoStatus& now) {
  if (!cycle_.mechanism()) return refuse("no mechanism is loaded");
  if (parked_) {
    return refuse(fmt::format("a program is parked already, on {}; take it up, or drop it with DropParkedProgram",
                              parked_->mechanism));
  }
  const CycleState state = cycle_.sequencer.state();
  if (state != CycleState::Holding && state != CycleState::Idle) {
    return refuse(fmt::format("the machine is {}; hold the program with FeedHold first", to_string(state)));
  }
  if (auto free = refuse_when_held("ParkProgram", cycle_.sequencer.phase().held_by()); !free) return free;
  if (!cycle_.observe(now).at_rest) return refuse("the machine is still coming to rest; ask again when it stands");
  if (cycle_.probe.measurement().pending() || cycle_.sequencer.phase().positions()) {
    return refuse("a jog or a measurement is held, not a program");
  }
  if (cycle_.tools.changing()) return refuse("a tool change is under way; park when it is done");
  return {};
}

Expected<> Parking::park(std::uint64_t outputs_off) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.notice_fault();
  const ServoStatus now = cycle_.status();
  if (auto held = check_held(now); !held) return held;
  Program program;
  program.steps = cycle_.queue.take_program();
  if (!program.steps.empty() && program.steps.front().way_back) program.steps.pop_front();
  if (program.steps.empty()) return refuse("nothing is queued");
  const Mechanism& mechanism = *cycle_.mechanism();
  program.mechanism = mechanism.device.name;
  program.virtual_mode = mechanism.virtual_mode();
  ProgramStep& first = program.steps.front();
  program.place = first.start;
  program.place_joints = first.start_joints;
  const auto place = mechanism.planner.farthest_place();
  const Move* const move = std::get_if<Move>(&first.what);
  if (place && move != nullptr && place->move_id == move->id) {
    first.from_mm = place->s_mm;
    program.place = place->pose;
    program.place_joints = place->joints;
  }
  program.mode = cycle_.sequencer.mode();
  program.override_percent = cycle_.feed.percent();
  program.turned_off = cycle_.wishes.turn_off(outputs_off);
  parked_ = std::move(program);
  auto stopped = cycle_.sequencer.stop_and_clear(cycle_.observe(now), StopCause::Parked);
  if (stopped) cycle_.settle(now);
  return stopped;
}

Expected<> Parking::check_references() {
  const GatewayTurn turn(cycle_.lock);
  const CycleObservation seen = cycle_.observe(cycle_.status());
  return require_references("TakeUpProgram", seen.reference_lost, seen.device);
}

Expected<> Parking::add_rest_of(const ProgramStep& first) {
  if (auto known = check_references(); !known) return known;
  auto rest = build_rest_of(cycle_.builder(), first);
  if (!rest) return tl::unexpected(rest.error());
  const GatewayTurn turn(cycle_.lock);
  if (cycle_.queue_is_gone()) return failure(MinorCode::Other, "TakeUpProgram: the machine was stopped meanwhile");
  for (BuiltMove& move : *rest) cycle_.queue.add(std::move(move));
  return {};
}

bool Parking::hold_taken_up() {
  const GatewayTurn turn(cycle_.lock);
  if (!parked_ || cycle_.queue.begins_anew() || cycle_.sequencer.state() != CycleState::Idle) return false;
  const ServoStatus now = cycle_.status();
  cycle_.sequencer.take_up(parked_->mode, cycle_.observe(now));
  (void)cycle_.feed.set(parked_->override_percent);  // unless the operator's stands
  cycle_.apply_feed();
  cycle_.wishes.keep_for_later(parked_->turned_off);
  parked_.reset();
  cycle_.settle(now);
  return true;
}

void Parking::drop_taken_up() {
  const GatewayTurn turn(cycle_.lock);
  if (cycle_.mechanism()) cycle_.empty_queue(cycle_.status());
}

void Parking::drop(const std::string& why) {
  if (!parked_) return;
  const GatewayTurn turn(cycle_.lock);
  cycle_.news.tell(Event::Kind::Mechanism,
                   fmt::format("the program that was parked on {} is dropped, with {} moves to do: {}",
                               parked_->mechanism, parked_->steps.size(), why));
  parked_.reset();
}

}  // namespace rmac::gateway
