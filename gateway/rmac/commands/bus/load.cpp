#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/buses/bus_choice.hpp"
#include "gateway/buses/device_descriptions.hpp"
#include "gateway/buses/drive_library_file.hpp"
#include "gateway/configuration/configuration.hpp"
#include "gateway/device_database/device_database.hpp"
#include "gateway/device_driver_manager/device_tree.hpp"
#include "gateway/rmac/commands/bus/registrations.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "rmac/fieldbus/canopen/bus_load.hpp"
#include "rmac/sdk/buses_of.hpp"

namespace rmac::cli {
namespace {

using fieldbus::canopen::BusLoad;
using fieldbus::canopen::CanopenConfig;

nlohmann::json to_json(const CanopenConfig& config, const BusLoad& load) {
  return {{"bus", config.interface},
          {"axes", config.axes.size()},
          {"period_s", std::chrono::duration<double>(config.period).count()},
          {"bit_rate", config.bit_rate},
          {"sync_bits", load.sync_bits},
          {"setpoint_bits", load.setpoint_bits},
          {"answer_bits", load.answer_bits},
          {"cyclic_bits", load.cyclic_bits()},
          {"cycle_bits", load.bits_of_cycle},
          {"load", load.load()},
          {"share", load.share},
          {"heartbeat_bits_per_s", load.heartbeat_bits_per_s},
          {"fits", load.fits()}};
}

std::vector<std::string> to_row(const CanopenConfig& config, const BusLoad& load) {
  const double heartbeat_percent = load.heartbeat_bits_per_s / config.bit_rate * 100;
  return {config.interface,
          std::to_string(config.axes.size()),
          number(std::chrono::duration<double, std::milli>(config.period).count()),
          std::to_string(load.sync_bits),
          std::to_string(load.setpoint_bits),
          std::to_string(load.answer_bits),
          std::to_string(load.cyclic_bits()),
          number(load.bits_of_cycle, 0),
          number(load.load() * 100, 1),
          number(load.share * 100, 1),
          number(heartbeat_percent, 2)};
}

struct Options {
  std::string machine;                ///< its name, or the path of its folder or of its device.json
  std::filesystem::path device_tree;  ///< empty: the installation's
  std::filesystem::path drives;       ///< those that are known; empty: the installation's
  double period_s = 0.001;
};

/// What there is to tell of the buses of a machine.
struct Loads {
  nlohmann::json list = nlohmann::json::array();
  std::vector<std::vector<std::string>> rows;
  std::string refusal;  ///< of the first bus that carries too much; empty: none
};

Result<Loads> loads_of(const sdk::DeviceObject& device, const std::filesystem::path& file, const Options& options) {
  const gateway::ModuleLoader loader({file.parent_path(), options.device_tree / "modules"});
  const auto drives = std::make_shared<fieldbus::canopen::DriveLibrary>(gateway::read_drive_library(options.drives));
  Loads loads;
  for (const std::string& bus : sdk::buses_of(device)) {
    const sdk::ModuleChoice choice = gateway::interface_of_bus(bus, device.digital_control_interface);
    if (choice.name != "CANopenInterface") continue;
    const auto config = fieldbus::canopen::read_canopen_config(bus, choice.numbers, choice.texts, options.period_s,
                                                               gateway::find_descriptions(loader), drives);
    if (!config) return fail(fmt::format("{}: {}", file.string(), config.error().message));
    const BusLoad load = bus_load(*config);
    loads.list.push_back(to_json(*config, load));
    loads.rows.push_back(to_row(*config, load));
    if (const auto fits = check_bus_load(*config); !fits && loads.refusal.empty()) loads.refusal = fits.error().message;
  }
  return loads;
}

/// Works out the load of a machine's CAN buses; fails where one exceeds its share.
Result<> show_bus_load(Options options, bool json) {
  if (options.device_tree.empty()) options.device_tree = gateway::default_folders().device_tree;
  if (options.drives.empty()) options.drives = gateway::default_folders().drives;
  const auto file = gateway::find_device_json(options.machine, options.device_tree);
  if (!file) return fail(file.error().message);
  const auto device = gateway::read_device_database(*file);
  if (!device) return fail(device.error().message);
  const auto loads = loads_of(*device, *file, options);
  if (!loads) return tl::unexpected(loads.error());
  if (loads->rows.empty()) {
    return fail(fmt::format("{}: its drives are reached by {}, which is no CAN bus", file->string(),
                            device->digital_control_interface.name));
  }
  if (json) {
    fmt::print("{}\n", loads->list.dump());
  } else {
    fmt::print("{}", table({"bus", "axes", "cycle ms", "SYNC", "setpoints", "answers", "bits", "of", "load %",
                            "share %", "heartbeats %"},
                           loads->rows));
  }
  return loads->refusal.empty() ? Result<>() : fail(loads->refusal);
}

}  // namespace

void add_bus_load(Command& bus) {
  const auto options = std::make_shared<Options>();
  Command load = bus.add("load", "the bits that a machine's CAN buses carry at worst; exit code 1 if too many");
  load.option("NAME", &options->machine, "a machine's name; or the path of its folder or its device.json").required();
  load.option("--device-tree", &options->device_tree, "where machines are looked for; the installation's unless given");
  load.option("--drives", &options->drives, kDrivesMeaning).existing_folder();
  load.option("--period", &options->period_s, "cycle of the servo loop, s (period_s in rmacd.json)")
      .within(0.0001, 0.1)
      .shows_default();
  load.does(without_appliance([options](bool json) { return show_bus_load(*options, json); }));
}

}  // namespace rmac::cli
