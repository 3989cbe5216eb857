#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "gateway/events/event_queue.hpp"
#include "gateway/events/move_ledger.hpp"
#include "gateway/events/sample_inbox.hpp"
#include "gateway/mechanism/mechanism.hpp"
#include "gateway/queue/cycle_news.hpp"

namespace rmac::gateway {

/// Tells the listeners of samples and events in the order in which they happened: an event comes after the samples of
/// the cycles before it that were there. One thread at a time, never the servo thread.
class Announcer {
 public:
  using Tell = std::function<void(Event)>;
  /// The mechanism of a generation, to name what is at fault; nullptr when it is gone.
  using FindMechanism = std::function<const Mechanism*(std::uint64_t generation)>;

  Announcer(ServoLink& link, FindMechanism find_mechanism)
      : link_(link), find_mechanism_(std::move(find_mechanism)), samples_(link) {}

  void on_event(std::function<void(const Event&)> listener) { event_listeners_.push_back(std::move(listener)); }
  void on_sample(std::function<void(const CycleSample&)> listener) { sample_listeners_.push_back(std::move(listener)); }
  /// Sees an event before the listeners do, and may add to it.
  void before_event(std::function<void(Event&)> annotate) { annotators_.push_back(std::move(annotate)); }
  /// Sees a sample after the listeners have, and may tell of what follows from it.
  void after_sample(std::function<void(const CycleSample&, const Tell&)> read) {
    sample_readers_.push_back(std::move(read));
  }

  /// Takes over the samples that are there now; they are told of with the next announcement.
  void take_over_samples() { samples_.take_over(); }
  /// Tells of all that happened since the last announcement. `news` was taken just now, before this is called: then
  /// every sample that a piece of news follows from is there, and told before it.
  void announce(const CycleNews::Taken& news);
  /// Tells of an event at once.
  void tell(Event event);

  /// What stopped the machine last, a fault or a stop, as long as it has not gone on since.
  [[nodiscard]] const std::optional<Event>& last_stop() const noexcept { return last_stop_; }

 private:
  void take_faults();
  void tell_samples_until(std::int64_t cycle);
  void tell_events_before(std::int64_t cycle);

  ServoLink& link_;
  FindMechanism find_mechanism_;
  SampleInbox samples_;
  EventQueue events_;
  MoveLedger ledger_;
  std::optional<Event> last_stop_;
  std::vector<std::function<void(const Event&)>> event_listeners_;
  std::vector<std::function<void(const CycleSample&)>> sample_listeners_;
  std::vector<std::function<void(Event&)>> annotators_;
  std::vector<std::function<void(const CycleSample&, const Tell&)>> sample_readers_;
};

}  // namespace rmac::gateway
