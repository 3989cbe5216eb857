// RMAC_CAM.*: what a program does between its moves, each in its turn.
#include <fmt/format.h>

#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"
#include "gateway/json/printable.hpp"

namespace rmac::gateway {

namespace {

constexpr std::size_t kLongestMessage = 200;

Expected<> stop(Call& call, std::int64_t id, std::optional<bool> optional, const std::optional<std::string>& message) {
  const std::string text = message.value_or("");
  if (text.size() > kLongestMessage) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("ProgramStop: the Message has {} bytes; a person is told at most {}", text.size(),
                               kLongestMessage));
  }
  return call.machine.cam().flow().stop(id, optional.value_or(false), printable(text));
}

/// A switch that the person at the machine may use as well as the program's client.
Expected<> set_optional_stops(Call& call, bool on) {
  call.machine.cam().flow().set_optional_stops(on);
  if (!call.session.has_authority())
    call.session.tell(on ? "switches optional stops on" : "switches optional stops off");
  return {};
}

MethodBuilder<> in_turn_method(const char* name, const char* meaning) {
  return method(name, meaning).gives(WireType::Boolean).causes(Effect::Queues).extension();
}

}  // namespace

void add_program_flow_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add(in_turn_method("RMAC_CAM.Dwell", "Queues a rest of so long (G4). Time that the program is held does not count.")
          .takes(move_id(), number("Time", "s").within(0, sdk::ProgramFlow::kLongest_s))
          .does(
              [](Call& call, std::int64_t id, double time_s) { return call.machine.cam().flow().dwell(id, time_s); }));
  add(in_turn_method("RMAC_CAM.ProgramStop",
                     "Queues a stop (M0; optional: M1): the program is held at rest there, the event ProgramStopped "
                     "tells why, and FeedResume goes on. Spindle and outputs stay as they are.")
          .takes(move_id(),
                 boolean("Optional")
                     .optional()
                     .noted("true: passed over unless SetOptionalStop switched optional "
                            "stops on before its turn comes"),
                 text("Message").optional().noted("for the person at the machine, at most 200 bytes"))
          .does(stop));
  add(in_turn_method("RMAC_CAM.AwaitInput",
                     "Queues a rest until a named input of the machine is on, or off. When it is not within the "
                     "time-out, the program is held, and ProgramStopped tells what it waited for; FeedResume waits "
                     "once more. In virtual mode every input is as it is waited for.")
          .takes(move_id(), text("Name").noted("of DigitalIOInterface/Inputs in device.json"), boolean("On"),
                 number("TimeOut", "s").within(0, sdk::ProgramFlow::kLongest_s))
          .does([](Call& call, std::int64_t id, const std::string& name, bool on, double timeout_s) {
            return call.machine.cam().flow().await_input(id, name, on, timeout_s);
          }));
  add(method("RMAC_CAM.SetOptionalStop",
             "Switches optional stops on or off, as the switch on a panel does; off at first. A stop whose turn comes "
             "afterwards goes by it.")
          .takes(boolean("On"))
          .needs(Permission::Operator)
          .extension()
          .does(set_optional_stops));
  add(method("RMAC_CAM.GetOptionalStop", "What SetOptionalStop set.")
          .gives(WireType::Boolean)
          .extension()
          .does([](Call& call) { return call.machine.cam().flow().optional_stops(); }));
}

}  // namespace rmac::gateway
