// What the fieldbuses went through.
#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"

namespace rmac::gateway {
namespace {

using fieldbus::BusReport;
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

nlohmann::json to_json(const BusReport& bus) {
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

}  // namespace

void add_bus_methods(std::vector<Method>& table) {
  table.push_back(
      method("Bus.GetState",
             "What the CANopen buses that run went through since they were started, as `buses`; of each `interface`, "
             "its counts, whether it is `bus_off` or `link_down`, its `controller` with `state` and error counters "
             "(null: the "
             "interface has none, or does not tell), and its `nodes` with `state`, `problem` (null: "
             "none), how often they were `lost` and `recovered`, `missed_answers`, jitter, and the latest "
             "`emergencies` and `aborts`, newest first.")
          .gives(WireType::Object)
          .extension()
          .does([](Call& call) {
            nlohmann::json buses = nlohmann::json::array();
            for (const BusReport& bus : call.machine.bus_reports()) buses.push_back(to_json(bus));
            return nlohmann::json{{"buses", std::move(buses)}};
          }));
}

}  // namespace rmac::gateway
