#pragma once

#include "rmac/motion/interruption.hpp"

namespace rmac {

/// What the planner's step that runs on this thread gives way to; null outside of a step, and where nobody may
/// interrupt it. Of the thread, because long computations lie deep below the step: laws of windows, and of paths still
/// being shaped.
inline thread_local const Interruption* step_gives_way_to = nullptr;

/// Whether the computation under way is to end early.
[[nodiscard]] inline bool gives_way() noexcept {
  return step_gives_way_to != nullptr && step_gives_way_to->wanted();
}

/// For as long as it lives, this thread's step gives way.
class GivesWay {
 public:
  explicit GivesWay(const Interruption* to) noexcept { step_gives_way_to = to; }
  GivesWay(const GivesWay&) = delete;
  GivesWay& operator=(const GivesWay&) = delete;
  ~GivesWay() { step_gives_way_to = nullptr; }
};

}  // namespace rmac
