#include "gateway/buses/report/bus_watch.hpp"

#include <fmt/format.h>

#include <utility>

namespace rmac::gateway {
namespace {

std::string with_count(const std::string& message, std::uint64_t others) {
  return others == 0 ? message : fmt::format("{}; {} more before it", message, others);
}

nlohmann::json summary_of(const fieldbus::FieldbusReport& report) {
  nlohmann::json buses = nlohmann::json::array();
  for (const fieldbus::BusReport& bus : report.can) {
    nlohmann::json bad = nlohmann::json::array();
    for (const fieldbus::NodeReport& node : bus.nodes) {
      if (node.problem || node.state != "operational") bad.push_back(node.node);
    }
    buses.push_back(
        {{"name", bus.interface}, {"controller", to_string(bus.controller.state)}, {"nodes_bad", std::move(bad)}});
  }
  for (const fieldbus::modbus::LineReport& line : report.modbus) {
    nlohmann::json bad = nlohmann::json::array();
    for (const fieldbus::modbus::UnitReport& unit : line.units) {
      if (unit.state != "answers") bad.push_back(unit.unit);
    }
    buses.push_back({{"name", line.endpoint}, {"controller", nullptr}, {"nodes_bad", std::move(bad)}});
  }
  return buses;
}

}  // namespace

std::vector<std::string> BusWatch::look(fieldbus::FieldbusReport report, double now_s) {
  std::vector<std::string> out;
  if (last_) {
    for (const BusChange& change : changes_between(*last_, report)) consider(change, now_s, out);
  }
  // What was kept back is told once its time is over, whether more comes or not: it may be that a node came back.
  for (auto entry = told_.begin(); entry != told_.end();) {
    Told& told = entry->second;
    if (now_s < told.at_s + kBetweenMessages_s) {
      ++entry;
    } else if (told.kept_back == 0) {
      entry = told_.erase(entry);
    } else {
      out.push_back(with_count(told.latest, told.kept_back - 1));
      told = {now_s, 0, {}};
      ++entry;
    }
  }
  summary_ = summary_of(report);
  last_ = std::move(report);
  looked_s_ = now_s;
  return out;
}

void BusWatch::consider(const BusChange& change, double now_s, std::vector<std::string>& out) {
  const auto [entry, is_new] = told_.try_emplace(change.about);
  Told& told = entry->second;
  if (is_new) {
    out.push_back(with_count(change.message, change.times - 1));
    told.at_s = now_s;
    return;
  }
  told.kept_back += change.times;
  told.latest = change.message;
}

void BusWatch::forget() {
  last_.reset();
  told_.clear();
  summary_ = nlohmann::json::array();
}

}  // namespace rmac::gateway
