#pragma once

#include <cstdint>

#include "gateway/cycle/output_marks.hpp"
#include "gateway/cycle/program_turn.hpp"
#include "gateway/cycle/states/cycle_sequencer.hpp"
#include "gateway/cycle/tool_change.hpp"
#include "gateway/queue/move_queue.hpp"

namespace rmac::gateway {

/// Takes the queue's steps that are no moves, one after the other, as their turns come. One thread at a time: the
/// caller locks.
class QueueSteps {
 public:
  /// All outlive it.
  struct Parts {
    MoveQueue& queue;
    ToolChange& tools;
    ProgramTurn& turn;
    CycleSequencer& sequencer;
    OutputMarks& marks;
  };
  enum class Came : std::uint8_t {
    Nothing,       ///< none whose turn has come, or it waits
    Done,          ///< one is done
    SpindlesTold,  ///< one is done, and motion is to wait for the spindles
    ToolMounted,   ///< one is done: another tool is in the spindle
    Held,          ///< the program is held now
    Failed,        ///< the cycle is faulted now
  };
  using Seen = ToolChange::Seen;

  explicit QueueSteps(Parts parts) : parts_(parts) {}

  /// Hands on what needs no rest, as far as it waits behind no other step: moves, and outputs behind moves.
  void hand_on();
  /// Takes the next step, if its turn has come. `cycle` is as it is seen when nothing is left to be handed on.
  [[nodiscard]] Came take(const CycleObservation& cycle, const Seen& seen);

 private:
  [[nodiscard]] bool may_take(const CycleObservation& cycle) const;
  [[nodiscard]] Came take(const InTurn& step, const Seen& seen);
  [[nodiscard]] Came take_of_tool_change(QueueStep& step, const Seen& seen);

  Parts parts_;
};

}  // namespace rmac::gateway
