#include "rmac/fieldbus/canopen/bus_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "rmac/fieldbus/can/can_load.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"

namespace rmac::fieldbus::canopen {

BusLoad bus_load(const CanopenConfig& config) noexcept {
  const double period_s = std::chrono::duration<double>(config.period).count();
  BusLoad load;
  load.sync_bits = worst_frame_bits(kSyncId, 0);
  std::set<std::uint8_t> nodes;
  std::set<std::uint16_t> setpoints;
  for (const AxisConfig& axis : config.axes) {
    if (setpoints.insert(setpoint_id(axis)).second) {
      load.setpoint_bits += worst_frame_bits(setpoint_id(axis), mapped_bytes(axis.setpoints));
    }
    if (!axis.more_setpoints.empty()) {
      load.setpoint_bits += worst_frame_bits(more_setpoints_id(axis), mapped_bytes(axis.more_setpoints));
    }
    load.answer_bits += worst_frame_bits(answer_id(axis), mapped_bytes(axis.answers));
    if (!axis.more_answers.empty()) {
      load.answer_bits += worst_frame_bits(more_answers_id(axis), mapped_bytes(axis.more_answers));
    }
    nodes.insert(axis.node);
  }
  const double heartbeats_per_s = 1 / std::chrono::duration<double>(config.heartbeat).count();
  load.heartbeat_bits_per_s = static_cast<double>(nodes.size() + 1) * heartbeats_per_s * worst_frame_bits(1);
  constexpr std::size_t kTimeBytes = 6;
  const double time_s = std::chrono::duration<double>(config.time_interval).count();
  if (time_s > 0) load.heartbeat_bits_per_s += worst_frame_bits(kTimeBytes) / time_s;
  load.bits_of_cycle = config.bit_rate * period_s;
  load.share = config.load_share;
  return load;
}

Expected<> check_bus_load(const CanopenConfig& config) {
  const BusLoad load = bus_load(config);
  if (load.fits()) return {};
  const double period_s = std::chrono::duration<double>(config.period).count();
  return failure(
      MinorCode::InvalidParameterValue,
      fmt::format("bus {}: {} axes in a cycle of {:g} ms need {} bits, {:.1f} % of the {:.0f} that {} bit/s give; its "
                  "share is {:g} %. Take a cycle of {:.3g} ms or more, spread the axes over several buses, or map less",
                  config.interface, config.axes.size(), period_s * 1e3, load.cyclic_bits(), load.load() * 100,
                  load.bits_of_cycle, config.bit_rate, load.share * 100,
                  load.cyclic_bits() / (load.share * config.bit_rate) * 1e3));
}

std::size_t frames_of_cycle(const CanopenConfig& config) noexcept {
  constexpr std::size_t kSyncHeartbeatTimeAndBoot = 4;
  const auto second = std::count_if(config.axes.begin(), config.axes.end(),
                                    [](const AxisConfig& axis) { return !axis.more_setpoints.empty(); });
  const bool guards = config.drives && std::any_of(config.drives->drives.begin(), config.drives->drives.end(),
                                                   [](const auto& drive) { return drive.manners.node_guarding; });
  return config.axes.size() * (guards ? 2 : 1) + static_cast<std::size_t>(second) + kSyncHeartbeatTimeAndBoot;
}

}  // namespace rmac::fieldbus::canopen
