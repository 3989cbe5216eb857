// RMAC_CAM.*: what a program does between its moves, each in its turn.
#include <fmt/format.h>

#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"
#include "gateway/json/printable.hpp"

namespace rmac::gateway {

namespace {

constexpr std::size_t kLongestMessage = 200;
constexpr std::size_t kMostCalls = 64;

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

using Calls = std::vector<sdk::CallInTurn>;

RpcError refused(std::size_t index, const std::string& why) {
  return {rpc_code::kInvalidParams, fmt::format("InTurn: Calls[{}]: {}", index, why), MinorCode::InvalidParameterValue};
}

/// The values of a method's parameters, by its own declaration.
template <typename... Ts>
tl::expected<std::tuple<Ts...>, RpcError> values_of(const Method& called, const nlohmann::json& params) {
  const auto arguments = arrange(called, params);
  if (!arguments) return tl::unexpected<RpcError>(arguments.error());
  std::tuple<Ts...> values{};
  RpcError error;
  std::size_t i = 0;
  const auto take = [&](auto& value) {
    const std::size_t at = i++;
    return detail::take((*arguments)[at], called.parameters[at], value, error);
  };
  const bool taken = std::apply([&](auto&... value) { return (take(value) && ...); }, values);
  if (!taken) return tl::unexpected<RpcError>(std::move(error));
  return values;
}

tl::expected<sdk::CallInTurn, RpcError> read_call(const std::string& name, const nlohmann::json& params) {
  const Method* const called = find_method(name);
  if (name == "RMAC_CAM.SetSpindleRPM") {
    return values_of<std::int64_t, double>(*called, params).map([](const auto& values) -> sdk::CallInTurn {
      return sdk::SpindleCall{static_cast<int>(std::get<0>(values)), std::get<1>(values)};
    });
  }
  if (name == "RMAC_CAM.SetOutput") {
    return values_of<std::string, bool>(*called, params).map([](const auto& values) -> sdk::CallInTurn {
      return sdk::OutputCall{std::get<0>(values), std::get<1>(values)};
    });
  }
  const bool on = name == "RMAC_CAM.TurnCoolantOn";
  if (!on && name != "RMAC_CAM.TurnCoolantOff") {
    return tl::unexpected<RpcError>({rpc_code::kInvalidParams,
                                     fmt::format("{} is not called in turn; RMAC_CAM.SetSpindleRPM, TurnCoolantOn, "
                                                 "TurnCoolantOff and SetOutput are",
                                                 printable(name, 80)),
                                     MinorCode::InvalidParameterValue});
  }
  return values_of<>(*called, params).map([on](const auto&) -> sdk::CallInTurn {
    return sdk::OutputCall{"Coolant", on};
  });
}

tl::expected<Calls, RpcError> read_calls(const nlohmann::json& entries) {
  Calls calls;
  if (entries.empty() || entries.size() > kMostCalls) {
    return tl::unexpected<RpcError>({rpc_code::kInvalidParams,
                                     fmt::format("InTurn: {} Calls; there must be 1 to {}", entries.size(), kMostCalls),
                                     MinorCode::InvalidParameterValue});
  }
  for (const nlohmann::json& entry : entries) {
    if (!entry.is_object()) {
      return tl::unexpected(
          refused(calls.size(), fmt::format("{} is no object of \"method\" and \"params\"", shortened(entry))));
    }
    for (const auto& [key, value] : entry.items()) {
      if (key == "method" || key == "params") continue;
      return tl::unexpected(refused(
          calls.size(), fmt::format("no member \"{}\"; a call has \"method\" and \"params\"", printable(key, 80))));
    }
    const auto name = entry.find("method");
    if (name == entry.end() || !name->is_string()) {
      return tl::unexpected(refused(calls.size(), "\"method\" is missing, or no text"));
    }
    auto read = read_call(name->get<std::string>(), entry.value("params", nlohmann::json()));
    if (!read) return tl::unexpected(refused(calls.size(), read.error().message));
    calls.push_back(std::move(*read));
  }
  return calls;
}

tl::expected<nlohmann::json, RpcError> in_turn(Call& call, std::int64_t id, const JsonValue& entries) {
  const auto calls = read_calls(entries.json);
  if (!calls) return tl::unexpected<RpcError>(calls.error());
  return detail::finish(call.machine.cam().flow().in_turn(id, *calls), call, true);
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
  add(in_turn_method(
          "RMAC_CAM.InTurn",
          "Queues calls between moves: `SetSpindleRPM`, `TurnCoolantOn`, `TurnCoolantOff`, `SetOutput`, made "
          "in their order when the moves before them are done. What follows waits for the spindles' speeds.")
          .takes(move_id(), objects("Calls").noted("each `{\"method\", \"params\"}`, as it would be sent"))
          .does(in_turn));
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
