#include "gateway/rmac/commands/machines/registrations.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {

struct Options {
  std::string name;
  bool virtual_mode = false;
};

}  // namespace

void add_load(Command& rmac) {
  const auto options = std::make_shared<Options>();
  Command load = rmac.add("load", "make a machine's driver configure the controller");
  load.option("NAME", &options->name, "as `rmac machines` lists it").required();
  load.flag("--virtual", &options->virtual_mode, "setpoints come back as joint values, drives stay untouched");
  load.does(with_appliance([options](Connection& appliance, bool) {
    return with_authority(appliance, [&] { return load_machine(appliance, options->name, options->virtual_mode); });
  }));
}

void add_unload(Command& rmac) {
  Command unload = rmac.add("unload", "take the loaded machine out");
  unload.does(
      with_appliance([](Connection& appliance, bool) { return command_with_authority(appliance, "Device.Unload"); }));
}

}  // namespace rmac::cli
