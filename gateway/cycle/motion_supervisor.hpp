#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "gateway/cycle/cycle_sequencer.hpp"
#include "gateway/cycle/measurement.hpp"
#include "gateway/cycle/program_log.hpp"
#include "gateway/cycle/queue_step.hpp"
#include "gateway/servo/planning.hpp"
#include "gateway/state/event.hpp"
#include "gateway/state/queue_listener.hpp"
#include "gateway/tools/tool.hpp"

namespace rmac::gateway {

/// Joins cycle states, planner and servo wishes under one lock. The gateway thread commands it; `advance` runs on the
/// planner thread, or, in virtual time, between two servo cycles. Never called by a servo thread in real pace.
class MotionSupervisor final : public Planning {
 public:
  struct Options {
    double period_s = 0.001;
    std::size_t queue_capacity = Planner::kQueueCapacity;
    /// Virtual time stands still this long (of real time) after a move was queued while few moves are: a client that is
    /// still sending must not find its queue run dry because time flew.
    std::chrono::milliseconds client_grace{20};
  };

  MotionSupervisor(Options options, ServoLink& link);

  Pace advance(const ServoStatus& status) override;
  void wait_for_work(std::chrono::nanoseconds period) override;

  // All below: gateway thread.

  /// Runs `function(sequencer, observation)` of the cycle states and acts on what it changed.
  template <typename Function>
  auto command(Function&& function) {
    const Turn turn(*this);
    notice_fault();
    auto result = function(sequencer_, observe(status()));
    settle(status());
    return result;
  }

  /// Refuses when a move cannot be taken now; then readies `builder()` to begin where the machine stands, if it must.
  [[nodiscard]] Expected<> prepare_move();
  /// Adds a point to be measured: the approach, if there is one, and the search, which both begin and end at rest.
  /// Nothing can be queued behind it until it is done, because it ends where it finds the part.
  [[nodiscard]] Expected<> add_measurement(const std::optional<Move>& approach, const Move& search);
  /// Once the measurement stands after its hit: adds the way back from there.
  [[nodiscard]] Expected<> add_retract(const Move& move);
  [[nodiscard]] Measurement::Phase measurement();
  /// Hits of a person who jogs are expected.
  void expect_hits_by_hand(bool expected);
  /// In virtual mode, where nothing can touch: the probe is deflected, or let go.
  void simulate_probe(bool touching);
  /// Builds and adds a move that `prepare_move` let through. False when there is nothing to move: such a move is done
  /// as soon as those before it are.
  [[nodiscard]] Expected<bool> add_move(const Move& move);
  /// Adds what is to be done between moves: moves that are added from now on wait behind it. The caller has seen to it
  /// that `builder()` goes on where the steps leave the machine.
  [[nodiscard]] Expected<> add_steps(std::vector<QueueStep> steps, ProgramStep as_sent);
  [[nodiscard]] ToolsNow tools_now();
  /// The person who was asked says that this tool is in.
  [[nodiscard]] Expected<> confirm_tool(int number);
  /// What is in the spindle, as it is known when nothing is queued, and the torque that it bears.
  void set_mounted(std::optional<int> number, double max_torque_nm = 0);
  /// Builds, adds and runs one move from rest, outside of the cycle. With `share` it is a jog that lasts while
  /// `renew_jog` says so, at this share of the move's speed.
  [[nodiscard]] Expected<> run_positioning(const Move& move, std::optional<double> share = std::nullopt);
  /// Keeps the jog under way going, at `share` of its move's speed; false when none is.
  [[nodiscard]] bool renew_jog(double share);
  /// Stops the jog under way, if there is one.
  [[nodiscard]] Expected<> end_jog();
  /// Runs back along up to `distance_mm` of the path of what is held. The way it will go, in mm.
  [[nodiscard]] Expected<double> retrace(double distance_mm);

  // A program that is set aside (parking.cpp).
  struct Parked {
    std::string mechanism;
    bool virtual_mode = false;
    std::deque<ProgramStep> steps;
    sdk::CycleMode mode = sdk::CycleMode::Automatic;
    std::array<double, kMaxSpindles> spindle_rpm{};
    std::uint64_t outputs = 0;  ///< that went off
    double override_percent = 100;
    ToolPose place;                    ///< part frame; where the first step goes on
    std::vector<double> place_joints;  ///< under the frames that were in force
  };
  /// Sets the queue aside; the spindles and `outputs_off` (the coolant) go off.
  [[nodiscard]] Expected<> park(std::uint64_t outputs_off);
  [[nodiscard]] const std::optional<Parked>& parked() const noexcept { return parked_; }
  /// Queues the way to where the first step goes on, and what is left of that step. From rest, with an empty queue.
  [[nodiscard]] Expected<> add_rest_of(const ProgramStep& first);
  /// All steps are queued again: holds them, as before. False when a stop emptied the queue meanwhile.
  [[nodiscard]] bool hold_taken_up();
  /// Empties the queue of what was taken up in part.
  void drop_taken_up();
  /// Forgets the parked program, if there is one, and tells why.
  void drop_parked(const std::string& why);

  /// True when nothing moves and nothing is queued; otherwise an error that says what `what` must wait for.
  [[nodiscard]] Expected<> require_rest(const char* what);
  /// Changes the wishes, for the next cycle.
  void wish(const std::function<void(ServoWishes&)>& change);
  [[nodiscard]] ServoWishes wishes();
  void set_frames(const Frames& frames);
  void set_override(double percent);
  void set_spindle(std::size_t spindle, double rpm);
  /// Moves queued and not yet done, those without motion included; homing by the drives is one.
  [[nodiscard]] std::size_t moves_left();
  [[nodiscard]] CycleState state();
  [[nodiscard]] CycleNow now();
  /// Puts a mechanism in force, or none: from now on moves go to it, and statuses of generations before are ignored.
  /// The old one is handed back; the servo thread must be through with it, or never have had it.
  std::shared_ptr<Mechanism> install(std::shared_ptr<Mechanism> next, std::uint64_t generation, bool keep_running);
  [[nodiscard]] std::shared_ptr<Mechanism> mechanism();

  /// What happened to the queue, in order: a move was added (`Still`: one without motion), or (at `cycle`) everything
  /// not done was dropped, or another mechanism's queue began.
  struct QueueChange {
    enum class Kind : std::uint8_t { Added, Still, Cleared, Replaced };
    Kind kind = Kind::Added;
    std::int64_t move_id = 0;
    std::int64_t cycle = 0;
    MovePart part{};
  };
  struct News {
    std::vector<QueueChange> queue;
    std::vector<Event> events;
  };
  [[nodiscard]] News take_news();
  void on_queued(QueueListener listener) { queue_listener_ = std::move(listener); }
  void report(Event event);

 private:
  void note(Event event) { news_.events.push_back(std::move(event)); }
  /// The gateway goes first: a thread that takes the lock cycle after cycle would otherwise starve it.
  class Turn {
   public:
    explicit Turn(MotionSupervisor& supervisor);
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    ~Turn();

   private:
    MotionSupervisor& supervisor_;
  };

  [[nodiscard]] Expected<> ready_for_move();
  struct PartOfMove {
    const Move* move;
    MovePart part;
  };
  /// All of them or none; how many have motion. `then` runs with that before the planner sees them.
  [[nodiscard]] Expected<std::size_t> build_and_add(const std::vector<PartOfMove>& parts,
                                                    const std::function<void(std::size_t)>& then = {});
  [[nodiscard]] bool add_built(const PartOfMove& part, PathSegments segments);
  void watch_probe(const CycleObservation& seen, const ServoStatus& status);
  [[nodiscard]] ProbeReport probe(const ServoStatus& status) const;
  void begin_where_it_stands();
  [[nodiscard]] ServoStatus status() const noexcept { return link_.status.read(); }
  [[nodiscard]] CycleObservation observe(const ServoStatus& status);
  [[nodiscard]] bool has_air() const;
  [[nodiscard]] bool spindles_at_speed(const ServoStatus& status) const;
  void settle(const ServoStatus& status);
  /// What was taken up goes on: with the spindles and outputs that it had.
  void restart_spindles();
  /// Takes note of a fault that samples, and so clients, show already.
  void notice_fault();
  [[nodiscard]] std::size_t count_moves();
  /// Of the planner and of the steps: a measurement counts as the moves that it is made of.
  [[nodiscard]] std::size_t count_left();
  /// Of what waits behind a step: moves and tool changes.
  [[nodiscard]] std::size_t steps_left() const;
  /// A move's turn has come to be planned.
  void hand_on(QueuedPath path);
  void take_steps(const ServoStatus& status);
  // Each begins or goes on with its step; true when that is done.
  bool take(QueuedPath& path, const CycleObservation& seen);
  bool take(BeginToolChange& begin, const CycleObservation& seen);
  bool take(SwitchOutputs& outputs, const CycleObservation& seen);
  bool take(AwaitInput& input, const CycleObservation& seen);
  bool take(AskPerson& person, const CycleObservation& seen);
  bool take(MountTool& mount, const CycleObservation& seen);
  void drop_steps();
  void forget_moves();
  void apply_verdict(const CycleSequencer::Verdict& verdict, const ServoStatus& status);
  void tell_state();
  void apply_override();
  [[nodiscard]] Pace pace(const ServoStatus& status);

  Options options_;
  ServoLink& link_;

  std::mutex mutex_;
  std::atomic<int> gateway_waits_{0};
  std::condition_variable work_;
  bool work_to_do_ = false;

  std::shared_ptr<Mechanism> mechanism_;
  std::uint64_t generation_ = 0;
  CycleSequencer sequencer_;
  Measurement measurement_;
  ProbeReport simulated_probe_{.ready = true, .touching = false, .hits = 0, .hit_before_s = 0};
  CycleState reported_state_ = CycleState::Idle;
  ServoWishes wishes_;
  bool rebase_ = true;  ///< the next move begins where the machine stands, not where the queue ended
  std::chrono::steady_clock::time_point last_added_{};
  std::uint64_t moves_added_ = 0;          ///< with motion, since the queue was emptied last
  std::deque<std::uint64_t> still_moves_;  ///< without motion, each by the number of those before it
  std::deque<QueueStep> behind_;           ///< the first is no path: it waits for what is planned to be done
  std::optional<int> mounted_ = kNoTool;   ///< tool; none: not known
  bool changing_ = false;                  ///< a tool change has begun
  bool asked_ = false;                     ///< and the person that is to do it
  ProgramLog program_;                     ///< what is queued, as clients sent it
  std::optional<Parked> parked_;
  std::optional<Parked> resumes_with_;  ///< of what was taken up: spindles and outputs for when it goes on
  News news_;
  QueueListener queue_listener_;
  double override_percent_ = 100;
  double jog_share_ = 1;  ///< of a jog's full speed, while it lasts
  double t_s_ = 0;
  std::int64_t cycle_ = 0;
};

}  // namespace rmac::gateway
