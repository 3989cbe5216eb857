#include "gateway/queue/move_queue.hpp"

#include <algorithm>
#include <utility>

namespace rmac::gateway {
namespace {

bool changes_tool(const QueueStep& step) {
  return std::holds_alternative<MountTool>(step);
}

bool counts(const QueueStep& step) {
  return std::holds_alternative<QueuedPath>(step) || std::holds_alternative<InTurn>(step) || changes_tool(step);
}

/// The listener counts by moves what is done.
void tell_of(const QueueStep& step, const QueueListener& listener) {
  Move move;
  if (const auto* path = std::get_if<QueuedPath>(&step)) {
    move.id = path->move_id;
    listener(move, path->segments);
  } else if (const auto* turn = std::get_if<InTurn>(&step)) {
    move.id = turn->move_id;
    move.geometry = JointTargetGeometry{};
    listener(move, {});
  }
}

}  // namespace

void MoveQueue::install(Planner* planner) noexcept {
  if (planner != planner_) merged_before_ = cleaned().merged;
  planner_ = planner;
  begins_anew_ = true;
  done_before_ = 0;
  moves_added_ = 0;
}

void MoveQueue::begin_here(std::uint64_t moves_done) {
  // After a retrace the path ends elsewhere than where the machine stands.
  planner_->clear();
  begins_anew_ = false;
  done_before_ = moves_done;
  moves_added_ = 0;
  still_moves_.clear();
}

bool MoveQueue::add(BuiltMove built) {
  const Move& move = std::get<Move>(built.as_sent.what);
  const bool moves = !built.segments.empty();
  if (listener_) listener_(move, built.segments);
  QueuedPath path{move.id, built.part, std::move(built.segments)};
  if (steps_.empty()) {
    hand_on(std::move(path));
  } else {
    steps_.emplace_back(std::move(path));
  }
  last_added_ = std::chrono::steady_clock::now();
  program_.add(std::move(built.as_sent), left());
  return moves;
}

void MoveQueue::add_steps(std::vector<QueueStep> steps, ProgramStep as_sent) {
  const std::size_t left_before = left();
  for (QueueStep& step : steps) {
    if (listener_) tell_of(step, listener_);
    steps_.push_back(std::move(step));
  }
  const std::size_t left_now = left();
  as_sent.counts = left_now - left_before;
  program_.add(std::move(as_sent), left_now);
}

void MoveQueue::plan_next_step() {
  hand_on(std::move(std::get<QueuedPath>(steps_.front())));
  steps_.pop_front();
}

void MoveQueue::lay_next_step(std::string name) {
  still_moves_.push_back(moves_added_);
  news_.tell({QueueChange::Kind::Still, std::get<InTurn>(steps_.front()).move_id, 0, {}, std::move(name)});
  steps_.pop_front();
}

void MoveQueue::hand_on(QueuedPath path) {
  const bool moves = !path.segments.empty();
  planner_->add(std::move(path.segments));
  if (moves) {
    ++moves_added_;
  } else {
    ++without_motion_;
    still_moves_.push_back(moves_added_);
  }
  news_.tell({moves ? QueueChange::Kind::Added : QueueChange::Kind::Still, path.move_id, 0, path.part, {}});
}

Cleaned MoveQueue::cleaned() const noexcept {
  return {without_motion_, merged_before_ + (planner_ == nullptr ? 0 : planner_->lines_merged())};
}

std::size_t MoveQueue::waiting() const {
  return static_cast<std::size_t>(std::ranges::count_if(steps_, counts));
}

std::size_t MoveQueue::left() {
  if (planner_ == nullptr) return 0;
  // A move without motion is done when those before it are.
  while (!still_moves_.empty() && still_moves_.front() + planned() <= moves_added_) still_moves_.pop_front();
  return planned() + still_moves_.size() + waiting();
}

std::deque<ProgramStep> MoveQueue::take_program() {
  program_.keep(left());
  return program_.take();
}

bool MoveQueue::clear(std::int64_t cycle, std::uint64_t moves_done) {
  planner_->clear();
  begins_anew_ = true;
  done_before_ = moves_done;
  news_.tell({QueueChange::Kind::Cleared, 0, cycle, {}, {}});
  return forget();
}

bool MoveQueue::forget() {
  moves_added_ = 0;
  still_moves_.clear();
  program_.clear();
  const bool changed_tool = std::ranges::any_of(steps_, changes_tool);
  steps_.clear();
  return changed_tool;
}

}  // namespace rmac::gateway
