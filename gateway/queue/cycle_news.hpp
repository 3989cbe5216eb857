#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "gateway/queue/queue_step.hpp"
#include "gateway/state/event.hpp"

namespace rmac::gateway {

/// What happened to the queue, and in which cycle: a move was added (`Still`: one without motion), or everything not
/// done was dropped, or another mechanism's queue began.
struct QueueChange {
  enum class Kind : std::uint8_t { Added, Still, Cleared, Replaced };
  Kind kind = Kind::Added;
  std::int64_t move_id = 0;
  std::int64_t cycle = 0;
  MovePart part{};
  std::string name{};       ///< as events name it; empty: "move 7"
  std::uint64_t order = 0;  ///< among events and changes
};

/// What the gateway has not been told yet: events, and changes of the queue, each in their order, and numbered
/// together.
class CycleNews {
 public:
  struct Taken {
    std::vector<QueueChange> queue;
    std::vector<Event> events;
  };

  /// What is told from now on happens at this time and in this cycle.
  void set_time(double t_s, std::int64_t cycle) noexcept {
    t_s_ = t_s;
    cycle_ = cycle;
  }
  void tell(Event::Kind kind, std::string message, MinorCode code = MinorCode::None, bool goes_on = false) {
    tell({kind, t_s_, 0, std::move(message), cycle_, {}, code, {}, goes_on});
  }
  /// At the time that was set.
  void tell_now(Event event) {
    event.t_s = t_s_;
    event.cycle = cycle_;
    tell(std::move(event));
  }
  void tell(Event event) {
    event.order = ++told_;
    news_.events.push_back(std::move(event));
  }
  /// What is added to the queue is so in the cycle that was set.
  void tell(QueueChange change) {
    if (change.kind == QueueChange::Kind::Added || change.kind == QueueChange::Kind::Still) change.cycle = cycle_;
    change.order = ++told_;
    news_.queue.push_back(std::move(change));
  }
  [[nodiscard]] Taken take() { return std::exchange(news_, {}); }

 private:
  Taken news_;
  double t_s_ = 0;
  std::int64_t cycle_ = 0;
  std::uint64_t told_ = 0;  ///< events and changes
};

}  // namespace rmac::gateway
