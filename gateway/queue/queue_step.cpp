#include "gateway/queue/queue_step.hpp"

#include <fmt/format.h>

namespace rmac::gateway {
namespace {

/// "spindle 0 at 800 rpm, Coolant on"
std::string text_of(const Switch& switching) {
  std::string text;
  const auto add = [&](const std::string& one) { text += (text.empty() ? "" : ", ") + one; };
  for (const Switch::Speed& speed : switching.speeds)
    add(fmt::format("spindle {} at {:g} rpm", speed.spindle, speed.rpm));
  for (const Switch::Output& output : switching.outputs) add(output.name + (output.on ? " on" : " off"));
  return text;
}

struct Name {
  std::int64_t id = 0;

  std::string operator()(const Dwell& /*dwell*/) const { return fmt::format("dwell {}", id); }
  std::string operator()(const ProgramStop& stop) const {
    return fmt::format("{} stop {}", stop.optional ? "optional" : "program", id);
  }
  std::string operator()(const AwaitInput& /*input*/) const { return fmt::format("wait for an input {}", id); }
  std::string operator()(const Switch& switching) const {
    return fmt::format("calls in turn {} ({})", id, text_of(switching));
  }
};

}  // namespace

SwitchOutputs outputs_of(const Switch& switching) {
  SwitchOutputs outputs;
  for (const Switch::Output& output : switching.outputs) {
    outputs.mask |= output.bit;
    outputs.values = output.on ? outputs.values | output.bit : outputs.values & ~output.bit;
  }
  return outputs;
}

std::string name_of(const InTurn& turn) {
  return std::visit(Name{turn.move_id}, turn.what);
}

}  // namespace rmac::gateway
