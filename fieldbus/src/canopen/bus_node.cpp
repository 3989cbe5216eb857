#include "canopen/bus_node.hpp"

namespace rmac::fieldbus::canopen {

void BusNode::start(std::chrono::nanoseconds now) noexcept {
  up = false;
  silent_with_all.store(false, std::memory_order_relaxed);
  trouble.forget();
  record.forget();
  boot.forget_identity();
  boot.begin(now);
}

bool BusNode::take(const CanFrame& frame, std::chrono::nanoseconds now, std::chrono::nanoseconds since_start,
                   CanopenCounters& counters) noexcept {
  const std::uint8_t id = boot.node();
  if (frame.id == kEmergencyId + id) {
    if (frame.size < 2) return false;
    record.emergency(frame, since_start);
    error_code = word_at(frame.data.data());
    if (error_code != 0) ++counters.emergencies;
    return false;
  }
  const bool was_up = up;
  if (frame.id == kHeartbeatId + id && frame.size == 1) {
    const NmtState said = heartbeat_state(frame);
    if (guarded() && said != NmtState::BootUp && !guard.take(frame)) return false;
    heard = now;
    if (up && said != NmtState::Operational && said != NmtState::BootUp) {
      lose({.kind = BootProblem::Kind::LeftOperational,
            .object = {},
            .expected = error_code,
            .found = static_cast<std::uint32_t>(said)},
           now, counters);
    }
  }
  if (frame.id == kSdoAnswerId + id) record.sdo_answer(frame);
  boot.receive(frame, now);
  if (up && frame.id == kSdoAnswerId + id) positions.receive(frame, now);
  if (up && boot.state() != NodeBoot::State::Operational) {
    lose(boot.problem(), now, counters);
    // A boot-up message: it has started anew by itself, and waits for what it is to be told.
    if (trouble.problem().kind == BootProblem::Kind::Restarted) boot.receive(frame, now);
  }
  return was_up && !up;
}

bool BusNode::watch(std::chrono::nanoseconds now, std::chrono::nanoseconds patience,
                    CanopenCounters& counters) noexcept {
  const bool was_up = up;
  if (up && (now - heard > patience || boot.state() == NodeBoot::State::Failed)) {
    lose(boot.problem(), now, counters);
  }
  const bool lost = was_up && !up;
  if (!up && boot.state() == NodeBoot::State::Operational) {
    up = true;
    trouble.forget();
    heard = now;
    error_code = boot.error_code();
    ++counters.nodes_recovered;
    record.recovered();
  }
  if (boot.state() == NodeBoot::State::Failed) {
    trouble.note(boot.problem());
    boot.begin(now);
  }
  record.state(state());
  return lost;
}

void BusNode::lose(const BootProblem& why, std::chrono::nanoseconds now, CanopenCounters& counters) noexcept {
  ++counters.nodes_lost;
  record.lost();
  if (shows_two(why.kind)) ++counters.duplicates;
  trouble.note(why);
  up = false;
  positions.abandon();
  boot.begin(now);
}

}  // namespace rmac::fieldbus::canopen
