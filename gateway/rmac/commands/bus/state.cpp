#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "gateway/rmac/commands/bus/registrations.hpp"
#include "gateway/rmac/records/flight_records.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "rmac/fieldbus/eds/object_entry.hpp"

namespace rmac::cli {
namespace {

using Json = nlohmann::json;

std::string count(const Json& of, const char* key) {
  return std::to_string(of.at(key).get<std::uint64_t>());
}

std::string microseconds(const Json& node, const char* key) {
  constexpr double kPerSecond = 1e6;
  return node.at("answers").get<std::uint64_t>() == 0 ? "-" : number(node.at(key).get<double>() * kPerSecond, 1);
}

std::string numbers(const Json& list) {
  std::string text;
  for (const Json& each : list) text += fmt::format("{}{}", text.empty() ? "" : ", ", each.get<std::uint64_t>());
  return text;
}

void show_nodes(const Json& nodes) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& node : nodes) {
    rows.push_back({count(node, "node"), numbers(node.at("axes")), node.at("state").get<std::string>(),
                    count(node, "lost"), count(node, "recovered"), count(node, "missed_answers"),
                    microseconds(node, "jitter_mean_s"), microseconds(node, "jitter_most_s"),
                    count(node, "emergency_count"), count(node, "abort_count")});
  }
  fmt::print("{}",
             table({"node", "axes", "state", "lost", "back", "missed", "jitter µs", "most", "EMCY", "aborts"}, rows));
}

/// What a row cannot say.
void show_history(const Json& node) {
  const std::string who = fmt::format("node {}: ", count(node, "node"));
  if (!node.at("problem").is_null()) fmt::print("{}{}\n", who, node.at("problem").get<std::string>());
  for (const Json& each : node.at("emergencies")) {
    fmt::print("{}EMCY {:04X}h ({}), error register {:02X}h, {} s ago\n", who, each.at("code").get<unsigned>(),
               each.at("text").get<std::string>(), each.at("error_register").get<unsigned>(),
               number(each.at("age_s").get<double>(), 1));
  }
  for (const Json& each : node.at("aborts")) {
    const fieldbus::ObjectAddress object{each.at("index").get<std::uint16_t>(), each.at("sub").get<std::uint8_t>()};
    fmt::print("{}refused {}: {} ({:08X}h)\n", who, to_string(object), each.at("text").get<std::string>(),
               each.at("code").get<std::uint32_t>());
  }
}

std::string controller(const Json& told) {
  const auto state = told.at("state").get<std::string>();
  if (told.at("transmit_errors").is_null()) {
    return state == "unknown" ? "the interface tells of no controller"
                              : fmt::format("controller {}, error counters not told", state);
  }
  return fmt::format("controller {}, error counters {} transmit, {} receive", state, count(told, "transmit_errors"),
                     count(told, "receive_errors"));
}

void show_bus(const Json& bus) {
  fmt::print(
      "{}: {} cycles, {} frames sent, {} received; {} unsent, {} too short, {} lost here, {} error frames, {} times "
      "error-warning, {} error-passive, {} bus-off{}{}\n{}\n",
      bus.at("interface").get<std::string>(), count(bus, "cycles"), count(bus, "sent"), count(bus, "received"),
      count(bus, "unsent"), count(bus, "short_answers"), count(bus, "overflowed"), count(bus, "error_frames"),
      count(bus, "warnings"), count(bus, "passives"), count(bus, "bus_offs"),
      bus.at("bus_off").get<bool>() ? "; it is bus-off" : "",
      bus.at("link_down").get<bool>() ? "; the interface is down" : "", controller(bus.at("controller")));
  show_nodes(bus.at("nodes"));
  for (const Json& node : bus.at("nodes")) show_history(node);
}

void show_units(const Json& units) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& unit : units) {
    std::string exceptions;
    for (const Json& each : unit.at("exceptions")) {
      exceptions +=
          fmt::format("{}{}: {}", exceptions.empty() ? "" : ", ", each.at("code").get<int>(), count(each, "count"));
    }
    rows.push_back({count(unit, "unit"), unit.at("state").get<std::string>(), count(unit, "requests"),
                    count(unit, "answers"), count(unit, "timeouts"), count(unit, "wrong_answers"),
                    count(unit, "disconnects"), exceptions.empty() ? "-" : exceptions});
  }
  fmt::print("{}", table({"unit", "state", "requests", "answers", "time-outs", "wrong", "breaks", "exceptions"}, rows));
}

void show_line(const Json& line) {
  fmt::print("{}: {} rounds, opened {} times\n", line.at("endpoint").get<std::string>(), count(line, "rounds"),
             count(line, "connections"));
  show_units(line.at("units"));
  for (const Json& unit : line.at("units")) {
    const Json& last = unit.at("last_trouble");
    if (last.is_null()) continue;
    fmt::print("unit {}: {}, {} s ago\n", count(unit, "unit"), last.at("message").get<std::string>(),
               number(last.at("age_s").get<double>(), 1));
  }
}

void show_buses(const Json& report, bool as_json) {
  if (as_json) {
    fmt::print("{}\n", report.dump());
    return;
  }
  if (report.at("buses").empty() && report.at("lines").empty()) fmt::print("no CANopen bus and no Modbus line runs\n");
  for (const Json& bus : report.at("buses")) show_bus(bus);
  for (const Json& line : report.at("lines")) show_line(line);
}

Result<> show_recorded(Connection& appliance, const std::string& record, bool as_json) {
  return fetch_flight_record(appliance, record).and_then([&](const std::string& text) -> Result<> {
    const Json head = Json::parse(text.substr(0, text.find('\n')), nullptr, false);
    const auto buses = head.is_object() ? head.find("buses") : head.end();
    if (buses == head.end() || !buses->is_object())
      return fail(fmt::format("flight record {} tells nothing of buses; records of earlier versions do not", record));
    show_buses(*buses, as_json);
    return {};
  });
}

Result<> show_state(Connection& appliance, const std::string& record, bool as_json) {
  if (!record.empty()) return show_recorded(appliance, record, as_json);
  return appliance.call("Bus.GetState").map([as_json](const Json& answer) { show_buses(answer, as_json); });
}

}  // namespace

void add_bus_state(Command& bus) {
  Command state =
      bus.add("state", "what the CANopen buses and Modbus lines of the machine that is loaded went through");
  const auto record = std::make_shared<std::string>();
  state.option("--record", record.get(),
               "as they were when this flight record was made, instead of now (`rmac trace`)");
  state.does(with_appliance(
      [record](Connection& appliance, bool as_json) { return show_state(appliance, *record, as_json); }));
}

}  // namespace rmac::cli
