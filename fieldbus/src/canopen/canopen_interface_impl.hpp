#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "canopen/bus_axis.hpp"
#include "canopen/bus_node.hpp"
#include "canopen/bus_trouble.hpp"
#include "canopen/pdo.hpp"
#include "canopen/watch/bus_record.hpp"
#include "canopen/watch/other_master.hpp"
#include "rmac/fieldbus/canopen/canopen_interface.hpp"

namespace rmac::fieldbus::canopen {

/// The bus: what is done about it off the servo cycle stands in canopen_interface.cpp, its cycle in
/// canopen_interface_cycle.cpp.
struct CanopenInterface::Impl {
  Impl(CanopenConfig configuration, OpenPort opener) : config(std::move(configuration)), open(std::move(opener)) {
    for (const AxisConfig& axis : config.axes) {
      auto at = std::find_if(nodes.begin(), nodes.end(), [&](const BusNode& n) { return n.boot.node() == axis.node; });
      const auto place = static_cast<std::size_t>(at - nodes.begin());
      if (at == nodes.end()) nodes.emplace_back(config, axis);
      const auto same = [&](std::size_t other) { return setpoint_id(axes[other].config) == setpoint_id(axis); };
      if (std::none_of(rpdos.begin(), rpdos.end(), same)) rpdos.push_back(axes.size());
      axes.push_back(BusAxis::of(axis, place));
    }
  }

  [[nodiscard]] std::vector<std::uint16_t> wanted() const {
    std::vector<std::uint16_t> ids;
    for (const BusNode& node : nodes) {
      for (const std::uint16_t base : {kEmergencyId, kSdoAnswerId, kHeartbeatId}) {
        ids.push_back(static_cast<std::uint16_t>(base + node.boot.node()));
      }
    }
    for (const BusAxis& axis : axes) {
      for (const BusAxis::Answer& answer : axis.answers) ids.push_back(answer.id);
    }
    // From another master, unless SYNC is asked for.
    ids.insert(ids.end(), {kNmtId, kSyncId});
    return ids;
  }

  // Off the cycle
  [[nodiscard]] Expected<> boot_all();
  [[nodiscard]] std::string problems() const;
  /// Why a node is away, as far as it is known.
  [[nodiscard]] BootProblem problem_of(const BusNode& node) const;
  /// What the controller says where it is not well; empty elsewhere.
  [[nodiscard]] std::string controller_text(const CanController& now) const;
  void reset_all() noexcept;

  // On the cycle
  void fetch(std::chrono::nanoseconds now) noexcept;
  void take(const CanFrame& frame, std::chrono::nanoseconds now) noexcept;
  void take_answer(BusAxis& axis, BusAxis::Answer& answer, const CanFrame& frame) noexcept;
  /// A SYNC is on the bus, whoever sent it.
  void count_sync() noexcept {
    for (BusAxis& axis : axes) axis.sync();
  }
  void watch(std::chrono::nanoseconds now) noexcept;
  /// The bus may be used: it is told before a drive is found silent because of it.
  [[nodiscard]] bool sound(std::chrono::nanoseconds now) noexcept;
  void note_silence(std::span<const DriveFeedback> feedback) noexcept;
  void ask_positions(std::span<const DriveCommand> commands, std::chrono::nanoseconds now) noexcept;
  void take_positions() noexcept;
  void send_asides(std::chrono::nanoseconds now) noexcept;
  /// Of a node that was lost.
  void forget_answers(const BusNode& node) noexcept;
  void fill(std::span<DriveFeedback> feedback) noexcept;
  [[nodiscard]] bool send(const CanFrame& frame) noexcept;
  [[nodiscard]] bool send_setpoints(std::size_t first, std::span<const DriveCommand> commands) noexcept;
  [[nodiscard]] bool send_more_setpoints(std::span<const DriveCommand> commands) noexcept;
  [[nodiscard]] bool send_cycle(std::span<const DriveCommand> commands, std::chrono::nanoseconds now) noexcept;

  CanopenConfig config;
  OpenPort open;
  std::unique_ptr<CanPort> port;
  std::deque<BusNode> nodes;
  std::vector<BusAxis> axes;
  std::vector<std::size_t> rpdos;  ///< the first axis of each
  CanopenCounters counters;
  BusRecord record;
  std::vector<std::string> notes;  ///< of the start
  BusTrouble trouble;
  OtherMaster other_master;
  std::chrono::nanoseconds next_heartbeat{0};
  std::chrono::nanoseconds next_time{0};
  std::size_t aside = 0;  ///< whose turn it is to send a frame beside those of the cycle
  bool synced = true;     ///< SYNC went out where it goes ahead of the setpoints
  bool running = false;
  bool fresh = false;  ///< no cycle since start
};

}  // namespace rmac::fieldbus::canopen
