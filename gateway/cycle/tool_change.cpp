#include "gateway/cycle/tool_change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace rmac::gateway {

void ToolChange::set_mounted(std::optional<int> number, double max_torque_nm) {
  mounted_ = number;
  wishes_.change([&](ServoWishes& wishes) { wishes.tool_torque_nm = max_torque_nm; });
}

ToolsNow ToolChange::now(const std::deque<QueueStep>& queued) const {
  ToolsNow now;
  now.mounted = mounted_;
  now.changing = changing_;
  now.spindle_rpm = wishes_.now().spindle_rpm;
  for (const QueueStep& step : queued) {
    if (std::holds_alternative<BeginToolChange>(step)) now.spindle_rpm.fill(0);
    const auto* const turn = std::get_if<InTurn>(&step);
    if (const auto* switching = turn != nullptr ? std::get_if<Switch>(&turn->what) : nullptr) {
      for (const Switch::Speed& speed : switching->speeds) now.spindle_rpm[speed.spindle] = speed.rpm;
    }
    if (const auto* mount = std::get_if<MountTool>(&step)) {
      if (!now.wanted) now.wanted = mount->number;
      now.last = mount->number;
    }
  }
  if (asked_) now.prompt = std::get<AskPerson>(queued.front()).text;
  return now;
}

ToolChange::Outcome ToolChange::take(QueueStep& step, const Seen& seen) {
  if (const auto* begin = std::get_if<BeginToolChange>(&step)) return take(*begin);
  if (const auto* outputs = std::get_if<SwitchOutputs>(&step)) return take(*outputs);
  if (auto* input = std::get_if<AwaitInput>(&step)) return take(*input, seen);
  if (const auto* person = std::get_if<AskPerson>(&step)) return take(*person);
  return take(std::get<MountTool>(step));
}

ToolChange::Outcome ToolChange::take(const BeginToolChange& begin) {
  changing_ = true;
  mounted_.reset();
  wishes_.turn_off(begin.outputs_off);
  return Outcome::Begun;
}

ToolChange::Outcome ToolChange::take(const SwitchOutputs& outputs) {
  wishes_.change([&](ServoWishes& wishes) {
    wishes.outputs = (wishes.outputs & ~outputs.mask) | (outputs.values & outputs.mask);
  });
  return Outcome::Done;
}

ToolChange::Outcome ToolChange::take(AwaitInput& input, const Seen& seen) {
  if (!input.since_s) input.since_s = seen.t_s;
  const bool on = (seen.inputs & input.bit) != 0;
  if (seen.virtual_mode || on == input.on) return Outcome::Done;
  if (seen.t_s - *input.since_s <= input.timeout_s) return Outcome::Waits;
  news_.tell(Event::Kind::Fault,
             fmt::format("the tool change was not completed: input {} did not go {} within {} s; which tool is in the "
                         "spindle is not known. See to the changer, reset, then say with ConfirmToolChange which tool "
                         "it is",
                         input.name, input.on ? "on" : "off", input.timeout_s),
             MinorCode::ResponseTimeout);
  return Outcome::Failed;
}

ToolChange::Outcome ToolChange::take(const AskPerson& person) {
  if (!asked_) news_.tell(Event::Kind::ToolWanted, person.text);
  asked_ = true;
  return Outcome::Waits;
}

ToolChange::Outcome ToolChange::take(const MountTool& mount) {
  mounted_ = mount.number;
  last_mounted_ = mount.tool;
  changing_ = false;
  wishes_.change([&](ServoWishes& wishes) {
    wishes.frames.tool = mount.tip;
    wishes.tool_torque_nm = mount.max_torque_nm;
  });
  news_.tell(Event::Kind::ToolChanged, fmt::format("{} is in the spindle", mount.text));
  return Outcome::Mounted;
}

Expected<> ToolChange::confirm(int number, const std::deque<QueueStep>& queued, CycleState state) {
  if (!asked_) {
    return failure(MinorCode::Other,
                   "ConfirmToolChange: nobody was asked for a tool; the change that is queued asks when the moves "
                   "before it are done and the spindle stands");
  }
  if (is_faulted(state)) {
    return failure(MinorCode::Other, fmt::format("ConfirmToolChange: the machine is {}; remove the cause and reset, "
                                                 "then say which tool is in the spindle",
                                                 to_string(state)));
  }
  const auto mount =
      std::ranges::find_if(queued, [](const QueueStep& step) { return std::holds_alternative<MountTool>(step); });
  if (const int wanted = std::get<MountTool>(*mount).number; number != wanted) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("ConfirmToolChange: tool {} was asked for, not {}; put it in, or drop the program with "
                               "StopNow",
                               wanted, number));
  }
  asked_ = false;
  return {};
}

void ToolChange::drop(bool was_queued) {
  asked_ = false;
  if (!was_queued) return;
  news_.tell(Event::Kind::ToolChangeDropped,
             std::exchange(changing_, false)
                 ? "the tool change was not completed, and which tool is in the spindle is not known: look, and say it "
                   "with ConfirmToolChange"
                 : "the tool change was dropped before it began; the spindle has the tool that it had");
}

}  // namespace rmac::gateway
