#pragma once

#include <string>

#include "bench.hpp"

namespace rmac::gateway::fakes {

/// The line of one request.
inline std::string line_of(int id, const std::string& method, const std::string& params = "[]") {
  return R"({"jsonrpc":"2.0","id":)" + std::to_string(id) + R"(,"method":")" + method + R"(","params":)" + params +
         "}\n";
}

inline std::string move_line(int id) {
  return line_of(id, "RMAC_CAM.MoveToPathTarget", R"({"MoveID":1,"TargetFrame":{"p":[0,0,0],"axis":[0,0,1]}})");
}

inline void set_running(ServerBench& bench) {
  bench.on_gateway([](Server&, FakeMachine& machine) {
    machine.now.state = CycleState::Running;
    machine.now.moving = true;
  });
}

}  // namespace rmac::gateway::fakes
