#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/rmac/commands/bus/machine_bus.hpp"
#include "gateway/rmac/commands/bus/registrations.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "rmac/fieldbus/canopen/bus_load.hpp"

namespace rmac::cli {
namespace {

using fieldbus::canopen::BusLoad;
using fieldbus::canopen::CanopenConfig;

nlohmann::json load_json(const CanopenConfig& config, const BusLoad& load) {
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

std::vector<std::string> load_row(const CanopenConfig& config, const BusLoad& load) {
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

/// Works out the load of a machine's CAN buses; fails where one exceeds its share.
Result<> show_bus_load(const MachineChoice& choice, bool json) {
  const auto buses = canopen_buses(choice);
  if (!buses) return tl::unexpected(buses.error());
  nlohmann::json list = nlohmann::json::array();
  std::vector<std::vector<std::string>> rows;
  std::string refusal;  // of the first bus that carries too much
  for (const CanopenConfig& config : *buses) {
    const BusLoad load = bus_load(config);
    list.push_back(load_json(config, load));
    rows.push_back(load_row(config, load));
    if (const auto fits = check_bus_load(config); !fits && refusal.empty()) refusal = fits.error().message;
  }
  if (json) {
    fmt::print("{}\n", list.dump());
  } else {
    fmt::print("{}", table({"bus", "axes", "cycle ms", "SYNC", "setpoints", "answers", "bits", "of", "load %",
                            "share %", "heartbeats %"},
                           rows));
  }
  return refusal.empty() ? Result<>() : fail(refusal);
}

}  // namespace

void add_bus_load(Command& bus) {
  const auto options = std::make_shared<MachineChoice>();
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
