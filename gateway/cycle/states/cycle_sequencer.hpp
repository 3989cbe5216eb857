#pragma once

#include <cstdint>
#include <optional>

#include "gateway/cycle/states/cycle_phase.hpp"
#include "gateway/cycle/states/spindle_wait.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/motion/planner.hpp"
#include "rmac/sdk/device_object.hpp"
#include "rmac/sdk/rmac_cam.hpp"

namespace rmac::gateway {

/// What the sequencer sees of the machine.
struct CycleObservation {
  double t_s = 0;                ///< machine time
  bool at_rest = true;           ///< nothing moves and nothing published is still to move
  bool retraced = false;         ///< at rest at the end of a retrace
  bool at_end = true;            ///< at rest where the path that is planned ends; the tool did not go back from there
  bool blocked = false;          ///< at rest where a collision check lets the path go no farther
  std::size_t moves_left = 0;    ///< queued, the one under way included
  bool done = true;              ///< nothing is queued, no tool change either
  std::uint64_t moves_done = 0;  ///< since the mechanism went in
  bool faulted = false;          ///< the servo loop is
  bool emergency_stop = false;   ///< and that is why
  bool spindles_at_speed = true;
  bool follows = false;                       ///< joints follow the plan
  std::uint32_t homings = 0;                  ///< that the drives have completed
  std::uint32_t reference_lost = 0;           ///< bit j: joint j's position is not to be relied on
  const sdk::DeviceObject* device = nullptr;  ///< whose joints these are
  bool air = true;                            ///< the machine has its compressed air, or needs none
  bool measures = false;                      ///< what is left in the queue is a measurement, which counts as one move
};

/// Refuses what goes to a place while joints (bits of `lost`) of the device have lost their reference; jogs and homing
/// go by none.
[[nodiscard]] Expected<> require_references(const char* what, std::uint32_t lost, const sdk::DeviceObject* device);

/// Refuses what would start motion while an operator holds the machine; null: none does.
[[nodiscard]] Expected<> refuse_when_held(const char* what, const OperatorRef& by);

/// Refuses what would go on into a collision.
[[nodiscard]] Expected<> refuse_when_blocked(const char* what, const CycleObservation& seen);

/// The cycle is started, and nothing is there for it to do.
[[nodiscard]] bool waits_for_moves(const CyclePhase& phase, const CycleObservation& seen) noexcept;

/// The machine's cycle states and what they mean for the path (contract "Cycle"):
/// Idle → Running ⇄ Holding, any → Stopping → Idle, any → Faulted, left by a reset alone. A pure state machine: it is
/// asked under the lock of the machine's cycle.
class CycleSequencer {
 public:
  /// `jog_while_waiting`: a jog from rest ends a cycle that is started and has nothing queued, where it is refused
  /// otherwise.
  explicit CycleSequencer(bool jog_while_waiting = false) : jog_while_waiting_(jog_while_waiting) {}

  [[nodiscard]] Expected<> start(sdk::CycleMode mode, const CycleObservation& seen);
  /// A jog is about to begin, where `check_positioning` lets it: a cycle that only waits for moves ends.
  void end_waiting(const CycleObservation& seen) noexcept {
    if (waits_for_moves(phase_, seen)) phase_.rest();
  }
  /// Whether a jog may begin.
  [[nodiscard]] Expected<> check_positioning(const CycleObservation& seen) const;
  /// Runs one move that needs no spindle: a jog. With `lasts_s` it stops when it was not renewed for so long.
  [[nodiscard]] Expected<> start_positioning(const CycleObservation& seen, std::optional<double> lasts_s);
  /// Has no effect when no jog is under way.
  void renew_jog(const CycleObservation& seen, double lasts_s) noexcept;
  /// Has the drives home, from rest.
  [[nodiscard]] Expected<> start_homing(const CycleObservation& seen);
  /// Whether a retrace may begin. Here and below, `by` is the operator who commands it, or null.
  [[nodiscard]] Expected<> check_retrace(const CycleObservation& seen, const OperatorRef& by = {}) const;
  /// Runs back what the planner readied; then the machine is Holding again, for the operator where one did it.
  void retrace(const OperatorRef& by = {}) noexcept;
  [[nodiscard]] Expected<> stop();
  /// Where all that was queued is done, the cause told is the cycle's end.
  [[nodiscard]] Expected<> stop_and_clear(const CycleObservation& seen, StopCause cause = StopCause::StopNow);
  /// The probe has touched: a jog ends; a search ends where it is, and the cycle goes on with what is queued then.
  void touched() noexcept { phase_.touch(); }
  /// An operator's hold also keeps everything from starting, in whatever state, until an operator resumes or lets go.
  [[nodiscard]] Expected<> hold(const OperatorRef& by = {});
  /// A program that was parked is queued again, and held.
  void take_up(sdk::CycleMode mode, const CycleObservation& seen) noexcept;
  [[nodiscard]] Expected<> resume(const OperatorRef& by = {});
  /// The operator's hold becomes one of the program's, where there is one; nothing moves. True when there was one.
  bool let_go() noexcept { return phase_.let_go(); }
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
  [[nodiscard]] const CyclePhase& phase() const noexcept { return phase_; }
  /// The mode of the cycle that was started last; a positioning counts as manual.
  [[nodiscard]] sdk::CycleMode mode() const noexcept { return mode_; }
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

  const bool jog_while_waiting_;
  CyclePhase phase_;
  sdk::CycleMode mode_ = sdk::CycleMode::Automatic;
  PathCommand commanded_ = PathCommand::Stop;
  OneMove one_move_;  ///< in manual mode
  SpindleWait spindle_wait_;
};

}  // namespace rmac::gateway
