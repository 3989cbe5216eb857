#include <fmt/format.h>

#include <map>
#include <thread>

#include "gateway/rmac/commands.hpp"
#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/bus_scan.hpp"
#include "rmac/fieldbus/canopen/drive_trial.hpp"

namespace rmac::cli {
namespace {

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

}  // namespace

std::vector<std::string> trial_modes() {
  std::vector<std::string> names;
  for (const auto& [name, mode] : modes()) names.push_back(name);
  return names;
}

Result<> move_drive(const DriveMove& move) {
  namespace canopen = fieldbus::canopen;
  const DriveMode mode = modes().at(move.mode);
  std::map<std::string, std::string> texts{{"tpdo", "6041:00/16 6064:00/32"}};
  if (!move.setup.empty()) texts["setup"] = move.setup;
  const auto config = canopen::read_canopen_config(
      move.interface, {{"node", {static_cast<double>(move.node)}}, {"mode", {static_cast<double>(mode)}}}, texts,
      kPeriod_s);
  if (!config) return fail(config.error().message);
  {
    constexpr std::size_t kBurst = 4;
    auto port = fieldbus::SocketCanPort::open(move.interface, {}, kBurst);
    if (!port) return fail(port.error().message);
    const auto idle = canopen::check_idle(**port, canopen::ScanOptions().listen);
    if (!idle) return fail(fmt::format("{}: {}", move.interface, idle.error().message));
  }
  const auto bus = canopen::make_socketcan_interface(*config);
  if (auto started = bus->start(); !started)
    return fail(fmt::format("{}: {}", move.interface, started.error().message));
  const auto period = std::chrono::duration_cast<std::chrono::steady_clock::duration>(config->period);
  auto next = std::chrono::steady_clock::now();
  const auto pass = [&] { std::this_thread::sleep_until(next += period); };
  const auto done = canopen::try_drive(
      *bus, *config, {.mode = mode, .amount = move.amount, .seconds = move.seconds, .most_counts = move.within}, pass);
  bus->stop();
  if (!done) return fail(fmt::format("node {}: {}", move.node, done.error().message));
  fmt::print("node {} went from {} to {} counts, {} at the farthest, in {:.3g} s\n", move.node, done->from_counts,
             done->to_counts, done->farthest_counts, done->seconds);
  return {};
}

}  // namespace rmac::cli
