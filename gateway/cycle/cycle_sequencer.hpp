#pragma once

#include <cstdint>
#include <optional>

#include "gateway/state/cycle_state.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/motion/planner.hpp"
#include "rmac/sdk/rmac_cam.hpp"

namespace rmac::gateway {

/// What the sequencer sees of the machine.
struct CycleObservation {
  double t_s = 0;                ///< machine time
  bool at_rest = true;           ///< nothing moves and nothing published is still to move
  bool retraced = false;         ///< at rest at the end of a retrace
  std::size_t moves_left = 0;    ///< queued, the one under way included
  std::uint64_t moves_done = 0;  ///< since the mechanism went in
  bool faulted = false;          ///< the servo loop is
  bool emergency_stop = false;   ///< and that is why
  bool spindles_at_speed = true;
  bool follows = false;       ///< joints follow the plan
  std::uint32_t homings = 0;  ///< that the drives have completed
  bool air = true;            ///< the machine has its compressed air, or needs none
  bool measures = false;      ///< what is left in the queue is a measurement, which counts as one move
};

/// Why the machine came to rest.
enum class StopCause : std::uint8_t {
  CycleStop,
  StopNow,
  JogLapsed,
  JogEnded,
  MoveDone,
  RetraceEnded,
  Homed,
  HitByHand,
  UnexpectedHit,
  PartNotFound,
  AirLost,
  Parked,
  ProbeLost,
  ProbeDeflected,
  ProbeStuck
};

/// What happened, and what to do to go on.
[[nodiscard]] const char* describe(StopCause cause) noexcept;
/// The status that such a stop leaves; None where nothing went wrong.
[[nodiscard]] MinorCode code_of(StopCause cause) noexcept;

/// The machine's cycle states and what they mean for the path (contract "Cycle"):
/// Idle → Running ⇄ Holding, any → Stopping → Idle, any → Faulted, left by a reset alone. A pure state machine: the
/// motion supervisor asks it under its lock.
class CycleSequencer {
 public:
  [[nodiscard]] Expected<> start(sdk::CycleMode mode, const CycleObservation& seen);
  /// Whether a jog may begin.
  [[nodiscard]] Expected<> check_positioning(const CycleObservation& seen) const;
  /// Runs one move that needs no spindle: a jog. With `lasts_s` it stops when it was not renewed for so long.
  [[nodiscard]] Expected<> start_positioning(const CycleObservation& seen, std::optional<double> lasts_s);
  /// A jog that lasts while it is renewed is under way, and not yet told to stop.
  [[nodiscard]] bool jogs() const noexcept { return state_ == CycleState::Running && jog_until_s_.has_value(); }
  void renew_jog(const CycleObservation& seen, double lasts_s) noexcept { jog_until_s_ = seen.t_s + lasts_s; }
  /// A jog, or another move outside of the cycle, is under way.
  [[nodiscard]] bool positions() const noexcept { return positioning_; }
  /// Has the drives home, from rest.
  [[nodiscard]] Expected<> start_homing(const CycleObservation& seen);
  [[nodiscard]] bool homes() const noexcept { return homing_; }
  /// Whether a retrace may begin.
  [[nodiscard]] Expected<> check_retrace(const CycleObservation& seen) const;
  /// Runs back what the planner readied; then the machine is Holding again.
  void retrace() noexcept;
  [[nodiscard]] Expected<> stop();
  [[nodiscard]] Expected<> stop_and_clear(StopCause cause = StopCause::StopNow);
  /// The probe has touched: a jog ends; a search ends where it is, and the cycle goes on with what is queued then.
  void touched() noexcept;
  [[nodiscard]] Expected<> hold();
  /// A program that was parked is queued again, and held.
  void take_up(sdk::CycleMode mode, const CycleObservation& seen) noexcept;
  [[nodiscard]] Expected<> resume();
  /// Leaves Faulted or EmergencyStop; the path was emptied before.
  [[nodiscard]] Expected<> reset();
  void fault(CycleState to = CycleState::Faulted) noexcept;
  /// Another mechanism went in: `keep_running` when it is the same one, configured anew.
  void mechanism_changed(bool keep_running) noexcept;
  /// What is no move, and done by itself in manual mode, is done: a tool change.
  void one_done() noexcept { one_done_ = true; }
  /// A spindle was told another speed: motion that has not begun waits for it, at most `timeout_s`.
  void spindle_commanded(double timeout_s) noexcept;

  struct Verdict {
    std::optional<PathCommand> command;  ///< for the planner, when it changes
    bool clear_queue = false;
    std::optional<StopCause> came_to_rest;  ///< a stop is complete
    bool spindle_timed_out = false;         ///< now Faulted
  };
  [[nodiscard]] Verdict step(const CycleObservation& seen) noexcept;

  [[nodiscard]] CycleState state() const noexcept { return state_; }
  [[nodiscard]] sdk::CycleMode mode() const noexcept { return mode_; }
  /// Whether the stop under way empties the queue.
  [[nodiscard]] bool clears_at_rest() const noexcept { return clear_at_rest_; }
  [[nodiscard]] bool waits_for_spindle() const noexcept { return spindle_wait_; }

 private:
  [[nodiscard]] Expected<> refuse_when_faulted(const char* what) const;
  /// Also where the machine lacks what it needs to move.
  [[nodiscard]] Expected<> refuse_when_unfit(const char* what, const CycleObservation& seen) const;
  [[nodiscard]] PathCommand wanted(const CycleObservation& seen) noexcept;

  CycleState state_ = CycleState::Idle;
  sdk::CycleMode mode_ = sdk::CycleMode::Automatic;
  PathCommand commanded_ = PathCommand::Stop;
  bool clear_at_rest_ = false;
  StopCause stop_cause_ = StopCause::CycleStop;  ///< of the stop under way
  bool positioning_ = false;
  bool retracing_ = false;
  bool homing_ = false;
  bool ends_search_ = false;  ///< at rest the rest of the queue, a search, is dropped
  std::uint32_t homings_before_ = 0;
  std::optional<double> jog_until_s_;
  bool spindle_wait_ = false;
  double spindle_timeout_s_ = 0;
  std::optional<double> waiting_since_s_;
  std::uint64_t done_at_start_ = 0;
  bool one_done_ = false;
};

}  // namespace rmac::gateway
