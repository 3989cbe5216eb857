// What the fieldbuses went through.
#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"
#include "gateway/buses/report/bus_report_json.hpp"

namespace rmac::gateway {

void add_bus_methods(std::vector<Method>& table) {
  table.push_back(
      method("Bus.GetState",
             "What the buses that run went through since they were started. `buses`: of each CANopen `interface`, its "
             "counts, whether it is `bus_off` or `link_down`, its `controller` with `state` and error counters (null: "
             "it has none, or does not tell), and its `nodes` with `state`, `problem` (null: none), how often they "
             "were `lost` and `recovered`, `missed_answers`, jitter, and the latest `emergencies` and `aborts`, newest "
             "first. `lines`: of each Modbus `endpoint`, its `units` with `state`, requests and what came of them, "
             "`exceptions` by code, and the `last_trouble` (null: none).")
          .gives(WireType::Object)
          .extension()
          .does([](Call& call) { return to_json(call.machine.bus_reports()); }));
}

}  // namespace rmac::gateway
