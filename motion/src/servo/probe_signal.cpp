#include "servo/probe_signal.hpp"

#include <algorithm>
#include <bit>

namespace rmac {

void ProbeSignal::read(const ServoProbe& probe, const DigitalIoInterface* io, std::uint64_t inputs,
                       double period_s) noexcept {
  report_.ready =
      io != nullptr && probe.touch_input != 0 && (probe.ready_input == 0 || (inputs & probe.ready_input) != 0);
  report_.hit_before_s = 0;
  if (io == nullptr || probe.touch_input == 0) return;
  if ((inputs & probe.touch_input) != 0) {
    open_s_ = 0;
    if (report_.touching) return;
    report_.touching = true;
    ++report_.hits;
    // A contact that closed before the last cycle looked would have been seen then.
    const auto bit = static_cast<std::size_t>(std::countr_zero(probe.touch_input));
    report_.hit_before_s = std::clamp(io->on_for_s(bit), 0.0, 2 * period_s);
  } else if (report_.touching) {
    open_s_ += period_s;
    if (open_s_ >= probe.settle_s) report_.touching = false;
  }
}

}  // namespace rmac
