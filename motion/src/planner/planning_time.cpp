#include "planner/planning_time.hpp"

#include <algorithm>
#include <cmath>

#include "rmac/motion/planner.hpp"

namespace rmac {
namespace {

constexpr double kLongest = 64;
/// Of the longest time seen, this much is still believed after each shorter one.
constexpr double kPartRemembered = 0.9;

}  // namespace

void PlanningTime::learn(const ServoProgress& progress) noexcept {
  if (began_ >= 0) {
    cycles_ = std::max(kPartRemembered * cycles_, static_cast<double>(progress.cycle - began_ - 1));
    began_ = -1;
  }
  if (progress.last_refused != last_refused_) {
    last_refused_ = progress.last_refused;
    if (!in_haste_) cycles_ = 2 * cycles_ + 1;
  }
  cycles_ = std::min(cycles_, kLongest);
}

std::int64_t PlanningTime::lead() const noexcept {
  return kShortestLead + static_cast<std::int64_t>(std::ceil(cycles_));
}

}  // namespace rmac
