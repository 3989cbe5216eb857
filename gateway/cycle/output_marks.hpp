#pragma once

#include <cstdint>
#include <deque>

#include "gateway/cycle/standing_wishes.hpp"
#include "gateway/queue/queue_step.hpp"
#include "gateway/servo/path_outputs.hpp"

namespace rmac::gateway {

/// Outputs that switch at places of the path that is planned: from when they are queued until the servo thread has
/// passed them, when they become wishes as any other. One thread at a time: the caller locks.
class OutputMarks {
 public:
  OutputMarks(StandingWishes& wishes, MarkRing& ahead) : wishes_(wishes), ahead_(ahead) {}

  /// `after_moves`: as `OutputMark` has it; not before that of the mark added last.
  void add(std::uint64_t after_moves, const SwitchOutputs& outputs);
  /// `passed`: the last one that the servo thread has passed. Hands on those that there is room for.
  void settle(std::uint64_t passed);
  /// Drops those that are not passed. Needs rest.
  void drop();

 private:
  void hand_on();

  StandingWishes& wishes_;
  MarkRing& ahead_;
  std::deque<OutputMark> marks_;  ///< not passed, as far as is known
  std::size_t handed_ = 0;        ///< of them
  std::uint64_t last_ = 0;        ///< number of the one added last
};

}  // namespace rmac::gateway
