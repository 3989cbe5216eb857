#include "gateway/events/announcer.hpp"

#include <limits>

#include "gateway/events/fault_text.hpp"

namespace rmac::gateway {

void Announcer::announce(const CycleNews::Taken& news) {
  samples_.take_over();
  take_faults();
  for (const Event& event : news.events) events_.add(event);
  using Kind = QueueChange::Kind;
  for (const QueueChange& change : news.queue) {
    if (change.kind == Kind::Added || change.kind == Kind::Still) {
      ledger_.add(change.move_id, change.kind == Kind::Still, change.part, change.name, change.cycle, change.order);
      continue;
    }
    tell_samples_until(change.cycle);
    if (change.kind == Kind::Cleared) {
      ledger_.clear();
    } else {
      ledger_.restart();
    }
  }
  constexpr auto kAll = std::numeric_limits<std::int64_t>::max();
  tell_samples_until(kAll);
  tell_events_before(kAll);
}

void Announcer::take_faults() {
  FaultRecord record;
  while (link_.faults.pop(record)) events_.add(event_of(record, find_mechanism_(record.generation)));
}

void Announcer::tell_samples_until(std::int64_t cycle) {
  const Tell tell_one = [this](Event event) { tell(std::move(event)); };
  while (const auto sample = samples_.next(cycle)) {
    tell_events_before(sample->cycle);
    for (const auto& listener : sample_listeners_) listener(*sample);
    ledger_.read(*sample, tell_one);
    for (const auto& read : sample_readers_) read(*sample, tell_one);
  }
}

void Announcer::tell_events_before(std::int64_t cycle) {
  while (auto event = events_.next_before(cycle)) {
    ledger_.tell_before(*event, [this](const Event& earlier) { tell(earlier); });
    tell(std::move(*event));
  }
}

void Announcer::tell(Event event) {
  for (const auto& annotate : annotators_) annotate(event);
  if (event.kind == Event::Kind::Fault || event.kind == Event::Kind::Stopped) last_stop_ = event;
  if (event.goes_on) last_stop_.reset();
  for (const auto& listener : event_listeners_) listener(event);
}

}  // namespace rmac::gateway
