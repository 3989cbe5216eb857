#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "gateway/cycle/guarding.hpp"
#include "gateway/cycle/jogging.hpp"
#include "gateway/cycle/machine_cycle.hpp"
#include "gateway/cycle/move_entry.hpp"
#include "gateway/cycle/operating.hpp"
#include "gateway/cycle/parking.hpp"
#include "gateway/cycle/probing.hpp"
#include "gateway/servo/planning.hpp"
#include "gateway/state/queue_listener.hpp"

namespace rmac::gateway {

/// Joins cycle states, planner and servo wishes for those who use them: the gateway thread commands, and the planner
/// thread, or in virtual time the servo thread between two cycles, calls `advance`. Both take turns at the machine's
/// cycle, whose lock guards all that they share.
class MotionSupervisor final : public Planning {
 public:
  using Options = MachineCycle::Options;
  using News = CycleNews::Taken;

  MotionSupervisor(Options options, ServoLink& link) : cycle_(options, link) {}

  Pace advance(const ServoStatus& status) override;
  void wait_for_work(std::chrono::nanoseconds period) override { (void)cycle_.lock.wait_for_work(period); }

  // All below: gateway thread.

  /// Runs `function(sequencer, observation)` of the cycle states and acts on what it changed.
  template <typename Function>
  auto command(Function&& function) {
    return cycle_.command(std::forward<Function>(function));
  }
  /// The same, of what stops the machine: the servo thread knows at once, whoever holds the lock.
  template <typename Function>
  auto stop_command(Function&& function) {
    return cycle_.stop_command(std::forward<Function>(function));
  }
  /// The planner is in a module that does not return: nothing here can be done any more. Needs no lock.
  [[nodiscard]] bool planner_hangs() { return cycle_.lock.planner_hangs(); }
  [[nodiscard]] Parking& parking() noexcept { return parking_; }
  [[nodiscard]] Probing& probing() noexcept { return probing_; }
  [[nodiscard]] Jogging& jogging() noexcept { return jogging_; }
  [[nodiscard]] Operating& operating() noexcept { return operating_; }
  [[nodiscard]] Guarding& guarding() noexcept { return guarding_; }

  /// See `MoveEntry`.
  [[nodiscard]] Expected<> prepare_move() { return entry_.prepare(); }
  [[nodiscard]] Expected<bool> add_move(const Move& move) { return entry_.add(move); }

  /// Adds what is to be done between moves: moves that are added from now on wait behind it. The caller has seen to it
  /// that `builder()` goes on where the steps leave the machine. `function` is what an error names.
  [[nodiscard]] Expected<> add_steps(const char* function, std::vector<QueueStep> steps, ProgramStep as_sent);
  [[nodiscard]] ToolsNow tools_now();
  /// The person who was asked says that this tool is in.
  [[nodiscard]] Expected<> confirm_tool(int number);
  /// What is in the spindle, as it is known when nothing is queued, and the torque that it bears.
  void set_mounted(std::optional<int> number, double max_torque_nm = 0);

  /// True when nothing moves and nothing is queued; otherwise an error that says what `what` must wait for.
  [[nodiscard]] Expected<> require_rest(const char* what);
  /// Changes the wishes, for the next cycle.
  void wish(const std::function<void(ServoWishes&)>& change);
  [[nodiscard]] ServoWishes wishes();
  void set_frames(const Frames& frames);
  void set_spindle(std::size_t spindle, double rpm);
  /// Moves queued and not yet done, those without motion included; homing by the drives is one.
  [[nodiscard]] std::size_t moves_left();
  [[nodiscard]] CycleState state();
  [[nodiscard]] CycleNow now();
  /// Puts a mechanism in force, or none: from now on moves go to it, and statuses of generations before are ignored.
  /// The old one is handed back; the servo thread must be through with it, or never have had it.
  std::shared_ptr<Mechanism> install(std::shared_ptr<Mechanism> next, std::uint64_t generation, bool keep_running);
  [[nodiscard]] std::shared_ptr<Mechanism> mechanism();

  /// Nothing while the planner has a turn that lasts: what happened meanwhile is told with the next.
  [[nodiscard]] std::optional<News> take_news();
  void on_queued(QueueListener listener);
  void report(Event event);

 private:
  MachineCycle cycle_;
  MoveEntry entry_{cycle_};
  Jogging jogging_{cycle_, entry_};
  Probing probing_{cycle_};
  Parking parking_{cycle_};
  Operating operating_{cycle_};
  Guarding guarding_{cycle_};
};

}  // namespace rmac::gateway
