#include "gateway/rmac/wire/requests.hpp"

#include "gateway/api/enumeration.hpp"

namespace rmac::cli {

const char* name_of(sdk::CycleMode mode) {
  return gateway::kCycleModeValues.find(static_cast<std::int64_t>(mode))->name;
}

Result<> subscribe(Connection& connection, const char* topic, std::optional<double> rate_hz) {
  nlohmann::json params{{"topics", {topic}}};
  if (rate_hz) params["rate_hz"] = *rate_hz;
  return connection.command("subscribe", params);
}

Result<StateNote> ask_state(Connection& connection) {
  return connection.call("RMAC_CAM.GetState").map(read_state);
}

Result<> start_cycle(Connection& connection) {
  return connection.command(kStartCycle, {{"Mode", name_of(sdk::CycleMode::Automatic)}});
}

Result<> stop_now(Connection& connection) {
  return connection.command("RMAC_CAM.StopNow");
}

Result<> load_machine(Connection& connection, const std::string& name, bool virtual_mode, double soften) {
  nlohmann::json params{{"Name", name}, {"Virtual", virtual_mode}};
  if (soften != 1) params["Soften"] = soften;  // an appliance of an earlier version does not know it
  return connection.command(kLoadMachine, params);
}

Result<std::string> loaded_machine(Connection& connection) {
  return connection.call("Device.Machine_GetMechanismName").map([](const nlohmann::json& name) {
    return name.get<std::string>();
  });
}

}  // namespace rmac::cli
