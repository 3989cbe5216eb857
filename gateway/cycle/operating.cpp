#include "gateway/cycle/operating.hpp"

namespace rmac::gateway {

OperatorRef holder(MachineCycle& cycle) {
  const OperatorRef by = cycle.sequencer.phase().held_by();
  return by ? by : cycle.feed.kept_by();
}

Expected<> Operating::require_free(const char* what) {
  const GatewayTurn turn(cycle_.lock);
  return refuse_when_held(what, holder(cycle_));
}

Expected<> Operating::set_override(double percent, const OperatorRef& by) {
  const Interruption::Request urgent(cycle_.interruption);
  const GatewayTurn turn(cycle_.lock);
  auto set = cycle_.feed.set(percent, by);
  if (set) cycle_.apply_feed();
  return set;
}

void Operating::set_optional_stops(bool on) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.program_turn.set_optional_stops(on);
}

void Operating::let_go() {
  const GatewayTurn turn(cycle_.lock);
  cycle_.sequencer.let_go();
  cycle_.feed.let_go();
}

Expected<bool> Operating::take_over() {
  const GatewayTurn turn(cycle_.lock);
  for (const OperatorRef& by : {cycle_.sequencer.phase().held_by(), cycle_.feed.kept_by()}) {
    if (by && by->present()) return tl::unexpected(refuse_when_held("Reset", by).error());
  }
  const bool held = holder(cycle_) != nullptr;
  cycle_.sequencer.let_go();
  cycle_.feed.let_go();
  return held;
}

Expected<double> Operating::retrace(double distance_mm, const OperatorRef& by) {
  const GatewayTurn turn(cycle_.lock);
  if (auto fine = cycle_.sequencer.check_retrace(cycle_.observe(cycle_.status()), by); !fine) {
    return tl::unexpected(fine.error());
  }
  if (cycle_.tools.changing()) {
    return failure(MinorCode::Other, "FeedRetrace: a tool change is under way; go back when it is done");
  }
  const ServoStatus now = cycle_.status();
  auto way = cycle_.mechanism()->planner.turn_back(distance_mm, {now.position_set.data(), now.joint_count});
  if (!way) return way;
  if (!(*way > 0)) {
    return failure(MinorCode::Other,
                   "FeedRetrace: there is no path behind the tool; it stands where its path began, or where the queue "
                   "was emptied");
  }
  cycle_.sequencer.retrace(by);
  cycle_.settle(cycle_.status());
  return way;
}

}  // namespace rmac::gateway
