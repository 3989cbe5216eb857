// Requests to a machine. The first byte says what it does when they come: it stands, or it moves, or it was stopped in
// its move.
#include <cstdlib>
#include <iostream>

#include "gateway/simulation/simulation.hpp"
#include "memory_file.hpp"
#include "places.hpp"
#include "requests.hpp"

namespace {

using namespace rmac::gateway;

constexpr int kMostCycles = 50, kInputsOfAMachine = 200;

std::unique_ptr<Simulation> machine() {
  auto made = Simulation::open({.device_tree = RMAC_BINARY_DIR "/drivers"}, "DMACXYZ");
  if (!made) {
    std::cerr << made.error().message << '\n';
    std::abort();
  }
  return std::move(*made);
}

/// MoveAlongLine from the mill's zero along X.
nlohmann::json line_to(double x) {
  const auto pose = [](double at) { return nlohmann::json{{"p", {at, 0, 0}}, {"axis", {0, 0, 1}}}; };
  return {{"MoveID", 1}, {"StartPoint", pose(0)}, {"EndPoint", pose(x)}};
}

void pass(Simulation& simulation, int cycles) {
  for (int i = 0; i < cycles; ++i) simulation.cycle();
}

/// The mill at rest, with nothing queued, wherever the input before left it.
void begin(Simulation& simulation, unsigned state) {
  static_cast<void>(simulation.call("RMAC_CAM.StopNow", {}));
  for (int i = 0; i < 100 && simulation.controller().sample().moving; ++i) pass(simulation, kMostCycles);
  static_cast<void>(simulation.call("RMAC_CAM.Reset", {}));
  const auto name = simulation.call("Device.Machine_GetMechanismName", {});
  if (!name || *name != "DMACXYZ") static_cast<void>(simulation.call("Device.Load", {{"Name", "DMACXYZ"}}));
  static_cast<void>(simulation.call("RMAC_CAM.SetFeedrate", {{"Feedrate", 600}}));
  if (state == 0) return;
  static_cast<void>(simulation.call("RMAC_CAM.MoveAlongLine", line_to(20)));
  static_cast<void>(simulation.call("RMAC_CAM.CycleStart", {{"Mode", "AUTOMATIC"}}));
  pass(simulation, kMostCycles);
  if (state == 2) static_cast<void>(simulation.call("RMAC_CAM.StopNow", {}));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::unique_ptr<Simulation> simulation;
  static int inputs = 0;
  if (size == 0) return 0;
  // What one input leaves behind another one finds, but not for ever: a machine is made anew now and then, not for
  // each, which takes a hundred times as long.
  if (inputs++ % kInputsOfAMachine == 0) simulation.reset();
  if (!simulation) simulation = machine();
  begin(*simulation, data[0] % 3);
  const rmac::fuzz::Requests requests(rmac::fuzz::text_of(data + 1, size - 1), kMostCycles);
  requests.for_each([](const std::string& method,
                       const nlohmann::json& params) { static_cast<void>(simulation->call(method, params)); },
                    [](int cycles) { pass(*simulation, cycles); });
  return 0;
}
