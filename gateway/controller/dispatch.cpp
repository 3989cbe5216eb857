#include <limits>

#include "gateway/controller/controller_impl.hpp"
#include "gateway/controller/fault_text.hpp"

namespace rmac::gateway {

void Controller::Impl::tell(const Event& event) const {
  for (const auto& listener : event_listeners) listener(event);
}

void Controller::Impl::deliver_samples_until(std::int64_t cycle) {
  while (!waiting_samples.empty() && waiting_samples.front().cycle <= cycle) {
    const CycleSample sample = waiting_samples.front();
    waiting_samples.pop_front();
    for (const auto& listener : sample_listeners) listener(sample);
    ledger.read(sample, [this](const Event& event) { tell(event); });
  }
}

void Controller::Impl::tell_faults() {
  FaultRecord record;
  while (link->faults.pop(record)) {
    const Mechanism* mechanism = in_force && record.generation == generation ? in_force.get() : nullptr;
    tell({Event::Kind::Fault, record.t_s, record.move_id, describe(record.fault, mechanism)});
  }
}

void Controller::Impl::dispatch() {
  // News first, samples second: then every sample that a piece of news follows from is among them, and told before it.
  const MotionSupervisor::News news = supervisor.take_news();
  drain();
  using Kind = MotionSupervisor::QueueChange::Kind;
  for (const MotionSupervisor::QueueChange& change : news.queue) {
    if (change.kind == Kind::Added || change.kind == Kind::Still) {
      ledger.add(change.move_id, change.kind == Kind::Still);
      continue;
    }
    deliver_samples_until(change.cycle);
    if (change.kind == Kind::Cleared) {
      ledger.clear();
    } else {
      ledger.restart();
    }
  }
  deliver_samples_until(std::numeric_limits<std::int64_t>::max());
  tell_faults();
  for (const Event& event : news.events) tell(event);
}

}  // namespace rmac::gateway
