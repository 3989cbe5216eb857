#include "gateway/events/move_ledger.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rmac/motion/move_name.hpp"

namespace rmac::gateway {
namespace {

/// The event's message: "move 7 started", "calls in turn 5 (Laser on) done".
std::string text_of(std::int64_t id, const std::string& name, const char* what) {
  const std::string told = !name.empty() ? name : id == kPositioningMoveId ? "jog" : fmt::format("move {}", id);
  return fmt::format("{} {}", told, what);
}

}  // namespace

void MoveLedger::start(Entry& entry, const Moment& at, const Tell& tell) {
  if (!entry.started) {
    tell({Event::Kind::MoveStarted, at.t_s, entry.id, text_of(entry.id, entry.name, "started"), at.cycle, {}});
  }
  entry.started = true;
}

void MoveLedger::end_front(const Moment& at, const Tell& tell) {
  Entry& front = moves_.front();
  start(front, at, tell);
  if (front.tells_done) {
    tell({Event::Kind::MoveDone, at.t_s, front.id, text_of(front.id, front.name, "done"), at.cycle, {}});
  }
  if (!front.still) ++done_;
  moves_.pop_front();
}

void MoveLedger::read(const CycleSample& sample, const Tell& tell) {
  const Moment now{sample.t_s, sample.cycle};
  while (!moves_.empty() && front_is_done(sample)) end_front(now, tell);
  if (moves_.empty()) done_ = std::max(done_, sample.moves_done);
  if (sample.moving && !moves_.empty() && moves_.front().id == sample.move_id) start(moves_.front(), now, tell);
}

void MoveLedger::tell_before(const Event& event, const Tell& tell) {
  while (!moves_.empty() && moves_.front().still && moves_.front().order < event.order) {
    end_front({event.t_s, event.cycle}, tell);
  }
}

}  // namespace rmac::gateway
