#pragma once

#include <cstdint>
#include <optional>

#include "gateway/cycle/cycle_phase.hpp"
#include "gateway/cycle/spindle_wait.hpp"
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
  bool follows = false;              ///< joints follow the plan
  std::uint32_t homings = 0;         ///< that the drives have completed
  std::uint32_t reference_lost = 0;  ///< bit j: joint j's position is not to be relied on
  bool air = true;                   ///< the machine has its compressed air, or needs none
  bool measures = false;             ///< what is left in the queue is a measurement, which counts as one move
};

/// Refuses what goes to a place while joints (bits of `lost`) have lost their reference; jogs and homing go by none.
[[nodiscard]] Expected<> require_references(const char* what, std::uint32_t lost);

/// The machine's cycle states and what they mean for the path (contract "Cycle"):
/// Idle → Running ⇄ Holding, any → Stopping → Idle, any → Faulted, left by a reset alone. A pure state machine: it is
/// asked under the lock of the machine's cycle.
class CycleSequencer {
 public:
  [[nodiscard]] Expected<> start(sdk::CycleMode mode, const CycleObservation& seen);
  /// Whether a jog may begin.
  [[nodiscard]] Expected<> check_positioning(const CycleObservation& seen) const;
  /// Runs one move that needs no spindle: a jog. With `lasts_s` it stops when it was not renewed for so long.
  [[nodiscard]] Expected<> start_positioning(const CycleObservation& seen, std::optional<double> lasts_s);
  /// A jog that lasts while it is renewed is under way, and not yet told to stop.
  [[nodiscard]] bool jogs() const noexcept { return phase_.runs<CyclePhase::Jog>() != nullptr; }
  /// Has no effect when no jog is under way.
  void renew_jog(const CycleObservation& seen, double lasts_s) noexcept;
  /// A jog, or another move outside of the cycle, is under way, held, or coming to rest.
  [[nodiscard]] bool positions() const noexcept { return phase_.positions(); }
  /// Has the drives home, from rest.
  [[nodiscard]] Expected<> start_homing(const CycleObservation& seen);
  [[nodiscard]] bool homes() const noexcept { return phase_.runs<CyclePhase::Homing>() != nullptr; }
  /// Whether a retrace may begin.
  [[nodiscard]] Expected<> check_retrace(const CycleObservation& seen) const;
  /// Runs back what the planner readied; then the machine is Holding again.
  void retrace() noexcept { phase_.run(CyclePhase::Retrace{}); }
  [[nodiscard]] Expected<> stop();
  [[nodiscard]] Expected<> stop_and_clear(StopCause cause = StopCause::StopNow);
  /// The probe has touched: a jog ends; a search ends where it is, and the cycle goes on with what is queued then.
  void touched() noexcept { phase_.touch(); }
  [[nodiscard]] Expected<> hold();
  /// A program that was parked is queued again, and held.
  void take_up(sdk::CycleMode mode, const CycleObservation& seen) noexcept;
  [[nodiscard]] Expected<> resume();
  /// Leaves Faulted or EmergencyStop; the path was emptied before.
  [[nodiscard]] Expected<> reset();
  void fault(bool emergency_stop = false) noexcept { phase_.fault(emergency_stop); }
  /// Another mechanism went in: `keep_running` when it is the same one, configured anew.
  void mechanism_changed(bool keep_running) noexcept;
  /// What is no move, and done by itself in manual mode, is done: a tool change.
  void one_done() noexcept { one_move_.done = true; }
  /// A spindle was told another speed: motion that has not begun waits for it, at most `timeout_s`.
  void spindle_commanded(double timeout_s) noexcept { spindle_wait_.begin(timeout_s); }

  struct Verdict {
    std::optional<PathCommand> command;  ///< for the planner, when it changes
    bool clear_queue = false;
    std::optional<StopCause> came_to_rest;  ///< a stop is complete
    bool spindle_timed_out = false;         ///< now Faulted
    std::optional<double> jog_until_s;      ///< machine time at which the jog under way lapses
  };
  [[nodiscard]] Verdict step(const CycleObservation& seen) noexcept;

  [[nodiscard]] CycleState state() const noexcept { return phase_.state(); }
  /// The mode of the cycle that was started last; a positioning counts as manual.
  [[nodiscard]] sdk::CycleMode mode() const noexcept { return mode_; }
  /// A stop is under way at whose end the queue is emptied.
  [[nodiscard]] bool empties_queue() const noexcept { return phase_.empties_queue(); }
  [[nodiscard]] bool waits_for_spindle() const noexcept { return spindle_wait_.waiting(); }
  /// The planner was told to travel the path, one way or the other.
  [[nodiscard]] bool travels() const noexcept { return commanded_ != PathCommand::Stop; }

 private:
  struct OneMove {
    std::uint64_t done_before = 0;  ///< moves done when it was started
    bool done = false;              ///< what is no move
  };

  void count_from(const CycleObservation& seen) noexcept { one_move_ = {seen.moves_done, false}; }
  void end_what_is_done(const CycleObservation& seen, Verdict& verdict) noexcept;
  [[nodiscard]] PathCommand wanted(const CycleObservation& seen) const noexcept;

  CyclePhase phase_;
  sdk::CycleMode mode_ = sdk::CycleMode::Automatic;
  PathCommand commanded_ = PathCommand::Stop;
  OneMove one_move_;  ///< in manual mode
  SpindleWait spindle_wait_;
};

}  // namespace rmac::gateway
