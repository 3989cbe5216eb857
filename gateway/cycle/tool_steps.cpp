// The motion supervisor's tool changes: steps that stand in the queue between moves.
#include <fmt/format.h>

#include <algorithm>

#include "gateway/cycle/motion_supervisor.hpp"

namespace rmac::gateway {

Expected<> MotionSupervisor::add_steps(std::vector<QueueStep> steps, ProgramStep as_sent) {
  const Turn turn(*this);
  if (rebase_ || (sequencer_.state() == CycleState::Stopping && sequencer_.clears_at_rest())) {
    rebase_ = true;
    return failure(MinorCode::Other,
                   "DoToolChange: the machine was stopped and its queue emptied meanwhile; nothing was queued");
  }
  const std::size_t left_before = count_left();
  for (QueueStep& step : steps) {
    if (const auto* path = std::get_if<QueuedPath>(&step); path != nullptr && queue_listener_) {
      Move move;
      move.id = path->move_id;
      queue_listener_(move, path->segments);
    }
    behind_.push_back(std::move(step));
  }
  const std::size_t left = count_left();
  as_sent.counts = left - left_before;
  program_.add(std::move(as_sent), left);
  return {};
}

std::size_t MotionSupervisor::steps_left() const {
  return static_cast<std::size_t>(std::ranges::count_if(behind_, [](const QueueStep& step) {
    return std::holds_alternative<QueuedPath>(step) || std::holds_alternative<MountTool>(step);
  }));
}

ToolsNow MotionSupervisor::tools_now() {
  const Turn turn(*this);
  ToolsNow now{mounted_, {}, {}, changing_, {}};
  for (const QueueStep& step : behind_) {
    if (const auto* mount = std::get_if<MountTool>(&step)) {
      if (!now.wanted) now.wanted = mount->number;
      now.last = mount->number;
    }
  }
  if (asked_) now.prompt = std::get<AskPerson>(behind_.front()).text;
  return now;
}

void MotionSupervisor::set_mounted(std::optional<int> number, double max_torque_nm) {
  const Turn turn(*this);
  mounted_ = number;
  wishes_.tool_torque_nm = max_torque_nm;
  link_.wishes.write(wishes_);
}

Expected<> MotionSupervisor::confirm_tool(int number) {
  const Turn turn(*this);
  notice_fault();
  if (!asked_) {
    return failure(MinorCode::Other,
                   "ConfirmToolChange: nobody was asked for a tool; the change that is queued asks when the moves "
                   "before it are done and the spindle stands");
  }
  if (is_faulted(sequencer_.state())) {
    return failure(MinorCode::Other, fmt::format("ConfirmToolChange: the machine is {}; remove the cause and reset, "
                                                 "then say which tool is in the spindle",
                                                 to_string(sequencer_.state())));
  }
  const auto mount =
      std::ranges::find_if(behind_, [](const QueueStep& step) { return std::holds_alternative<MountTool>(step); });
  if (const int wanted = std::get<MountTool>(*mount).number; number != wanted) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("ConfirmToolChange: tool {} was asked for, not {}; put it in, or drop the program with "
                               "StopNow",
                               wanted, number));
  }
  asked_ = false;
  behind_.pop_front();
  take_steps(status());
  return {};
}

void MotionSupervisor::take_steps(const ServoStatus& status) {
  while (!behind_.empty() && mechanism_ && status.generation == generation_ && !is_faulted(sequencer_.state())) {
    const CycleObservation seen = observe(status);
    QueueStep& step = behind_.front();
    // A path is planned as soon as no other step is before it; the others wait for rest at its end. A tool that a
    // person put in is in, whether the cycle runs or not.
    const bool path = std::holds_alternative<QueuedPath>(step);
    const bool confirmed = std::holds_alternative<MountTool>(step) && changing_;
    const bool rests = seen.at_rest && seen.moves_left == 0 && !sequencer_.waits_for_spindle();
    if (!path && !(rests && (confirmed || sequencer_.state() == CycleState::Running))) return;
    if (!std::visit([&](auto& each) { return take(each, seen); }, step)) return;
    behind_.pop_front();
  }
}

bool MotionSupervisor::take(QueuedPath& path, const CycleObservation& /*seen*/) {
  hand_on(std::move(path));
  return true;
}

bool MotionSupervisor::take(BeginToolChange& begin, const CycleObservation& /*seen*/) {
  changing_ = true;
  mounted_.reset();
  wishes_.spindle_rpm.fill(0);
  wishes_.outputs &= ~begin.outputs_off;
  link_.wishes.write(wishes_);
  double patience_s = 0;
  for (const sdk::Spindle& spindle : mechanism_->device.spindles) {
    patience_s = std::max(patience_s, spindle.speed_timeout_s);
  }
  sequencer_.spindle_commanded(patience_s);
  return true;
}

bool MotionSupervisor::take(SwitchOutputs& outputs, const CycleObservation& /*seen*/) {
  wishes_.outputs = (wishes_.outputs & ~outputs.mask) | (outputs.values & outputs.mask);
  link_.wishes.write(wishes_);
  return true;
}

bool MotionSupervisor::take(AwaitInput& input, const CycleObservation& seen) {
  if (!input.since_s) input.since_s = seen.t_s;
  // No device is behind the inputs in virtual mode.
  const bool on = (link_.history.latest().inputs & input.bit) != 0;
  if (mechanism_->virtual_mode() || on == input.on) return true;
  if (seen.t_s - *input.since_s > input.timeout_s) {
    note({Event::Kind::Fault,
          t_s_,
          0,
          fmt::format("the tool change was not completed: input {} did not go {} within {} s; which tool is in the "
                      "spindle is not known. See to the changer, reset, then say with ConfirmToolChange which tool it "
                      "is",
                      input.name, input.on ? "on" : "off", input.timeout_s),
          cycle_,
          {},
          MinorCode::ResponseTimeout});
    sequencer_.fault();
    tell_state();
  }
  return false;
}

bool MotionSupervisor::take(AskPerson& person, const CycleObservation& /*seen*/) {
  if (!asked_) note({Event::Kind::ToolWanted, t_s_, 0, person.text, cycle_, {}});
  asked_ = true;
  return false;
}

bool MotionSupervisor::take(MountTool& mount, const CycleObservation& /*seen*/) {
  mounted_ = mount.number;
  changing_ = false;
  wishes_.frames.tool = mount.tip;
  wishes_.tool_torque_nm = mount.max_torque_nm;
  link_.wishes.write(wishes_);
  mechanism_->planner.clear();  // what was cut with another tool is not retraced with this one
  sequencer_.one_done();
  note({Event::Kind::ToolChanged, t_s_, 0, fmt::format("{} is in the spindle", mount.text), cycle_, {}});
  return true;
}

void MotionSupervisor::drop_steps() {
  const bool changes =
      std::ranges::any_of(behind_, [](const QueueStep& step) { return std::holds_alternative<MountTool>(step); });
  behind_.clear();
  asked_ = false;
  if (!changes) return;
  note({Event::Kind::ToolChangeDropped,
        t_s_,
        0,
        std::exchange(changing_, false)
            ? "the tool change was not completed, and which tool is in the spindle is not known: look, and say it with "
              "ConfirmToolChange"
            : "the tool change was dropped before it began; the spindle has the tool that it had",
        cycle_,
        {}});
}

}  // namespace rmac::gateway
