#pragma once

#include <atomic>

#include "rmac/fieldbus/modbus/client.hpp"

namespace rmac::fieldbus::modbus {

/// A clock that stands still but for what a test lets pass: nothing grows old on a busy computer. Any thread.
class StillClock {
 public:
  [[nodiscard]] Now now() const {
    return [this] { return Clock::time_point(Clock::duration(ticks_)); };
  }
  void pass(Clock::duration time) { ticks_ += time.count(); }

 private:
  std::atomic<Clock::rep> ticks_{Clock::duration(std::chrono::hours(1)).count()};
};

}  // namespace rmac::fieldbus::modbus
