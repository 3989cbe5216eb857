#include "gateway/buses/report/bus_changes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rmac::gateway {
namespace {

using fieldbus::BusReport;
using fieldbus::NodeReport;
using fieldbus::modbus::LineReport;
using fieldbus::modbus::UnitReport;

/// The one of `list` whose `key` is the same as that of `sought`; nullptr: none.
template <typename T, typename Key>
const T* same_of(const std::vector<T>& list, const T& sought, Key key) {
  const auto found = std::ranges::find(list, sought.*key, key);
  return found == list.end() ? nullptr : &*found;
}

/// By how much a counter went up; one that began anew by all that it has.
std::uint64_t since(std::uint64_t before, std::uint64_t now) {
  return now < before ? now : now - before;
}

class Comparison {
 public:
  void compare(const BusReport& before, const BusReport& now) {
    compare_controllers(before, now);
    for (const NodeReport& node : now.nodes) {
      const NodeReport* const known = same_of(before.nodes, node, &NodeReport::node);
      if (known != nullptr) compare(fmt::format("{} node {}", now.interface, node.node), *known, node);
    }
  }

  void compare(const LineReport& before, const LineReport& now) {
    for (const UnitReport& unit : now.units) {
      const UnitReport* const known = same_of(before.units, unit, &UnitReport::unit);
      if (known == nullptr || known->state == unit.state) continue;
      const std::string who = fmt::format("{} unit {}", now.endpoint, unit.unit);
      const auto& trouble = unit.traffic.last_trouble;
      const bool tells_why = unit.state != "answers" && trouble;
      tell(who, "state",
           fmt::format("{}, after it {}{}", unit.state, known->state, tells_why ? ": " + trouble->message : ""));
    }
  }

  [[nodiscard]] std::vector<BusChange> take() { return std::move(changes_); }

 private:
  void compare_controllers(const BusReport& before, const BusReport& now) {
    if (before.health.link_down != now.health.link_down)
      tell(now.interface, "link", now.health.link_down ? "the interface is down" : "the interface is up again");
    const auto from = before.controller.state, to = now.controller.state;
    // Between two looks it may have gone there and come back; its error frames are counted.
    const std::uint64_t passives = since(before.health.passives, now.health.passives);
    const std::uint64_t bus_offs = since(before.health.bus_offs, now.health.bus_offs);
    const std::uint64_t warnings = since(before.health.warnings, now.health.warnings);
    const std::uint64_t times = warnings + passives + bus_offs;
    if (from == to && times == 0) return;
    std::string message = fmt::format("controller {}", to_string(to));
    if (from != to) message += fmt::format(", after {}", to_string(from));
    if (times > 0)
      message +=
          fmt::format("; {} times error-warning, {} error-passive, {} bus-off since", warnings, passives, bus_offs);
    tell(now.interface, "controller", message);
  }

  void compare(const std::string& who, const NodeReport& before, const NodeReport& now) {
    const std::string why = now.problem ? ": " + *now.problem : "";
    if (before.state != now.state) {
      tell(who, "state", fmt::format("{}, after {}{}", now.state, before.state, why));
    } else if (now.recovered > before.recovered) {
      tell(who, "state", "was lost and came back", now.recovered - before.recovered);
    }
    if (now.missed_answers > before.missed_answers) {
      const std::uint64_t missed = now.missed_answers - before.missed_answers;
      tell(who, "answers", fmt::format("left SYNCs unanswered: {}", missed));
    }
    if (now.emergency_count > before.emergency_count && !now.emergencies.empty()) {
      const NodeReport::Emergency& latest = now.emergencies.front();
      tell(who, "EMCY",
           fmt::format("EMCY {:04X}h ({}), error register {:02X}h", latest.code, latest.text, latest.error_register),
           now.emergency_count - before.emergency_count);
    }
    if (now.abort_count > before.abort_count && !now.aborts.empty()) {
      const NodeReport::Abort& latest = now.aborts.front();
      tell(who, "SDO", fmt::format("refused {}: {} ({:08X}h)", to_string(latest.object), latest.text, latest.code),
           now.abort_count - before.abort_count);
    }
  }

  void tell(const std::string& who, const char* kind, const std::string& what, std::uint64_t times = 1) {
    changes_.push_back({fmt::format("{} {}", who, kind), fmt::format("{}: {}", who, what), times});
  }

  std::vector<BusChange> changes_;
};

}  // namespace

std::vector<BusChange> changes_between(const fieldbus::FieldbusReport& before, const fieldbus::FieldbusReport& now) {
  Comparison comparison;
  for (const BusReport& bus : now.can) {
    const BusReport* const known = same_of(before.can, bus, &BusReport::interface);
    if (known != nullptr && known->cycles <= bus.cycles) comparison.compare(*known, bus);
  }
  for (const LineReport& line : now.modbus) {
    const LineReport* const known = same_of(before.modbus, line, &LineReport::endpoint);
    if (known != nullptr && known->rounds <= line.rounds) comparison.compare(*known, line);
  }
  return comparison.take();
}

}  // namespace rmac::gateway
