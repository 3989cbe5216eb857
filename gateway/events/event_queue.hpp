#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "gateway/state/event.hpp"

namespace rmac::gateway {

/// Events that nobody was told of yet, in the order of the cycles in which they happened; within a cycle, in that in
/// which they were added.
class EventQueue {
 public:
  void add(Event event);
  /// The next one, if it happened before this cycle.
  [[nodiscard]] std::optional<Event> next_before(std::int64_t cycle);

 private:
  std::deque<Event> waiting_;
};

}  // namespace rmac::gateway
