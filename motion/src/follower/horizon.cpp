#include "rmac/motion/follower/horizon.hpp"

namespace rmac {

const char* to_string(HorizonLimit limit) noexcept {
  switch (limit) {
    case HorizonLimit::Stop:
      return "stop";
    case HorizonLimit::Enough:
      return "enough";
    case HorizonLimit::Planning:
      return "planning";
    case HorizonLimit::Queue:
      return "queue";
    case HorizonLimit::HeldBack:
      return "held_back";
    case HorizonLimit::Rest:
      return "rest";
    case HorizonLimit::Override:
      return "override";
  }
  return "unknown";
}

void HorizonWatch::step(std::int64_t cycle, const Horizon& planned) noexcept {
  const HorizonLimit before = now_.limit;
  now_ = planned;
  if (planned.limit != HorizonLimit::Planning) {
    limited_cycle_ = cycle;
  } else if (planned.s >= kPromisedHorizon_s) {
    now_.limit = HorizonLimit::Enough;
  } else if (before != HorizonLimit::Enough &&
             static_cast<double>(cycle - limited_cycle_) * period_s_ < kPromisedHorizon_s) {
    now_.limit = before;
  }
}

}  // namespace rmac
