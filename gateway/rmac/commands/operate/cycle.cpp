#include "gateway/rmac/commands/operate/registrations.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

void add_hold(Command& rmac) {
  Command hold = rmac.add("hold", "feed hold: stop on the path, keep the program");
  hold.does(with_appliance([](Connection& appliance, bool) { return appliance.command("RMAC_CAM.FeedHold"); }));
}

void add_resume(Command& rmac) {
  Command resume = rmac.add("resume", "go on after a hold");
  resume.does(
      with_appliance([](Connection& appliance, bool) { return command_beside_program(appliance, kResumeFeed); }));
}

void add_stop(Command& rmac) {
  Command stop = rmac.add("stop", "stop now and empty the queue");
  stop.does(with_appliance([](Connection& appliance, bool) { return stop_now(appliance); }));
}

void add_reset(Command& rmac) {
  Command reset = rmac.add("reset", "leave a fault or an emergency stop whose cause is gone; nothing moves by it");
  reset.does(
      with_appliance([](Connection& appliance, bool) { return command_with_authority(appliance, "RMAC_CAM.Reset"); }));
}

void add_override(Command& rmac) {
  const auto percent = std::make_shared<double>(100);
  Command scaled = rmac.add("override", "scale the feed");
  scaled.option("PERCENT", percent.get(), "0 to 200").required().within(0.0, 200.0);
  scaled.does(with_appliance([percent](Connection& appliance, bool) {
    return command_beside_program(appliance, "RMAC_CAM.SetFeedOverride", {{"Percent", *percent}});
  }));
}

}  // namespace rmac::cli
