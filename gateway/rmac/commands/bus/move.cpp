#include <fmt/format.h>

#include <map>
#include <thread>

#include "gateway/buses/drive_library_file.hpp"
#include "gateway/configuration/configuration.hpp"
#include "gateway/rmac/commands/bus/registrations.hpp"
#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/bus_scan.hpp"
#include "rmac/fieldbus/canopen/drive_trial.hpp"

namespace rmac::cli {
namespace {

namespace canopen = fieldbus::canopen;

/// Short enough for a smooth path, long enough for a process without privileges.
constexpr double kPeriod_s = 0.005;

const std::map<std::string, DriveMode>& modes() {
  static const std::map<std::string, DriveMode> kModes{
      {"pp", DriveMode::ProfilePosition},     {"pv", DriveMode::ProfileVelocity},
      {"pt", DriveMode::ProfileTorque},       {"ip", DriveMode::InterpolatedPosition},
      {"csp", DriveMode::CyclicSyncPosition}, {"csv", DriveMode::CyclicSyncVelocity},
      {"cst", DriveMode::CyclicSyncTorque}};
  return kModes;
}

std::vector<std::string> trial_modes() {
  std::vector<std::string> names;
  for (const auto& [name, mode] : modes()) names.push_back(name);
  return names;
}

/// A first motion of one drive by itself.
struct DriveMove {
  std::string interface, mode, setup;
  std::filesystem::path drives;  ///< those that are known; empty: the installation's
  int node = 0;
  std::int32_t amount = 0;
  double seconds = 1;
  std::int64_t within = 0, tolerance = 0;
};

Result<canopen::CanopenConfig> config_of(const DriveMove& move) {
  std::map<std::string, std::string> texts{{"tpdo", "6041:00/16 6064:00/32"}};
  if (!move.setup.empty()) texts["setup"] = move.setup;
  auto drives = std::make_shared<canopen::DriveLibrary>(
      gateway::read_drive_library(move.drives.empty() ? gateway::default_folders().drives : move.drives));
  auto config = canopen::read_canopen_config(
      move.interface,
      {{"node", {static_cast<double>(move.node)}}, {"mode", {static_cast<double>(modes().at(move.mode))}}}, texts,
      kPeriod_s, {}, std::move(drives));
  if (!config) return fail(config.error().message);
  return std::move(*config);
}

/// Refuses a bus on which a machine runs.
Result<> check_idle(const std::string& interface) {
  constexpr std::size_t kBurst = 4;
  auto port = fieldbus::SocketCanPort::open(interface, {}, kBurst);
  if (!port) return fail(port.error().message);
  const auto idle = canopen::check_idle(**port, canopen::ScanOptions().listen);
  return idle ? Result<>() : fail(fmt::format("{}: {}", interface, idle.error().message));
}

Result<> move_drive(const DriveMove& move) {
  const auto config = config_of(move);
  if (!config) return tl::unexpected(config.error());
  if (auto idle = check_idle(move.interface); !idle) return idle;
  const auto bus = canopen::make_socketcan_interface(*config);
  if (auto started = bus->start(); !started)
    return fail(fmt::format("{}: {}", move.interface, started.error().message));
  for (const std::string& note : bus->start_notes()) fmt::print("{}: {}\n", move.interface, note);
  const auto period = std::chrono::duration_cast<std::chrono::steady_clock::duration>(config->period);
  auto next = std::chrono::steady_clock::now();
  const auto pass = [&] { std::this_thread::sleep_until(next += period); };
  const auto done = canopen::try_drive(*bus, *config,
                                       {.mode = modes().at(move.mode),
                                        .amount = move.amount,
                                        .seconds = move.seconds,
                                        .most_counts = move.within,
                                        .tolerance_counts = move.tolerance},
                                       pass);
  bus->stop();
  if (!done) return fail(fmt::format("node {}: {}", move.node, done.error().message));
  fmt::print("node {} went from {} to {} counts, {} at the farthest, in {:.3g} s\n", move.node, done->from_counts,
             done->to_counts, done->farthest_counts, done->seconds);
  return {};
}

}  // namespace

void add_bus_move(Command& bus) {
  const auto options = std::make_shared<DriveMove>();
  Command move = bus.add(
      "move", "move one drive by itself, with the motor off the machine; refuses a bus on which a machine runs");
  move.option("INTERFACE", &options->interface, kInterfaceMeaning).required();
  move.option("NODE", &options->node, "the drive's node id").required().within(1, 126);
  move.option("--mode", &options->mode, "profile or cyclic synchronous position, velocity or torque, or ip")
      .required()
      .one_of(trial_modes());
  move.option("--amount", &options->amount,
              "the way in counts; velocity in the drive's units; torque in per mille of the rated one")
      .required();
  move.option("--within", &options->within, "counts from where it stands; beyond them it is stopped")
      .required()
      .within(std::int64_t{1}, std::int64_t{2147483647});
  move.option(
          "--tolerance", &options->tolerance,
          "counts off the place asked for at which it still is reached; by default a hundredth of the way, at least 10")
      .within(std::int64_t{1}, std::int64_t{2147483647});
  move.option("--seconds", &options->seconds, "how long the way, the velocity or the torque lasts")
      .within(0.01, 600.0)
      .shows_default();
  move.option("--setup", &options->setup, "objects to write first, as in device.json: \"6081:00/32=20000\"");
  move.option("--drives", &options->drives, kDrivesMeaning).existing_folder();
  move.does(without_appliance([options](bool) { return move_drive(*options); }));
}

}  // namespace rmac::cli
