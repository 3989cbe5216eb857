#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "gateway/servo/servo_link.hpp"

namespace rmac::gateway {

/// The samples that the servo thread has written and nobody was told of yet. Until they are taken over here a machine
/// in virtual time waits. One thread at a time, never the servo thread.
class SampleInbox {
 public:
  explicit SampleInbox(ServoLink& link) : link_(link) {}

  /// Takes over the samples that are there now.
  void take_over();
  /// The next sample in order, of this cycle or one before it; nothing when there is none.
  [[nodiscard]] std::optional<CycleSample> next(std::int64_t last_cycle);

 private:
  ServoLink& link_;
  std::deque<CycleSample> waiting_;
};

}  // namespace rmac::gateway
