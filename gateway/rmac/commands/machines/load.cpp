#include <fmt/format.h>

#include "gateway/rmac/commands/machines/registrations.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {

struct LoadOptions {
  std::string name;
  bool virtual_mode = false;
  double soften = 1;
};

Result<> load_softly(Connection& appliance, const LoadOptions& options, bool json) {
  return load_machine(appliance, options.name, options.virtual_mode, options.soften).map([&] {
    if (json || options.soften == 1) return;
    fmt::print("its PIDs are softer by {:g}, and their joints speed up at a quarter, until it is loaded again\n",
               options.soften);
  });
}

}  // namespace

void add_load(Command& rmac) {
  const auto options = std::make_shared<LoadOptions>();
  Command load = rmac.add("load", "make a machine's driver configure the controller");
  load.option("NAME", &options->name, "as `rmac machines` lists it").required();
  load.flag("--virtual", &options->virtual_mode, "setpoints come back as joint values, drives stay untouched");
  load.option("--soften", &options->soften,
              "for commissioning, where its gains swing or were made for another mass: divide Kp and Kd of its PIDs by "
              "this, and Ki by its square; 8 does for most")
      .within(1.0, 100.0);
  load.does(with_appliance([options](Connection& appliance, bool json) {
    return with_authority(appliance, [&] { return load_softly(appliance, *options, json); });
  }));
}

void add_unload(Command& rmac) {
  Command unload = rmac.add("unload", "take the loaded machine out");
  unload.does(
      with_appliance([](Connection& appliance, bool) { return command_with_authority(appliance, "Device.Unload"); }));
}

}  // namespace rmac::cli
