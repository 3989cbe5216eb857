#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "gateway/api/enumeration.hpp"
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

/// As RMAC_CAM.StatusMinorCode names it.
std::string minor_code(int code) {
  const auto* value = gateway::kMinorCodeValues.find(code);
  return code == 0 ? "none" : value == nullptr ? std::to_string(code) : value->name;
}

/// What stopped the machine last, in some lines below the table.
std::string last_stop(const StateNote& state) {
  const EventNote& stop = state.last_stop;
  if (stop.kind.empty()) return "";
  std::string text =
      fmt::format("\nlast stop ({}): cycle {}, {} s: {}\n", stop.kind, stop.cycle, number(stop.t_s, 4), stop.message);
  if (!stop.record.empty()) {
    text += fmt::format("flight record {}: rmac trace plot {}\n", stop.record, stop.record);
  }
  if (state.faulted()) text += "to go on, its cause removed: rmac reset\n";
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
                              {"cycles begin", "99.9 % within " + number(state.wake_up_p999_us, 1), "µs"},
                              {"deadlines missed", std::to_string(state.deadline_misses), ""},
                              {"to do", state.tool_prompt.empty() ? "-" : state.tool_prompt, ""},
                              {"authority", state.authority.empty() ? "nobody" : state.authority, ""},
                              {"last error", minor_code(state.status_minor), ""}}) +
         last_stop(state);
}

/// Bins joined to octaves, each with a bar as long as the logarithm of its count: one cycle in a million is to be seen.
std::string bars(const nlohmann::json& bins) {
  std::map<int, std::uint64_t> octaves;
  for (const auto& bin : bins) octaves[std::ilogb(bin[0].get<double>())] += bin[1].get<std::uint64_t>();
  std::string text;
  for (const auto& [octave, count] : octaves) {
    constexpr double kDecade = 6;
    const auto length = static_cast<std::size_t>(1 + kDecade * std::log10(static_cast<double>(count)));
    text += fmt::format("{:>10} µs {:>12}  {}\n", fmt::format("< {:g}", std::ldexp(1, octave + 1)), count,
                        std::string(length, '#'));
  }
  return text;
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

Result<> show_cycles(Connection& connection, bool json) {
  return connection.call("RMAC_CAM.GetCycleTimes").map([json](const nlohmann::json& times) {
    if (json) {
      fmt::print("{}\n", times.dump());
      return;
    }
    std::vector<std::vector<std::string>> rows;
    std::string drawn;
    for (const auto& [key, what] :
         {std::pair{"wake_up", "after it was due"}, {"compute", "computing"}, {"bus", "on the bus"}}) {
      const nlohmann::json& of = times.at(key);
      rows.push_back({what, std::to_string(of.at("count").get<std::uint64_t>())});
      for (const char* column : {"median_us", "p99_us", "p999_us", "largest_us"}) {
        rows.back().push_back(number(of.at(column).get<double>(), 1));
      }
      drawn += fmt::format("\n{}:\n{}", what, bars(of.at("bins")));
    }
    fmt::print("{}{}{} deadlines missed\n", table({"", "cycles", "median", "99 %", "99.9 %", "largest µs"}, rows),
               drawn, times.at("deadline_misses").get<std::uint64_t>());
  });
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
                 event.move_id > 0 ? fmt::format("move {}  ", event.move_id) : "", event.message,
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
