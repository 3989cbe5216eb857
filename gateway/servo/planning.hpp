#pragma once

#include <chrono>

#include "gateway/servo/servo_link.hpp"

namespace rmac::gateway {

/// What plans between two servo cycles, as the threads that pace it see it. In real pace the planner thread runs it; in
/// virtual time the servo thread does, between two cycles. Never called by a servo thread in real pace.
class Planning {
 public:
  /// What the machine is about, for who paces the cycles.
  enum class Pace {
    Planning,  ///< more to plan before the next cycle
    Sending,   ///< a client is filling the queue
    Busy,      ///< something moves or is about to
    Calm,      ///< nothing to do
  };

  virtual ~Planning() = default;
  /// One bounded piece of planning, and the cycle states.
  virtual Pace advance(const ServoStatus& status) = 0;
  /// The planner thread's wait: until a command came, or `period`.
  virtual void wait_for_work(std::chrono::nanoseconds period) = 0;
};

}  // namespace rmac::gateway
