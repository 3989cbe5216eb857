#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "gateway/collision/ahead/collision_guard.hpp"
#include "gateway/cycle/output_marks.hpp"
#include "gateway/cycle/program_turn.hpp"
#include "gateway/cycle/queue_steps.hpp"
#include "gateway/cycle/standing_wishes.hpp"
#include "gateway/cycle/states/cycle_sequencer.hpp"
#include "gateway/cycle/states/feed_override.hpp"
#include "gateway/cycle/tool_change.hpp"
#include "gateway/cycle/watch/path_watch.hpp"
#include "gateway/cycle/watch/probe_watch.hpp"
#include "gateway/mechanism/mechanism.hpp"
#include "gateway/queue/move_queue.hpp"
#include "gateway/servo/planning.hpp"
#include "gateway/servo/servo_link.hpp"
#include "gateway/threads/turn_lock.hpp"

namespace rmac::gateway {

/// The machine's cycle: its parts, the one lock that guards them all, and the way of what is seen of the machine
/// through them. The gateway and the planner take turns (`GatewayTurn`, `PlannerTurn`); clang proves that whoever
/// touches a part has one. Beside the parts the lock guards the planner of the mechanism in force; its path builder is
/// the gateway thread's alone.
class MachineCycle {
 public:
  struct Options {
    std::size_t queue_capacity = Planner::kQueueCapacity;
    /// Virtual time stands still this long (of real time) after a move was queued while few moves are: a client that is
    /// still sending must not find its queue run dry because time flew.
    std::chrono::milliseconds client_grace{20};
    bool jog_while_waiting = false;  ///< see `CycleSequencer`
    bool guard_in_thread = true;     ///< see `CollisionGuard`
  };

  MachineCycle(Options options, ServoLink& link);

  TurnLock lock;
  /// Of the planner, by who waits for a turn to command something.
  Interruption interruption;

  StandingWishes wishes GUARDED_BY(lock);
  CycleNews news GUARDED_BY(lock);
  CycleSequencer sequencer GUARDED_BY(lock);
  MoveQueue queue GUARDED_BY(lock);
  ToolChange tools GUARDED_BY(lock);
  ProgramTurn program_turn GUARDED_BY(lock);
  ProbeWatch probe GUARDED_BY(lock);
  FeedOverride feed GUARDED_BY(lock);
  OutputMarks marks GUARDED_BY(lock);
  QueueSteps steps GUARDED_BY(lock);
  CollisionGuard guard GUARDED_BY(lock);

  /// Takes a turn of the gateway: `function(sequencer, observation)` commands the cycle states; then acts on what it
  /// changed.
  template <typename Function>
  auto command(Function&& function) EXCLUDES(lock) {
    const Interruption::Request urgent(interruption);
    const GatewayTurn turn(lock);
    notice_fault();
    auto result = function(sequencer, observe(status()));
    settle(status());
    return result;
  }

  /// As `command`, for what stops the machine: the servo thread knows before the lock is waited for, and knows it still
  /// where the planner hangs with it.
  template <typename Function>
  auto stop_command(Function&& function) EXCLUDES(lock) {
    link_.stops.asked.store(true, std::memory_order_release);
    try {
      auto result = command(std::forward<Function>(function));
      link_.stops.asked.store(false, std::memory_order_release);
      return result;
    } catch (const PlannerHangs&) {
      throw;
    } catch (...) {
      link_.stops.asked.store(false, std::memory_order_release);
      throw;
    }
  }

  /// A jog that lasts while it is renewed is under way; needs no turn.
  [[nodiscard]] bool jogs() const noexcept { return jogs_.load(std::memory_order_acquire); }

  /// One bounded piece of planning, and the cycle states.
  [[nodiscard]] Planning::Pace advance(const ServoStatus& status) REQUIRES(lock);
  /// Takes note of a fault that samples, and so clients, show already.
  void notice_fault() REQUIRES(lock);
  /// Has every part see `status`, and does what they make of it.
  void settle(const ServoStatus& status) REQUIRES(lock);
  /// Takes the steps of the queue whose turn has come.
  void take_steps(const ServoStatus& status) REQUIRES(lock);

  /// As the servo loop tells it; needs no turn.
  [[nodiscard]] ServoStatus status() const noexcept { return link_.status.read(); }
  [[nodiscard]] CycleObservation observe(const ServoStatus& status) REQUIRES(lock);

  /// Refuses when a move cannot be taken now; then readies the path builder to begin where the machine stands, if it
  /// must. Gateway thread.
  [[nodiscard]] Expected<> ready_for_move() REQUIRES(lock);
  /// What was built to follow the queue does not any more: it was emptied, or is being. Then the next move begins anew.
  [[nodiscard]] bool queue_is_gone() REQUIRES(lock);
  /// Queues what was built, all of it or nothing; how many have motion.
  [[nodiscard]] Expected<std::size_t> add(std::vector<BuiltMove> built) REQUIRES(lock);
  /// True when nothing moves and nothing is queued; otherwise an error that says what `what` must wait for.
  [[nodiscard]] Expected<> require_rest(const char* what) REQUIRES(lock);
  /// Moves queued and not yet done, those without motion included. A measurement is one.
  [[nodiscard]] std::size_t moves_left() REQUIRES(lock);
  /// Drops what is queued, at rest.
  void empty_queue(const ServoStatus& status) REQUIRES(lock);
  /// Hands the override on to the planner.
  void apply_feed() REQUIRES(lock);
  /// Spindles were told another speed: motion waits for the slowest of them.
  void await_spindles() REQUIRES(lock);

  /// Puts a mechanism in force, or none; the one before.
  [[nodiscard]] std::shared_ptr<Mechanism> install(std::shared_ptr<Mechanism> next, std::uint64_t generation,
                                                   bool keep_running) REQUIRES(lock);
  [[nodiscard]] const std::shared_ptr<Mechanism>& mechanism() const REQUIRES(lock) { return in_force_.mechanism; }
  /// That of the mechanism in force, which there must be. Gateway thread, with a turn or without: building takes long,
  /// and planning goes on meanwhile.
  [[nodiscard]] PathBuilder& builder() noexcept { return *builder_; }

 private:
  void watch_probe(const CycleObservation& seen, const ServoStatus& status) REQUIRES(lock);
  void apply_verdict(const CycleSequencer::Verdict& verdict, const ServoStatus& status) REQUIRES(lock);
  void tell_spindle_timeout(const ServoStatus& status) REQUIRES(lock);
  /// Faulted where the path is left, or does not get on.
  void watch_path(const CycleObservation& seen, const ServoStatus& status) REQUIRES(lock);
  /// From beside the path the way back to it comes first.
  void lead_back(const CycleObservation& seen, const ServoStatus& status) REQUIRES(lock);
  [[nodiscard]] std::string beside_path(const ServoStatus& status) const REQUIRES(lock);
  /// Holds a program, and ends a jog, that rests before a collision.
  void heed_guard(const CycleObservation& seen) REQUIRES(lock);
  void tell_state() REQUIRES(lock);
  [[nodiscard]] Planning::Pace pace(const ServoStatus& status) REQUIRES(lock);

  struct InForce {
    std::shared_ptr<Mechanism> mechanism;
    std::uint64_t generation = 0;
  };
  /// What clients know already.
  struct Told {
    CycleState state = CycleState::Idle;
    bool beside = false;    ///< the machine rests beside its path
    bool obstacle = false;  ///< a collision lies ahead
  };

  const Options options_;
  ServoLink& link_;  ///< free of locks itself
  InForce in_force_ GUARDED_BY(lock);
  PathBuilder* builder_ = nullptr;  ///< the gateway thread's alone
  std::atomic<bool> jogs_{false};   ///< written with a turn, read without
  PathWatch path_watch_ GUARDED_BY(lock);
  Told told_ GUARDED_BY(lock);
};

}  // namespace rmac::gateway
