#include "gateway/events/event_queue.hpp"

#include <algorithm>

namespace rmac::gateway {

void EventQueue::add(Event event) {
  const auto place = std::ranges::upper_bound(waiting_, event.cycle, {}, &Event::cycle);
  waiting_.insert(place, std::move(event));
}

std::optional<Event> EventQueue::next_before(std::int64_t cycle) {
  if (waiting_.empty() || waiting_.front().cycle >= cycle) return {};
  Event event = std::move(waiting_.front());
  waiting_.pop_front();
  return event;
}

}  // namespace rmac::gateway
