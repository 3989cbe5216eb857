#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>

#include "canopen/node_boot.hpp"
#include "canopen/pdo.hpp"
#include "canopen/watch/node_guard.hpp"
#include "canopen/watch/node_record.hpp"
#include "canopen/watch/node_trouble.hpp"
#include "canopen/watch/position_reader.hpp"
#include "rmac/fieldbus/canopen/canopen_interface.hpp"

namespace rmac::fieldbus::canopen {

/// A node as its bus has it: on its way up, or in operation; and whether it is lost, by what it says and by its
/// silence.
struct BusNode {
  BusNode(const CanopenConfig& config, const AxisConfig& first)
      : boot(config, first.node),
        guard(config.heartbeat),
        positions(first.node),
        record(config.period),
        measured(answer_id(first)) {}
  /// Anew, whatever is known of it. Off the cycle.
  void start(std::chrono::nanoseconds now) noexcept;
  /// A frame under one of its own ids: emergency, SDO answer or heartbeat. True when the node is lost by it: it is
  /// being brought up again. Real-time safe, as all below.
  [[nodiscard]] bool take(const CanFrame& frame, std::chrono::nanoseconds now, std::chrono::nanoseconds since_start,
                          CanopenCounters& counters) noexcept;
  /// Time passes: true when it is lost by its silence, which may last as long as `patience`.
  [[nodiscard]] bool watch(std::chrono::nanoseconds now, std::chrono::nanoseconds patience,
                           CanopenCounters& counters) noexcept;
  /// It knows no heartbeat, and is asked how it is instead: while it is set up too, as some reckon their master's life
  /// from when they are told 100Ch and 100Dh on, and not from the first question.
  [[nodiscard]] bool guarded() const noexcept {
    const NodeBoot::State state = boot.state();
    const bool asked = boot.watched() || state == NodeBoot::State::Configuring || state == NodeBoot::State::Starting;
    return asked && boot.plan().drive != nullptr && boot.plan().drive->manners.node_guarding;
  }
  /// Its question, when one is due. Real-time safe.
  [[nodiscard]] bool asks(std::chrono::nanoseconds now) noexcept {
    if (guarded()) return guard.asks(now);
    guard.restart(now);
    return false;
  }
  /// Where it is on its way to Operational, as a person reads it.
  [[nodiscard]] const char* state() const noexcept {
    constexpr std::array kStates{
        "off", "awaiting boot-up", "being configured", "being started", "being watched", "operational", "failed"};
    return up ? "operational" : kStates.at(static_cast<std::size_t>(boot.state()));
  }
  /// Units of position in a revolution of an axis's motor, by the drive's factors: counts x feed constant / (encoder
  /// resolution x gear ratio) (CiA 402-2, 6.3); 0 where it does not tell them.
  [[nodiscard]] double counts_per_revolution(std::size_t axis_in_node) const noexcept {
    const auto ratio = [&](std::uint16_t index) {
      const auto offset = static_cast<std::uint16_t>(kAxisOffset * axis_in_node);
      const double over = boot.reading(of_axis({index, 1}, offset)), under = boot.reading(of_axis({index, 2}, offset));
      return over > 0 && under > 0 ? over / under : 0;
    };
    const double gear = ratio(0x6091), feed = ratio(0x6092);
    return feed > 0 ? feed / (gear > 0 ? gear : 1) : ratio(0x608F);
  }

  NodeBoot boot;
  NodeGuard guard;
  PositionReader positions;
  NodeTrouble trouble;
  NodeRecord record;
  std::uint16_t measured;  ///< the answer whose evenness is
  std::chrono::nanoseconds heard{0};
  std::uint16_t error_code = 0;
  bool up = false;
  bool was_present = false;                  ///< all its axes answered, since the bus was started
  std::atomic<bool> silent_with_all{false};  ///< when it last was silent, so were all others; any thread
  bool told_position = false;                ///< in this cycle: whoever asked does not know yet

 private:
  void lose(const BootProblem& why, std::chrono::nanoseconds now, CanopenCounters& counters) noexcept;
};

}  // namespace rmac::fieldbus::canopen
