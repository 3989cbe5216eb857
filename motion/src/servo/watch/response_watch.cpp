#include "servo/watch/response_watch.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {

namespace {

constexpr double kEffort = 0.25;     // of MaxEffort: less is what blows and cuts may be
constexpr double kAwayShare = 0.5;   // of the way against the effort by which it leaves its setpoint: weight has none
constexpr double kAgainstS = 0.005;  // of speeding up against the effort
constexpr int kAgainstCycles = 5;    // which are more than a word that came late explains
constexpr double kLeastWayShare = 0.02;  // of MaxFollowingError: a load lets a sound joint creep so far
constexpr double kHeldShare = 0.9;       // of what it gained in the first half: less, and the effort holds it
constexpr double kStandsS = 0.02;
constexpr int kStandsCycles = 5;       // which are more than answers that come late, or once not, explain
constexpr double kStandsWay = 1;       // mm or degrees that it was to go meanwhile
constexpr double kStandsShare = 0.01;  // of what it was to go: less is standing

}  // namespace

void ResponseWatch::rest() noexcept {
  begun_ = false;
  last_way_ = 0;
  forget_direction(0);
  stands_ = 0;
}

void ResponseWatch::step(const ResponseSeen& seen, FaultSink& faults) noexcept {
  if (!begun_) {
    last_position_ = stood_at_ = seen.position;
    error_before_ = seen.position_set - seen.position;
    wanted_at_ = seen.position_set;
    begun_ = true;
    return;
  }
  const double way = seen.position - last_position_;
  last_position_ = seen.position;
  // Force control goes where the part lets it: down behind what it lets down, back where less is wanted, or nowhere.
  if (joint_->method != ControlMethod::Force) {
    watch_direction(seen, way, faults);
    watch_standing(seen, faults);
  }
  last_way_ = way;
}

void ResponseWatch::forget_direction(double error) noexcept {
  against_ = 0;
  gone_ = first_gain_ = last_gain_ = 0;
  error_before_ = error;
}

// A head that is let down speeds up against its effort, too, and goes where it is to go.
void ResponseWatch::watch_direction(const ResponseSeen& seen, double way, FaultSink& faults) noexcept {
  const double error = seen.position_set - seen.position;
  const bool pushed = joint_->max_effort > 0 && std::abs(seen.effort) > kEffort * joint_->max_effort;
  const bool faster = way * seen.effort < 0 && std::abs(way) > std::abs(last_way_) && way * last_way_ >= 0;
  if (!pushed || !faster) {
    forget_direction(error);
    return;
  }
  const int most = std::max(kAgainstCycles, static_cast<int>(std::ceil(kAgainstS / period_s_)));
  const int half = (most - 1) / 2;
  if (against_ > 0) (against_ <= half ? first_gain_ : last_gain_) += std::abs(way) - std::abs(last_way_);
  ++against_;
  gone_ += way;
  if (against_ < most || std::abs(gone_) < kLeastWayShare * joint_->max_following_error) return;
  const double away =
      std::min((error_before_ - error) * (gone_ < 0 ? -1 : 1), std::abs(error) - std::abs(error_before_));
  if (away < kAwayShare * std::abs(gone_)) return;
  if (last_gain_ / (against_ - 1 - half) < kHeldShare * first_gain_ / half) return;
  faults.raise({ServoFault::Kind::WrongDirection, ServoFault::Part::Joint, index_, gone_, seen.effort});
}

void ResponseWatch::watch_standing(const ResponseSeen& seen, FaultSink& faults) noexcept {
  const double wanted = seen.position_set - wanted_at_;
  if (std::abs(seen.position - stood_at_) > kStandsShare * std::abs(wanted)) {
    stands_ = 0;
    stood_at_ = seen.position;
    wanted_at_ = seen.position_set;
    return;
  }
  if (wanted == 0) {
    stands_ = 0;  // as it is to
    return;
  }
  ++stands_;
  if (stands_ < kStandsCycles || static_cast<double>(stands_) * period_s_ < kStandsS) return;
  if (std::abs(wanted) < kStandsWay && !seen.out_of_bound) return;
  faults.raise({ServoFault::Kind::StandsStill, ServoFault::Part::Joint, index_, wanted,
                static_cast<double>(stands_) * period_s_});
}

}  // namespace rmac
