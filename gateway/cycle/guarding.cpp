#include "gateway/cycle/guarding.hpp"

#include <utility>

namespace rmac::gateway {
namespace {

void put_in(MachineCycle& cycle, std::shared_ptr<ClearWay> way) REQUIRES(cycle.lock) {
  cycle.guard.put_in(std::move(way));
  if (cycle.mechanism()) cycle.mechanism()->planner.set_gate(cycle.guard.on() ? &cycle.guard : nullptr);
}

}  // namespace

Expected<> Guarding::put_in(const char* function, std::shared_ptr<ClearWay> way) {
  const GatewayTurn turn(cycle_.lock);
  auto rest = cycle_.require_rest(function);
  if (!rest) return rest;
  rmac::gateway::put_in(cycle_, std::move(way));
  cycle_.queue.begin_anew();
  return {};
}

void Guarding::replace(std::shared_ptr<ClearWay> way) {
  const GatewayTurn turn(cycle_.lock);
  rmac::gateway::put_in(cycle_, std::move(way));
}

void Guarding::set_tool(std::shared_ptr<const Tool> tool) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.guard.set_tool(std::move(tool));
}

bool Guarding::on() {
  const GatewayTurn turn(cycle_.lock);
  return cycle_.guard.on();
}

void Guarding::tell(Event::Kind kind, const std::string& message) {
  const GatewayTurn turn(cycle_.lock);
  (void)cycle_.observe(cycle_.status());  // at this time
  cycle_.news.tell(kind, message);
}

}  // namespace rmac::gateway
