#pragma once

#include <cstddef>
#include <deque>
#include <variant>
#include <vector>

#include "gateway/queue/queue_step.hpp"
#include "rmac/motion/path_builder.hpp"

namespace rmac::gateway {

/// A move, a change to this tool, or what is done in its turn between moves.
using StepAsSent = std::variant<Move, int, InTurn>;

/// What a client queued, and from where it begins: enough to queue it again, in another part frame too.
struct ProgramStep {
  StepAsSent what;
  ToolPose start;  ///< part frame
  std::vector<double> start_joints;
  double from_mm = 0;      ///< a move that was begun before goes on from here: what lies before is done
  bool way_back = false;   ///< the machine's own way to where a program goes on, no step of that
  std::size_t counts = 1;  ///< moves of the queue that it is
};

/// As it is queued behind what `builder` built last.
[[nodiscard]] ProgramStep step_at(const PathBuilder& builder, StepAsSent what);

/// The steps that are queued and not done, in order.
class ProgramLog {
 public:
  /// `left`: moves in the queue, this step's included.
  void add(ProgramStep step, std::size_t left);
  /// Forgets the steps before the last `left` moves: they are done.
  void keep(std::size_t left);
  void clear() noexcept;
  [[nodiscard]] std::deque<ProgramStep> take() noexcept;

 private:
  std::deque<ProgramStep> steps_;
  std::size_t moves_ = 0;
};

}  // namespace rmac::gateway
