#include "gateway/cycle/probing.hpp"

#include <utility>

namespace rmac::gateway {

bool Probing::waits_for_steps() {
  const GatewayTurn turn(cycle_.lock);
  return !cycle_.queue.steps().empty();
}

Expected<> Probing::add(const std::optional<Move>& approach, const Move& search) {
  if (waits_for_steps()) {
    return failure(MinorCode::CommandQueueFull,
                   "a point is measured with the tool that is in the spindle, and from rest, and a tool change, a "
                   "dwell, a stop or a wait for an input is queued; send it when that is done");
  }
  std::vector<PartOfMove> parts;
  if (approach) parts.push_back({&*approach, {.first = true, .last = false}});
  parts.push_back({&search, {.first = !approach, .last = false}});
  auto built = build_moves(cycle_.builder(), parts);
  if (!built) return tl::unexpected(built.error());
  const GatewayTurn turn(cycle_.lock);
  const auto moving = cycle_.add(std::move(*built));
  if (!moving) return tl::unexpected(moving.error());
  cycle_.probe.measurement().begin(*moving);
  return {};
}

Expected<bool> Probing::ready_for_retract() {
  const GatewayTurn turn(cycle_.lock);
  cycle_.notice_fault();
  if (cycle_.probe.measurement().phase() != Measurement::Phase::Standing) return false;
  return cycle_.ready_for_move().map([] { return true; });
}

Expected<> Probing::add_retract(const Move& move) {
  const auto ready = ready_for_retract();
  if (!ready) return tl::unexpected(ready.error());
  if (!*ready) return {};
  auto built = build_moves(cycle_.builder(), {{&move, {.first = false, .last = true}}});
  if (!built) return tl::unexpected(built.error());
  const GatewayTurn turn(cycle_.lock);
  if (const auto moving = cycle_.add(std::move(*built)); !moving) return tl::unexpected(moving.error());
  cycle_.probe.measurement().retract();
  return {};
}

Measurement::Phase Probing::phase() {
  const GatewayTurn turn(cycle_.lock);
  return cycle_.probe.measurement().phase();
}

void Probing::expect_hits_by_hand(bool expected) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.probe.measurement().expect_by_hand(expected);
}

void Probing::simulate(bool touching) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.probe.simulate(touching);
}

}  // namespace rmac::gateway
