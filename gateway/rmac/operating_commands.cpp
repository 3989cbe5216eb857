#include <fmt/format.h>

#include "gateway/rmac/authority.hpp"
#include "gateway/rmac/commands.hpp"
#include "gateway/rmac/notes.hpp"
#include "gateway/rmac/rest.hpp"

namespace rmac::cli {

namespace {

/// Well within the 200 ms for which the appliance lets a jog by velocity run.
constexpr std::chrono::milliseconds kJogAgain{80};

Result<> call(Connection& connection, const std::string& method,
              const nlohmann::json& params = nlohmann::json::object()) {
  const auto answer = connection.call(method, params);
  return answer ? Result<>() : tl::unexpected(answer.error());
}

/// Starts a motion of its own and stays until it is over. Ctrl-C stops it.
Result<> move_and_wait(Connection& connection, const std::string& method, const nlohmann::json& params) {
  std::string fault;
  connection.on_notification([&](const std::string& topic, const nlohmann::json& note) {
    if (topic == "events") {
      if (auto event = read_event(note); event.kind == "Fault") {
        fault = event.message;
      }
    }
  });
  auto done = with_authority(connection, [&]() -> Result<> {
    if (auto topics = call(connection, "subscribe", {{"topics", {"events"}}}); !topics) {
      return topics;
    }
    if (auto begun = call(connection, method, params); !begun) {
      return begun;
    }
    const auto rest = wait_for_rest(connection, fault);
    if (!rest) {
      static_cast<void>(call(connection, "RMAC_CAM.StopNow"));
      return tl::unexpected(rest.error());
    }
    return rest->faulted() ? fail("the machine is in a fault; `rmac status` says which") : Result<>();
  });
  connection.on_notification({});
  return done;
}

/// For what an operator changes beside a running program: with the lease only where nobody holds it, because taking it
/// and giving it back must not disturb the program's client.
Result<> call_with_or_without_authority(Connection& connection, const std::string& method,
                                        const nlohmann::json& params) {
  auto done = call(connection, method, params);
  if (done || done.error().rpc_code != kAuthorityRequired) {
    return done;
  }
  return with_authority(connection, [&] { return call(connection, method, params); });
}

}  // namespace

Result<> jog(Connection& connection, const JogRequest& request) {
  const char* method = request.joint ? "RMAC_CAM.JogJoint" : "RMAC_CAM.JogPath";
  nlohmann::json params;
  if (request.joint) {
    params["JntNum"] = *request.joint;
  } else {
    params["Direction"] = request.direction;
    params["InToolFrame"] = request.in_tool_frame;
  }
  if (request.distance) {
    params["Distance"] = *request.distance;
    return move_and_wait(connection, method, params);
  }
  params["Velocity"] = *request.velocity;
  return with_authority(connection, [&]() -> Result<> {
    // Sent again for as long as this program lives: should it die, or its network, the machine stops.
    for (;;) {
      if (auto sent = call(connection, method, params); !sent) return sent;
      if (auto waited = connection.wait([] { return false; }, kJogAgain); !waited) break;
    }
    params["Velocity"] = 0;
    if (auto ended = call(connection, method, params); !ended) return ended;
    const auto rest = wait_for_rest(connection, "");
    return rest ? Result<>() : tl::unexpected(rest.error());
  });
}

Result<> home(Connection& connection) {
  return move_and_wait(connection, "RMAC_CAM.Home", nlohmann::json::object());
}

Result<> hold(Connection& connection) {
  return call(connection, "RMAC_CAM.FeedHold");
}

Result<> resume(Connection& connection) {
  return call_with_or_without_authority(connection, "RMAC_CAM.FeedResume", nlohmann::json::object());
}

Result<> stop(Connection& connection) {
  return call(connection, "RMAC_CAM.StopNow");
}

Result<> reset(Connection& connection) {
  return with_authority(connection, [&] { return call(connection, "RMAC_CAM.Reset"); });
}

Result<> set_override(Connection& connection, double percent) {
  return call_with_or_without_authority(connection, "RMAC_CAM.SetFeedOverride", {{"Percent", percent}});
}

}  // namespace rmac::cli
