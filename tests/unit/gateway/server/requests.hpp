#pragma once

#include <future>
#include <memory>
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

/// From now on every move finds the queue full; the future tells when one was tried.
inline std::future<void> keep_queue_full(ServerBench& bench) {
  const auto tried = std::make_shared<std::promise<void>>();
  bench.on_gateway([&tried](Server&, FakeMachine& machine) {
    const auto full = failure(MinorCode::CommandQueueFull, "full");
    EXPECT_CALL(machine.cam_mock.queue_mock, add(testing::_, testing::_))
        .WillOnce([tried, full](std::int64_t, const Geometry&) -> Expected<> {
          tried->set_value();
          return full;
        })
        .WillRepeatedly(testing::Return(full));
  });
  return tried->get_future();
}

inline void set_running(ServerBench& bench) {
  bench.on_gateway([](Server&, FakeMachine& machine) {
    machine.now.state = CycleState::Running;
    machine.now.moving = true;
  });
}

}  // namespace rmac::gateway::fakes
