#include "servo/watch/oscillation_watch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rmac {

namespace {

constexpr double kLeastSwing = 0.2;       // of MaxEffort, peak to peak: less does no harm, and cutting does that
constexpr double kCurrentLoopS = 0.0002;  // by which a torque comes after its command: of a current loop of 800 Hz
constexpr double kLeastTimeS = 0.03;      // over which a quick swing is looked at, for it is seen by samples
constexpr double kSlowestTurnS = 0.06;    // what turns round less often is left to the following error
constexpr double kLasts = 0.8;            // a swing with a damping of 2.4 % falls to so much in a period and a half
// Below, a loop with an integral part gives energy to what a slow force from outside moves, too: it has to grow.
constexpr double kSlowHz = 40, kGrows = 1.3;
// Where a loop gives back no more than friction takes, the work is next to nothing, and half a cycle by which effort
// and way are apart decides on its sign. What holds back a force from outside is far below.
constexpr double kResists = 0.12;
constexpr int kQuicker = 8;        // from turn to turn: a quick swing that is seen by samples varies by three
constexpr double kKept = 0.85;     // of the work until then, at each turn
constexpr double kRises = 1.05;    // since the first turns: it grows, if slowly
constexpr double kPathTurn = 0.1;  // of the largest acceleration that the path asks for
constexpr double kLeastAcceleration = 1e-3;

}  // namespace

/// What acted while the joint went its last way: half a cycle aside, or what a current loop takes, turns the sign of
/// the work at 175 Hz and 1 kHz. A torque that drives measure is that at the end of the way. What was commanded a cycle
/// ago acted in that cycle, at the earliest. Returned is the latest of them.
double OscillationWatch::take_effort(const OscillationSeen& seen) noexcept {
  std::rotate(efforts_.begin(), efforts_.end() - 1, efforts_.end());
  efforts_[0] = seen.effort;
  const auto acts = seen.effort_measured ? 0U : static_cast<std::size_t>(std::max(1, seen.answer_delay));
  const double before = seen.effort_measured ? 0.5 : std::min(1.0, kCurrentLoopS / period_s_);
  acted_ = std::lerp(efforts_[acts], efforts_[acts + 1], before);
  return efforts_[acts];
}

void OscillationWatch::begin() noexcept {
  turned_ = path_turned_ = 0;
  most_acceleration_ = 0;
  cycles_ = last_turn_.at = 0;
  swings_.first = 0;
  changes_ = {};
  path_turns_.restart();
}

void OscillationWatch::rest() noexcept {
  begin();
  turns_.restart();
  efforts_.fill(0);
  begun_ = false;
  chain_ = path_chain_ = 0;
}

void OscillationWatch::add_turn() noexcept {
  // The first turn may be where it left its rest, and then the swing to the second is half of one.
  constexpr int kPassed = 2;
  if (turned_ >= kPassed) {
    const double swing = turns_.swing();
    swings_.latest[static_cast<std::size_t>(turned_ % kCompared)] = swing;
    if (turned_ < kPassed + kCompared) swings_.first += swing;
  }
  ++turned_;
  ++chain_;
  last_turn_.at = cycles_;
  // What began it, a blow or another gain, is in the first of them.
  for (double* const sum : {&changes_.work, &changes_.efforts, &changes_.ways}) *sum *= kKept;
}

double OscillationWatch::hz() const noexcept {
  return (turned_ - 1) / (2 * period_s_ * static_cast<double>(last_turn_.at - 1));
}

double OscillationWatch::latest_swings() const noexcept {
  return std::accumulate(swings_.latest.begin(), swings_.latest.end(), 0.0);
}

bool OscillationWatch::lasts() const noexcept {
  if (turned_ < kTurns + 2 * path_turned_) return false;
  if (static_cast<double>(cycles_) * period_s_ < kLeastTimeS) return false;
  // Over half of all that it may be is enough, whoever drives it.
  if (latest_swings() / kCompared > joint_->max_effort) return true;
  return changes_.work > -kResists * std::sqrt(changes_.efforts * changes_.ways) &&
         latest_swings() >= (hz() < kSlowHz ? kGrows : kLasts) * swings_.first;
}

void OscillationWatch::step(const OscillationSeen& seen, FaultSink& faults) noexcept {
  const double way = begun_ ? seen.position - last_position_ : 0;
  const double before = acted_;
  const double effort = take_effort(seen);
  const double effort_change = begun_ ? acted_ - before : 0, way_change = begun_ ? way - last_way_ : 0;
  last_position_ = seen.position;
  last_way_ = way;
  begun_ = true;
  const bool turns = turns_.step(effort, kLeastSwing * joint_->max_effort);
  if (turned_ == 0 && !turns) return;

  ++cycles_;
  changes_.work += effort_change * way_change;
  changes_.efforts += effort_change * effort_change;
  changes_.ways += way_change * way_change;
  most_acceleration_ = std::max(most_acceleration_, std::abs(seen.acceleration_set));
  if (path_turns_.step(seen.acceleration_set, std::max(kPathTurn * most_acceleration_, kLeastAcceleration))) {
    ++path_turned_;
    ++path_chain_;
  }
  if (turns) {
    // Much quicker all at once is another swing, as a word that comes twice leaves one of some cycles.
    const std::int64_t gap = cycles_ - last_turn_.at;
    if (turned_ > 1 && kQuicker * gap < last_turn_.gap) {
      begin();
      ++cycles_;
    }
    last_turn_.gap = gap;
    add_turn();
  }
  if (static_cast<double>(cycles_ - last_turn_.at) * period_s_ > kSlowestTurnS) {
    chain_ = path_chain_ = 0;
    return begin();
  }
  if (!turns) return;
  if (lasts()) return raise(faults);
  // What was large at first, and then goes on smaller, is looked at anew; what grows, however slowly, is not forgotten.
  const bool seen_long = static_cast<double>(cycles_) * period_s_ >= kLeastTimeS;
  const bool grows = latest_swings() > kRises * swings_.first;
  if (seen_long && !grows && turned_ > kTurns + 2 * path_turned_ + kCompared) begin();
}

void OscillationWatch::raise(FaultSink& faults) const noexcept {
  faults.raise(
      {ServoFault::Kind::Oscillation, ServoFault::Part::Joint, index_, hz(), latest_swings() / (2 * kCompared)});
}

}  // namespace rmac
