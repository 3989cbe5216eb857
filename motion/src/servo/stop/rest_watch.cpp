#include "servo/stop/rest_watch.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {

namespace {

// A drive stands when it has moved by less than this for so long: 1.5 rpm, and some counts of a coarse encoder.
constexpr double kStillS = 0.02;
constexpr double kStillTurns = 5e-4;
constexpr std::int64_t kStillCounts = 2;
constexpr double kStillRpm = 1;
// A drive that has not come to rest by itself by now does not brake.
constexpr double kQuickStopS = 10;

}  // namespace

void RestWatch::begin() noexcept {
  rest_.fill({});
  cycles_ = 0;
}

void RestWatch::look_at_counts(std::size_t drive, std::int64_t counts, double counts_per_turn) noexcept {
  const std::int64_t tolerance = std::max<std::int64_t>(kStillCounts, std::llround(kStillTurns * counts_per_turn));
  Rest& rest = rest_[drive];
  const bool stays = std::abs(counts - rest.mark) <= tolerance;
  if (!stays || cycles_ == 1) rest.mark = counts;
  look(rest, stays);
}

// Its mark is whether it turns.
void RestWatch::look_at_speed(std::size_t drive, double rpm) noexcept {
  const std::int64_t turns = std::abs(rpm) <= kStillRpm ? 0 : 1;
  Rest& rest = rest_[drive];
  const bool stays = turns == 0 && rest.mark == 0;
  rest.mark = turns;
  look(rest, stays);
}

void RestWatch::look(Rest& drive, bool stays) noexcept {
  drive.still = stays && cycles_ > 1 ? drive.still + 1 : 0;
  const bool too_long = static_cast<double>(cycles_) * period_s_ > kQuickStopS;
  drive.reached = drive.reached || too_long || static_cast<double>(drive.still) * period_s_ >= kStillS;
}

bool RestWatch::all_reached() const noexcept {
  return std::all_of(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(drives_),
                     [](const Rest& drive) { return drive.reached; });
}

}  // namespace rmac
