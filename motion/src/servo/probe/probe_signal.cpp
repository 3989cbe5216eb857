#include "servo/probe/probe_signal.hpp"

#include <algorithm>

namespace rmac {

void ProbeSignal::read(const ServoProbe& probe, std::uint64_t inputs, double on_for_s, bool latched,
                       double period_s) noexcept {
  report_.ready = probe.touch_input != 0 && (probe.ready_input == 0 || (inputs & probe.ready_input) != 0);
  report_.hit_before_s = 0;
  if (probe.touch_input == 0) return;
  const bool closed = (inputs & probe.touch_input) != 0;
  if (closed || (latched && !report_.touching)) {
    open_s_ = 0;
    if (report_.touching) return;
    report_.touching = true;
    ++report_.hits;
    // A contact that closed before the last cycle looked would have been seen then.
    if (closed) report_.hit_before_s = std::clamp(on_for_s, 0.0, 2 * period_s);
  } else if (report_.touching) {
    open_s_ += period_s;
    if (open_s_ >= probe.settle_s) report_.touching = false;
  }
}

}  // namespace rmac
