#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "gateway/api/enumeration.hpp"
#include "gateway/rmac/commands/watch/interruption.hpp"
#include "gateway/rmac/commands/watch/registrations.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {

std::string list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "" : "  ") + number(value, 4);
  }
  return text.empty() ? "-" : text;
}

/// As RMAC_CAM.StatusMinorCode names it.
std::string minor_code(int code) {
  const auto* value = gateway::kMinorCodeValues.find(code);
  return code == 0 ? "none" : value == nullptr ? std::to_string(code) : value->name;
}

/// How long ago something happened, by the machine's own time.
std::string ago(const EventNote& then, const StateNote& now) {
  return fmt::format("{} s ago", number(std::max(0.0, now.t_s - then.t_s), 1));
}

/// Why the machine does not move, where it seems as if it should, and what a person does about it: lines below the
/// table.
std::string standstill(const StateNote& state) {
  std::string text;
  if (!state.held_by.empty()) {
    text += fmt::format("\n{} holds the machine; to go on: rmac resume{}\n", state.held_by,
                        state.override_percent == 0 ? ", and rmac override 100" : "");
  }
  if (state.waits_for == "moves") {
    text += "\nthe cycle is started and waits for moves, so jog and home are refused; to end it: rmac stop\n";
  } else if (state.waits_for == "override") {
    text += "\nthe cycle waits for a feed override above 0: rmac override 100\n";
  } else if (!state.waits_for.empty()) {
    text += fmt::format("\nthe cycle waits for the {}\n", state.waits_for);
  }
  return text;
}

std::string last_error(const StateNote& state) {
  const EventNote& error = state.last_error;
  if (error.message.empty()) return "";
  return fmt::format("\nlast error, {}: {}\nto clear it: rmac reset\n", ago(error, state), error.message);
}

/// What stopped the machine last, in some lines below the table.
std::string last_stop(const StateNote& state) {
  const EventNote& stop = state.last_stop;
  if (stop.kind.empty()) return "";
  std::string text = fmt::format("\nlast stop ({}), {}: cycle {}, {} s: {}\n", stop.kind, ago(stop, state), stop.cycle,
                                 number(stop.t_s, 4), stop.message);
  if (!stop.record.empty()) {
    text += fmt::format("flight record {}: rmac trace plot {}\n", stop.record, stop.record);
  }
  if (state.faulted()) text += "to go on, its cause removed: rmac reset\n";
  return text;
}

/// What a person is to see to.
std::string to_do(const StateNote& state) {
  if (!state.tool_prompt.empty()) return state.tool_prompt;
  return state.stop_prompt.empty() ? "-" : state.stop_prompt;
}

std::string ahead(const StateNote& state) {
  if (state.horizon_limit.empty()) return "-";
  return fmt::format("{} ms, {}", number(state.horizon_s * 1000, 0), state.horizon_limit);
}

std::string state_table(const StateNote& state) {
  const auto machine =
      state.mechanism.empty() ? "none loaded" : state.mechanism + (state.virtual_mode ? ", virtual" : "");
  return table({"", "", ""}, {{"machine", machine, ""},
                              {"cycle", state.state + (state.moving ? ", moving" : ", at rest"), ""},
                              {"move", std::to_string(state.move_id), ""},
                              {"queued", std::to_string(state.moves_in_buffer), "moves"},
                              {"planned ahead", ahead(state), ""},
                              {"feed", number(state.feed_actual, 1) + " of " + number(state.feed_set, 1), "mm/min"},
                              {"override", number(state.override_percent, 1), "%"},
                              {"tool tip", list(state.pose), "mm, axis"},
                              {"joints", list(state.joints), "mm or deg"},
                              {"held joints", list(state.held_joints), "mm or deg"},
                              {"spindle", list(state.spindle_rpm), "rpm"},
                              {"cycles begin", "99.9 % within " + number(state.wake_up_p999_us, 1), "µs"},
                              {"deadlines missed", std::to_string(state.deadline_misses), ""},
                              {"to do", to_do(state), ""},
                              {"authority", state.authority.empty() ? "nobody" : state.authority, ""},
                              {"operator", state.on_duty.empty() ? "nobody" : state.on_duty, ""},
                              {"last error", minor_code(state.status_minor), ""}}) +
         standstill(state) + last_error(state) + last_stop(state);
}

Result<> show_status(Connection& connection, bool watch, bool json) {
  constexpr double kRateHz = 5;
  bool seen = false;
  const bool redraw = watch && !json && isatty(STDOUT_FILENO) == 1;
  connection.on_notification([&](const std::string& topic, const nlohmann::json& params) {
    if (topic != kStateTopic || (seen && !watch)) {
      return;
    }
    seen = true;
    fmt::print("{}{}{}", redraw ? "\x1b[H\x1b[2J" : "", json ? params.dump() : state_table(read_state(params)),
               json || (watch && !redraw) ? "\n" : "");
    std::fflush(stdout);
  });
  if (auto heard = subscribe(connection, kStateTopic, kRateHz); !heard) return heard;
  auto done = watch ? wait_until_interrupted(connection) : connection.wait([&] { return seen; });
  connection.on_notification({});
  return done;
}

}  // namespace

void add_status(Command& rmac) {
  const auto watch = std::make_shared<bool>(false);
  Command status = rmac.add("status", "what the machine does now");
  status.flag("--watch", watch.get(), "go on until Ctrl-C");
  status.does(
      with_appliance([watch](Connection& appliance, bool json) { return show_status(appliance, *watch, json); }));
}

}  // namespace rmac::cli
