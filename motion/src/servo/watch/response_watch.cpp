#include "servo/watch/response_watch.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {

namespace {

constexpr double kEffort = 0.25;     // of MaxEffort: less is what weight, blows and cuts may be
constexpr double kAgainstS = 0.005;  // of speeding up against the effort
constexpr int kAgainstCycles = 5;    // which are more than a word that came late explains
constexpr double kStandsS = 0.02;
constexpr double kStandsWay = 1;       // mm or degrees that it was to go meanwhile
constexpr double kStandsShare = 0.01;  // of what it was to go: less is standing

}  // namespace

void ResponseWatch::rest() noexcept {
  begun_ = false;
  last_way_ = gone_ = 0;
  against_ = 0;
  stands_ = 0;
}

void ResponseWatch::step(const ResponseSeen& seen, FaultSink& faults) noexcept {
  if (!begun_) {
    last_position_ = stood_at_ = seen.position;
    wanted_at_ = seen.position_set;
    begun_ = true;
    return;
  }
  const double way = seen.position - last_position_;
  last_position_ = seen.position;
  watch_direction(seen.effort, way, faults);
  watch_standing(seen, faults);
  last_way_ = way;
}

void ResponseWatch::watch_direction(double effort, double way, FaultSink& faults) noexcept {
  const bool pushed = joint_->max_effort > 0 && std::abs(effort) > kEffort * joint_->max_effort;
  const bool faster = way * effort < 0 && std::abs(way) > std::abs(last_way_) && way * last_way_ >= 0;
  if (!pushed || !faster) {
    against_ = 0;
    gone_ = 0;
    return;
  }
  ++against_;
  gone_ += way;
  const int most = std::max(kAgainstCycles, static_cast<int>(std::ceil(kAgainstS / period_s_)));
  if (against_ < most) return;
  faults.raise({ServoFault::Kind::WrongDirection, ServoFault::Part::Joint, index_, gone_, effort});
}

void ResponseWatch::watch_standing(const ResponseSeen& seen, FaultSink& faults) noexcept {
  const double wanted = seen.position_set - wanted_at_;
  if (std::abs(seen.position - stood_at_) > kStandsShare * std::abs(wanted)) {
    stands_ = 0;
    stood_at_ = seen.position;
    wanted_at_ = seen.position_set;
    return;
  }
  ++stands_;
  if (wanted == 0 || static_cast<double>(stands_) * period_s_ < kStandsS) return;
  if (std::abs(wanted) < kStandsWay && !seen.out_of_bound) return;
  faults.raise({ServoFault::Kind::StandsStill, ServoFault::Part::Joint, index_, wanted,
                static_cast<double>(stands_) * period_s_});
}

}  // namespace rmac
