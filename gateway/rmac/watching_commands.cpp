#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "gateway/rmac/commands.hpp"
#include "gateway/rmac/notes.hpp"
#include "gateway/rmac/table.hpp"

namespace rmac::cli {

namespace {

std::string list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "" : "  ") + number(value, 4);
  }
  return text.empty() ? "-" : text;
}

/// What stopped the machine last, in a line or two below the table.
std::string last_stop(const EventNote& stop) {
  if (stop.kind.empty()) return "";
  std::string text =
      fmt::format("\nlast stop ({}): cycle {}, {} s: {}\n", stop.kind, stop.cycle, number(stop.t_s, 4), stop.message);
  if (!stop.record.empty()) {
    text += fmt::format("flight record {}: rmac trace plot {}\n", stop.record, stop.record);
  }
  return text;
}

std::string state_table(const StateNote& state) {
  const auto machine =
      state.mechanism.empty() ? "none loaded" : state.mechanism + (state.virtual_mode ? ", virtual" : "");
  return table({"", "", ""}, {{"machine", machine, ""},
                              {"cycle", state.state + (state.moving ? ", moving" : ", at rest"), ""},
                              {"move", std::to_string(state.move_id), ""},
                              {"queued", std::to_string(state.moves_in_buffer), "moves"},
                              {"feed", number(state.feed_actual, 1) + " of " + number(state.feed_set, 1), "mm/min"},
                              {"override", number(state.override_percent, 1), "%"},
                              {"tool tip", list(state.pose), "mm, axis"},
                              {"joints", list(state.joints), "mm or deg"},
                              {"held joints", list(state.held_joints), "mm or deg"},
                              {"spindle", list(state.spindle_rpm), "rpm"},
                              {"to do", state.tool_prompt.empty() ? "-" : state.tool_prompt, ""},
                              {"authority", state.authority.empty() ? "nobody" : state.authority, ""},
                              {"last error", state.status_minor == 0 ? "none" : std::to_string(state.status_minor),
                               state.status_minor == 0 ? "" : "StatusMinorCode"}}) +
         last_stop(state.last_stop);
}

/// Ctrl-C is how a person ends watching, not a failure.
Result<> until_interrupted(Connection& connection) {
  auto waited = connection.wait([] { return false; });
  return connection.interrupted() ? Result<>() : waited;
}

}  // namespace

Result<> show_status(Connection& connection, bool watch, bool json) {
  constexpr double kRateHz = 5;
  bool seen = false;
  const bool redraw = watch && !json && isatty(STDOUT_FILENO) == 1;
  connection.on_notification([&](const std::string& topic, const nlohmann::json& params) {
    if (topic != "state" || (seen && !watch)) {
      return;
    }
    seen = true;
    fmt::print("{}{}{}", redraw ? "\x1b[H\x1b[2J" : "", json ? params.dump() : state_table(read_state(params)),
               json || (watch && !redraw) ? "\n" : "");
    std::fflush(stdout);
  });
  if (auto topics = connection.call("subscribe", {{"topics", {"state"}}, {"rate_hz", kRateHz}}); !topics) {
    return tl::unexpected(topics.error());
  }
  auto done = watch ? until_interrupted(connection) : connection.wait([&] { return seen; });
  connection.on_notification({});
  return done;
}

Result<> show_events(Connection& connection, bool json) {
  connection.on_notification([&](const std::string& topic, const nlohmann::json& params) {
    if (topic != "events") {
      return;
    }
    const auto event = read_event(params);
    if (json) {
      fmt::print("{}\n", params.dump());
    } else {
      fmt::print("{:>12}  {:>10}  {:<18}{}{}{}\n", number(event.t_s), event.cycle, event.kind,
                 event.move_id != 0 ? fmt::format("move {}  ", event.move_id) : "", event.message,
                 event.kind == "Fault" && !event.record.empty() ? "; flight record " + event.record : "");
    }
    std::fflush(stdout);
  });
  if (auto topics = connection.call("subscribe", {{"topics", {"events"}}}); !topics) {
    return tl::unexpected(topics.error());
  }
  auto done = until_interrupted(connection);
  connection.on_notification({});
  return done;
}

}  // namespace rmac::cli
