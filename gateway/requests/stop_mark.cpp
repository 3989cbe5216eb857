#include "gateway/requests/stop_mark.hpp"

#include <algorithm>

namespace rmac::gateway {

void StopMark::set(Effect stop, const std::string& name, std::uint64_t position) {
  if (stop != Effect::Holds && stop != Effect::Stops) return;
  last_stop_ = name;
  no_starts_before_ = std::max(no_starts_before_, position);
  if (stop == Effect::Stops) no_moves_before_ = std::max(no_moves_before_, position);
}

const std::string* StopMark::overtaker(Effect effect, std::uint64_t position) const noexcept {
  const bool overtaken = (effect == Effect::Starts && position < no_starts_before_) ||
                         (effect == Effect::Queues && position < no_moves_before_);
  return overtaken ? &last_stop_ : nullptr;
}

}  // namespace rmac::gateway
