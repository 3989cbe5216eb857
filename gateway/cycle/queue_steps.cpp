#include "gateway/cycle/queue_steps.hpp"

namespace rmac::gateway {
namespace {

/// Outputs that switch on the way; null where the step is another, or a spindle's speed is to be waited for.
const Switch* switches_outputs(const QueueStep& step) {
  const auto* turn = std::get_if<InTurn>(&step);
  const auto* switching = turn != nullptr ? std::get_if<Switch>(&turn->what) : nullptr;
  return switching != nullptr && switching->speeds.empty() ? switching : nullptr;
}

}  // namespace

void QueueSteps::hand_on() {
  MoveQueue& queue = parts_.queue;
  while (!queue.steps().empty()) {
    if (std::holds_alternative<QueuedPath>(queue.next_step())) {
      queue.plan_next_step();
      continue;
    }
    const Switch* const switching = switches_outputs(queue.next_step());
    // Where no motion leads there, it is done when the cycle runs, as all else.
    if (switching == nullptr || queue.planned() == 0) return;
    parts_.marks.add(queue.done_at_end(), outputs_of(*switching));
    queue.lay_next_step(name_of(std::get<InTurn>(queue.next_step())));
  }
}

QueueSteps::Came QueueSteps::take(const CycleObservation& cycle, const Seen& seen) {
  if (!may_take(cycle)) {
    parts_.turn.pause();
    return Came::Nothing;
  }
  QueueStep& step = parts_.queue.next_step();
  const auto* const in_turn = std::get_if<InTurn>(&step);
  const Came came = in_turn != nullptr ? take(*in_turn, seen) : take_of_tool_change(step, seen);
  const bool done = came == Came::Done || came == Came::SpindlesTold || came == Came::ToolMounted;
  if (done) parts_.queue.step_done();
  return came;
}

bool QueueSteps::may_take(const CycleObservation& cycle) const {
  if (parts_.queue.steps().empty() || !cycle.at_end || cycle.moves_left > 0 || parts_.sequencer.waits_for_spindle())
    return false;
  // A tool that a person put in is in, whether the cycle runs or not.
  const bool confirmed = std::holds_alternative<MountTool>(parts_.queue.steps().front()) && parts_.tools.changing();
  return confirmed || parts_.sequencer.phase().runs<CyclePhase::Program>() != nullptr;
}

QueueSteps::Came QueueSteps::take(const InTurn& step, const Seen& seen) {
  switch (parts_.turn.take(step, {seen.t_s, seen.inputs, seen.virtual_mode})) {
    case ProgramTurn::Outcome::Waits:
      return Came::Nothing;
    case ProgramTurn::Outcome::Done:
      parts_.sequencer.one_done();
      return Came::Done;
    case ProgramTurn::Outcome::SpindlesTold:
      parts_.sequencer.one_done();
      return Came::SpindlesTold;
    case ProgramTurn::Outcome::Held:
      (void)parts_.sequencer.hold();
      parts_.turn.pause();
      return Came::Held;
  }
  return Came::Nothing;
}

QueueSteps::Came QueueSteps::take_of_tool_change(QueueStep& step, const Seen& seen) {
  switch (parts_.tools.take(step, seen)) {
    case ToolChange::Outcome::Waits:
      return Came::Nothing;
    case ToolChange::Outcome::Done:
      return Came::Done;
    case ToolChange::Outcome::Begun:
      return Came::SpindlesTold;
    case ToolChange::Outcome::Mounted:
      parts_.sequencer.one_done();
      return Came::ToolMounted;
    case ToolChange::Outcome::Failed:
      parts_.sequencer.fault();
      return Came::Failed;
  }
  return Came::Nothing;
}

}  // namespace rmac::gateway
