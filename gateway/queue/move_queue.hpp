#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <vector>

#include "gateway/queue/built_move.hpp"
#include "gateway/queue/cycle_news.hpp"
#include "gateway/queue/program_log.hpp"
#include "gateway/queue/queue_step.hpp"
#include "gateway/state/cycle_state.hpp"
#include "gateway/state/queue_listener.hpp"
#include "rmac/motion/planner.hpp"

namespace rmac::gateway {

/// What is queued and not done: moves that the planner has, then steps that wait for those to be done (a tool change, a
/// dwell, and whatever is behind them), and beside both what clients sent. One thread at a time: the caller locks.
class MoveQueue {
 public:
  explicit MoveQueue(CycleNews& news) : news_(news) {}

  /// From now on moves go to this planner, or nowhere. What the queue held is forgotten first (`forget`).
  void install(Planner* planner) noexcept;
  /// Hears of each move as it is queued.
  void on_queued(QueueListener listener) { listener_ = std::move(listener); }

  /// The next move begins where the machine stands, not where the queue ended.
  [[nodiscard]] bool begins_anew() const noexcept { return begins_anew_; }
  void begin_anew() noexcept { begins_anew_ = true; }
  /// The next move begins where the path ends now. Needs a planner, at rest. Here and below, `moves_done` is what the
  /// servo thread counts.
  void begin_here(std::uint64_t moves_done);

  /// Adds what was built to follow the queue. True when it has motion. Needs a planner.
  bool add(BuiltMove built);
  /// Adds what is to be done between moves: moves that are added from now on wait behind it.
  void add_steps(std::vector<QueueStep> steps, ProgramStep as_sent);

  /// Steps that wait, the next one first.
  [[nodiscard]] const std::deque<QueueStep>& steps() const noexcept { return steps_; }
  [[nodiscard]] QueueStep& next_step() { return steps_.front(); }
  void step_done() { steps_.pop_front(); }
  /// The next step is a move, and its turn has come: hands it to the planner.
  void plan_next_step();

  /// The next step needs no rest, and is done where the path that is planned ends: it is told as a move without motion.
  void lay_next_step(std::string name);
  /// What the servo thread counts when all that is planned is done.
  [[nodiscard]] std::uint64_t done_at_end() const noexcept { return done_before_ + moves_added_; }

  /// Moves that the planner has not done.
  [[nodiscard]] std::size_t planned() const noexcept { return planner_ == nullptr ? 0 : planner_->moves_left(); }
  /// Moves, tool changes and what is done in its turn, all that wait behind a step and it.
  [[nodiscard]] std::size_t waiting() const;
  /// All of them, moves without motion too. A measurement counts as the moves that it is made of.
  [[nodiscard]] std::size_t left();
  /// What was queued and needed no curve of its own, since the daemon began.
  [[nodiscard]] Cleaned cleaned() const noexcept;
  /// Real time: when a move was added last.
  [[nodiscard]] std::chrono::steady_clock::time_point last_added() const noexcept { return last_added_; }

  /// The steps that are queued and not done, as clients sent them; afterwards they are forgotten here.
  [[nodiscard]] std::deque<ProgramStep> take_program();
  /// Drops what is queued, at rest, and tells so. True when a tool change was among it.
  bool clear(std::int64_t cycle, std::uint64_t moves_done);
  /// The planner has nothing any more: forgets what was queued. True when a tool change was among it.
  bool forget();

 private:
  void hand_on(QueuedPath path);

  CycleNews& news_;
  QueueListener listener_;
  Planner* planner_ = nullptr;
  bool begins_anew_ = true;
  std::uint64_t done_before_ = 0;          ///< moves, when the queue was emptied last
  std::uint64_t moves_added_ = 0;          ///< with motion, since the queue was emptied last
  std::uint64_t without_motion_ = 0;       ///< since the daemon began
  std::uint64_t merged_before_ = 0;        ///< lines, by the planners before
  std::deque<std::uint64_t> still_moves_;  ///< without motion, each by the number of those before it
  std::deque<QueueStep> steps_;            ///< the first is no path: it waits for what is planned to be done
  ProgramLog program_;
  std::chrono::steady_clock::time_point last_added_{};
};

}  // namespace rmac::gateway
