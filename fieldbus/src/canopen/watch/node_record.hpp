#pragma once

#include "canopen/watch/answer_jitter.hpp"
#include "rmac/fieldbus/bus_report.hpp"
#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus::canopen {

/// What a node went through since its bus was started: the servo thread notes it, others read it. Locks nothing.
class NodeRecord {
 public:
  explicit NodeRecord(std::chrono::nanoseconds period) noexcept : jitter_(period) {}

  /// Of what follows all is noted by the thread of the cycle.
  void forget() noexcept;
  /// An EMCY message of at least two bytes, `since_start` the bus was started.
  void emergency(const CanFrame& frame, std::chrono::nanoseconds since_start) noexcept;
  /// An SDO answer, whatever it says.
  void sdo_answer(const CanFrame& frame) noexcept;
  void answer(std::chrono::nanoseconds stamp) noexcept { jitter_.take(stamp); }
  void missed() noexcept { missed_.add(); }
  void lost() noexcept { lost_.add(); }
  void recovered() noexcept { recovered_.add(); }
  /// A text that lives on.
  void state(const char* text) noexcept { state_.store(text, std::memory_order_relaxed); }

  /// All but who it is. Any thread.
  [[nodiscard]] NodeReport report(std::chrono::nanoseconds since_start) const;

 private:
  Recent emergencies_;  ///< from the highest bit: 40 bits of ms, 8 of the error register, 16 of the code
  Recent aborts_;       ///< 16 bits of the index, 8 of the sub-index, 32 of the code
  Tally missed_, lost_, recovered_;
  AnswerJitter jitter_;
  std::atomic<const char*> state_{"off"};
};

}  // namespace rmac::fieldbus::canopen
