#include <fmt/format.h>

#include <cstdio>

#include "gateway/api/rpc_error.hpp"
#include "gateway/rmac/commands/operate/registrations.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {

/// At once, whoever is the operator; then once more as the operator, if nobody else is, so that no program resumes.
Result<> hold_feed(Connection& appliance) {
  if (auto held = appliance.command(kHoldFeed); !held) return held;
  auto kept = command_as_operator(appliance, kHoldFeed);
  if (kept || kept.error().rpc_code != gateway::rpc_code::kOperatorThere) return kept;
  fmt::print(stderr, "rmac: held, as anyone may; {}\n", kept.error().message);
  return {};
}

}  // namespace

void add_hold(Command& rmac) {
  Command hold = rmac.add("hold", "feed hold: stop on the path, keep the program; nothing starts before rmac resume");
  hold.does(with_appliance([](Connection& appliance, bool) { return hold_feed(appliance); }));
}

void add_resume(Command& rmac) {
  Command resume = rmac.add("resume", "go on after a hold");
  resume.does(with_appliance([](Connection& appliance, bool) { return command_as_operator(appliance, kResumeFeed); }));
}

void add_stop(Command& rmac) {
  Command stop = rmac.add("stop", "stop now and empty the queue");
  stop.does(with_appliance([](Connection& appliance, bool) { return stop_now(appliance); }));
}

void add_reset(Command& rmac) {
  Command reset = rmac.add("reset",
                           "leave a fault or an emergency stop whose cause is gone, take over what an operator who "
                           "left holds, clear the last error; nothing moves by it");
  reset.does(
      with_appliance([](Connection& appliance, bool) { return command_with_authority(appliance, "RMAC_CAM.Reset"); }));
}

void add_override(Command& rmac) {
  const auto percent = std::make_shared<double>(100);
  Command scaled = rmac.add("override", "scale the feed");
  scaled.option("PERCENT", percent.get(), "0 to 200").required().within(0.0, 200.0);
  scaled.does(with_appliance([percent](Connection& appliance, bool) {
    return command_as_operator(appliance, kSetOverride, {{"Percent", *percent}});
  }));
}

}  // namespace rmac::cli
