#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "gateway/mechanism/exchangeable_law.hpp"
#include "gateway/mechanism/mechanism.hpp"
#include "gateway/servo/cycle_history.hpp"
#include "gateway/servo/cycle_times.hpp"
#include "gateway/servo/path_outputs.hpp"
#include "gateway/servo/snapshot.hpp"
#include "gateway/state/cycle_state.hpp"
#include "rmac/motion/servo/learned_path.hpp"

namespace rmac::gateway {

/// What the servo loop is to do beside following plans. Written whole under the lock of the machine's
/// cycle.
struct ServoWishes {
  bool power = false;
  bool reset = false;
  bool home = false;
  Frames frames;
  std::array<double, kMaxSpindles> spindle_rpm{};
  double tool_torque_nm = 0;  ///< most that the tool in spindle 0 bears; 0: not given
  bool learned = false;       ///< what was learned of the program counts
  bool program = false;       ///< what runs, or is held, is the queue of a cycle: no jog, no way back
  std::uint64_t outputs = 0;
  std::uint64_t marks_settled = 0;         ///< marks up to this one are in `outputs`, or are dropped
  std::array<double, kMaxJoints> force{};  ///< of joints under force control
  CycleState state = CycleState::Idle;     ///< goes into the samples, with the next
  std::optional<std::int64_t> in_turn;     ///< at rest, what is done between moves: its id
  /// Machine time at which motion is to end by itself: a jog's, unless it is renewed.
  double moves_until_s = std::numeric_limits<double>::infinity();
};

/// What the servo loop is to do whoever holds the lock of the machine's cycle: the planner may hang with it.
struct StopWishes {
  std::atomic<bool> planned{false};  ///< the planner was told to stop; by who has the lock
  std::atomic<bool> asked{false};    ///< the gateway is about to tell it, or cannot
  std::atomic<bool> kept{false};     ///< for good: something hangs
  std::atomic<bool> power_off{false};

  [[nodiscard]] bool stop() const noexcept {
    return planned.load(std::memory_order_acquire) || asked.load(std::memory_order_acquire) ||
           kept.load(std::memory_order_acquire);
  }
};

/// The little of a cycle that planning and the cycle states need.
struct ServoStatus {
  ServoProgress progress;
  std::uint64_t generation = 0;  ///< counts mechanisms put in; a status of another one is stale
  double t_s = 0;
  ServoState state = ServoState::Off;
  ServoFault fault;
  bool follows = false;  ///< joints follow the plan, and may be moved
  bool moving = false;
  std::int64_t move_id = 0;  ///< the place on the path, with the next
  double s_mm = 0;
  std::uint64_t moves_done = 0;
  std::uint64_t marks_passed = 0;  ///< the last mark that the path has passed
  std::uint32_t homings = 0;
  std::uint32_t reference_lost = 0;  ///< bit j: joint j has to find home again
  ProbeReport probe;
  std::uint32_t joint_count = 0;
  std::uint32_t joint_count_with_held = 0;
  std::array<double, kMaxJoints> position_set{};
  std::array<double, kMaxSpindles> spindle_rpm{};
};

struct FaultRecord {
  std::int64_t cycle = 0;
  double t_s = 0;
  std::uint64_t generation = 0;
  std::int64_t move_id = 0;
  double s_mm = 0;
  ServoFault fault;
};

/// Another mechanism for the servo loop, or none. It is put in between two cycles, at standstill; `refused` otherwise.
/// Or, where there are `laws` or `methods`, these for joints of the mechanism in force, at standstill or in motion;
/// refused where a joint has slipped off the plan that is to keep its position. Or, where `learns`, what was learned of
/// the program that follows. Other laws or methods forget that: it was learned with those of before.
struct SwapRequest {
  enum class Result : std::uint8_t { Waiting, Done, Refused };
  struct Law {
    ExchangeableLaw* joint = nullptr;
    std::shared_ptr<ServoLaw> law;  ///< for it; afterwards the one that it had
  };
  struct Method {
    std::size_t joint = 0;
    ControlMethod method = ControlMethod::Position;  ///< or velocity
  };
  std::span<Law> laws;
  std::span<const Method> methods;
  bool learns = false;
  std::shared_ptr<const LearnedPath> learned;  ///< afterwards what was there before
  Mechanism* next = nullptr;
  std::uint64_t generation = 0;
  std::atomic<Result> result{Result::Waiting};
};

/// Cycles by which the servo thread may be ahead of the gateway: in virtual time it waits then.
inline constexpr std::int64_t kMostUndelivered = 4096;

/// Everything that the servo thread shares with others. No lock, and nobody allocates after it was made.
struct ServoLink {
  /// Keeps the samples of so many cycles at least.
  explicit ServoLink(std::size_t history_cycles)
      : history(std::max(history_cycles, static_cast<std::size_t>(kMostUndelivered))) {}

  LatestValue<ServoWishes> wishes;
  MarkRing marks;
  StopWishes stops;
  std::atomic<SwapRequest*> swap{nullptr};

  SequenceLocked<ServoStatus> status;
  CycleHistory history;
  std::atomic<std::int64_t> delivered{0};  ///< last cycle whose sample the gateway took
  SpscRing<FaultRecord, 64> faults;
  CycleTimes times;
};

}  // namespace rmac::gateway
