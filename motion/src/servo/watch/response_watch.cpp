#include "servo/watch/response_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "servo/joints/cycles_of.hpp"

namespace rmac {

namespace {

constexpr double kEffort = 0.25;     // of MaxEffort: less is what blows and cuts may be
constexpr double kAwayShare = 0.5;   // of the way against the effort by which it leaves its setpoint: weight has none
constexpr double kAgainstS = 0.005;  // of speeding up against the effort
constexpr int kAgainstCycles = 5;    // which are more than a word that came late explains
constexpr double kLeastWayShare = 0.02;  // of MaxFollowingError: a load lets a sound joint creep so far
constexpr double kHeldShare = 0.9;       // of what it gained in the first half: less, and the effort holds it

}  // namespace

void ResponseWatch::rest(std::optional<double> position) noexcept {
  begun_ = false;
  last_way_ = 0;
  cycles_ = 0;
  forget_direction(0);
  standing_.rest(position);
  lately_.restart();
  longer_.restart();
  back_ = forth_ = 0;
}

void ResponseWatch::step(const ResponseSeen& seen, FaultSink& faults) noexcept {
  if (!begun_) {
    last_position_ = seen.position;
    error_before_ = seen.position_set - seen.position;
    begun_ = true;
    lately_.step(seen);
    longer_.step(seen);
    standing_.step(seen, faults);
    return;
  }
  lately_.step(seen);
  longer_.step(seen);
  // Force control goes where the part lets it: down behind what it lets down, back where less is wanted, or nowhere.
  const bool looks = joint_->method != ControlMethod::Force;
  if (looks) standing_.step(seen, faults);
  ++cycles_;
  if (!seen.answered) return;
  // Where answers were missing, the way is that of several cycles.
  const double way = (seen.position - last_position_) / std::exchange(cycles_, 0);
  if (looks) watch_direction(seen, way, faults);
  last_position_ = seen.position;
  last_way_ = way;
}

void ResponseWatch::forget_direction(double error) noexcept {
  against_ = 0;
  gone_ = first_gain_ = last_gain_ = 0;
  error_before_ = error;
}

// What ran into something comes back from it, faster and faster, and no faster than it came.
bool ResponseWatch::rebounds(double way) noexcept {
  back_ = std::max(fades_ * back_, -way);
  forth_ = std::max(fades_ * forth_, way);
  return std::abs(way) <= (way > 0 ? back_ : forth_);
}

// A head that is let down speeds up against its effort, too, and goes where it is to go.
void ResponseWatch::watch_direction(const ResponseSeen& seen, double way, FaultSink& faults) noexcept {
  const double error = seen.position_set - seen.position;
  const bool pushed = joint_->max_effort > 0 && std::abs(seen.effort) > kEffort * joint_->max_effort;
  const bool came = rebounds(way);
  const bool faster =
      !came && !seen.swings && way * seen.effort < 0 && std::abs(way) > std::abs(last_way_) && way * last_way_ >= 0;
  if (!pushed || !faster) {
    forget_direction(error);
    return;
  }
  const auto most = static_cast<int>(cycles_of(kAgainstS, period_s_, kAgainstCycles));
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

void ResponseWatch::name_error(double error, FaultSink& faults) const noexcept {
  const double bound = joint_->max_following_error;
  const auto raise = [&](ServoFault::Kind kind, double value, double of) {
    faults.raise({kind, ServoFault::Part::Joint, index_, value, of});
  };
  if (joint_->method == ControlMethod::Force) return raise(ServoFault::Kind::FollowingError, error, bound);
  if (standing_.froze()) return standing_.raise_frozen(faults);
  for (const ErrorHistory* const history : {&lately_, &longer_}) {
    const ErrorHistory::Cause cause = history->cause(bound);
    if (cause == ErrorHistory::Cause::StandsStill)
      return raise(ServoFault::Kind::StandsStill, history->wanted(bound), history->duration_s(bound));
    if (cause == ErrorHistory::Cause::WrongDirection)
      return raise(ServoFault::Kind::WrongDirection, history->gone(), history->effort());
  }
  raise(ServoFault::Kind::FollowingError, error, bound);
}

}  // namespace rmac
