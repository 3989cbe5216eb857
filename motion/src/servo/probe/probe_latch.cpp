#include "servo/probe/probe_latch.hpp"

namespace rmac {

bool ProbeLatch::read(const DriveFeedback& words, bool touching) noexcept {
  const bool stored = (words.touch_probe & touch_probe::latched(edge_)) != 0;
  const bool over = cycles_ > 0 && !touching;
  if (!words.online || !armed_ || over) {
    // A function of 0 makes it forget what it has latched; until then it cannot latch anew.
    armed_ = words.online && !over && !stored;
    cycles_ = 0;
    return false;
  }
  if (!stored || cycles_ == kTaken) return false;
  if (++cycles_ == kTaken) counts_ = words.latched_counts[static_cast<std::size_t>(edge_)];
  return cycles_ == 1;
}

}  // namespace rmac
