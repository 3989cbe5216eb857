#include "gateway/buses/report/bus_report_json.hpp"

#include <string>

namespace rmac::gateway {
namespace {

using fieldbus::NodeReport;

nlohmann::json to_json(const NodeReport& node) {
  nlohmann::json emergencies = nlohmann::json::array(), aborts = nlohmann::json::array();
  for (const NodeReport::Emergency& each : node.emergencies) {
    emergencies.push_back(
        {{"code", each.code}, {"text", each.text}, {"error_register", each.error_register}, {"age_s", each.age_s}});
  }
  for (const NodeReport::Abort& each : node.aborts) {
    aborts.push_back(
        {{"index", each.object.index}, {"sub", each.object.sub}, {"code", each.code}, {"text", each.text}});
  }
  return {{"node", node.node},
          {"axes", node.axes},
          {"state", node.state},
          {"problem", node.problem ? nlohmann::json(*node.problem) : nlohmann::json()},
          {"lost", node.lost},
          {"recovered", node.recovered},
          {"missed_answers", node.missed_answers},
          {"answers", node.answers},
          {"jitter_mean_s", node.jitter_mean_s},
          {"jitter_most_s", node.jitter_most_s},
          {"emergency_count", node.emergency_count},
          {"emergencies", std::move(emergencies)},
          {"abort_count", node.abort_count},
          {"aborts", std::move(aborts)}};
}

nlohmann::json to_json(const fieldbus::CanController& controller) {
  nlohmann::json told{
      {"state", to_string(controller.state)}, {"transmit_errors", nullptr}, {"receive_errors", nullptr}};
  if (controller.errors) {
    told["transmit_errors"] = controller.errors->transmit;
    told["receive_errors"] = controller.errors->receive;
  }
  return told;
}

nlohmann::json to_json(const fieldbus::BusReport& bus) {
  nlohmann::json nodes = nlohmann::json::array();
  for (const NodeReport& node : bus.nodes) nodes.push_back(to_json(node));
  return {{"interface", bus.interface},
          {"cycles", bus.cycles},
          {"unsent", bus.unsent},
          {"short_answers", bus.short_answers},
          {"sent", bus.health.sent},
          {"received", bus.health.received},
          {"queue_full", bus.health.queue_full},
          {"send_failures", bus.health.send_failures},
          {"overflowed", bus.health.overflowed},
          {"error_frames", bus.health.error_frames},
          {"warnings", bus.health.warnings},
          {"passives", bus.health.passives},
          {"bus_offs", bus.health.bus_offs},
          {"bus_off", bus.health.bus_off},
          {"link_down", bus.health.link_down},
          {"controller", to_json(bus.controller)},
          {"nodes", std::move(nodes)}};
}

nlohmann::json to_json(const fieldbus::modbus::UnitReport& unit) {
  const fieldbus::modbus::UnitTraffic& traffic = unit.traffic;
  nlohmann::json exceptions = nlohmann::json::array();
  for (const auto& [code, count] : traffic.exceptions) exceptions.push_back({{"code", code}, {"count", count}});
  nlohmann::json last;
  if (traffic.last_trouble) {
    last = {{"message", traffic.last_trouble->message}, {"age_s", traffic.last_trouble->age_s}};
  }
  return {{"unit", unit.unit},
          {"state", unit.state},
          {"requests", traffic.requests},
          {"answers", traffic.answers},
          {"timeouts", traffic.timeouts},
          {"wrong_answers", traffic.wrong_answers},
          {"disconnects", traffic.disconnects},
          {"exceptions", std::move(exceptions)},
          {"last_trouble", std::move(last)}};
}

nlohmann::json to_json(const fieldbus::modbus::LineReport& line) {
  nlohmann::json units = nlohmann::json::array();
  for (const auto& unit : line.units) units.push_back(to_json(unit));
  return {{"endpoint", line.endpoint},
          {"rounds", line.rounds},
          {"connections", line.connections},
          {"units", std::move(units)}};
}

template <typename Reports>
nlohmann::json list_of(const Reports& reports) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& each : reports) list.push_back(to_json(each));
  return list;
}

}  // namespace

nlohmann::json to_json(const fieldbus::FieldbusReport& report) {
  return {{"buses", list_of(report.can)}, {"lines", list_of(report.modbus)}};
}

}  // namespace rmac::gateway
