#include "gateway/events/move_ledger.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rmac/motion/move_name.hpp"

namespace rmac::gateway {
namespace {

Event make_event(Event::Kind kind, const CycleSample& sample, std::int64_t id, const std::string& name) {
  const char* what = kind == Event::Kind::MoveStarted ? "started" : "done";
  const std::string told = !name.empty() ? name : id == kPositioningMoveId ? "jog" : fmt::format("move {}", id);
  return {kind, sample.t_s, id, fmt::format("{} {}", told, what), sample.cycle, {}};
}

}  // namespace

void MoveLedger::read(const CycleSample& sample, const std::function<void(const Event&)>& tell) {
  const auto start = [&](Entry& entry) {
    if (!entry.started) tell(make_event(Event::Kind::MoveStarted, sample, entry.id, entry.name));
    entry.started = true;
  };
  while (!moves_.empty() && front_is_done(sample)) {
    start(moves_.front());
    const Entry& done = moves_.front();
    if (done.tells_done) tell(make_event(Event::Kind::MoveDone, sample, done.id, done.name));
    if (!moves_.front().still) ++done_;
    moves_.pop_front();
  }
  if (moves_.empty()) done_ = std::max(done_, sample.moves_done);
  if (sample.moving && !moves_.empty() && moves_.front().id == sample.move_id) start(moves_.front());
}

}  // namespace rmac::gateway
