#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

#include "gateway/threads/thread_safety.hpp"

namespace rmac::gateway {

/// One lock for two who take turns. The gateway goes first: the planner, which takes the lock cycle after cycle, would
/// otherwise starve it. What the gateway did may be work, so the end of its turn wakes a planner that waits for some.
/// Never taken by a servo thread in real pace. Not recursive. Use it through `GatewayTurn` and `PlannerTurn`.
class CAPABILITY("mutex") TurnLock {
 public:
  void lock_as_gateway() ACQUIRE();
  void unlock_as_gateway() RELEASE();
  void lock_as_planner() ACQUIRE();
  void unlock_as_planner() RELEASE();

  /// Planner thread, without the lock: until a turn of the gateway has ended since the planner's last turn began, or
  /// `period` is over. True when there is work.
  bool wait_for_work(std::chrono::nanoseconds period);

 private:
  std::mutex mutex_;
  std::atomic<int> gateway_waits_{0};
  std::condition_variable work_;
  bool work_to_do_ = false;  ///< guarded by `mutex_`
};

/// The lock is the gateway's until the end of the scope.
class SCOPED_CAPABILITY GatewayTurn {
 public:
  explicit GatewayTurn(TurnLock& lock) ACQUIRE(lock) : lock_(lock) { lock_.lock_as_gateway(); }
  GatewayTurn(const GatewayTurn&) = delete;
  GatewayTurn& operator=(const GatewayTurn&) = delete;
  ~GatewayTurn() RELEASE() { lock_.unlock_as_gateway(); }

 private:
  TurnLock& lock_;
};

/// The lock is the planner's until the end of the scope; taken only when no gateway waits for it.
class SCOPED_CAPABILITY PlannerTurn {
 public:
  explicit PlannerTurn(TurnLock& lock) ACQUIRE(lock) : lock_(lock) { lock_.lock_as_planner(); }
  PlannerTurn(const PlannerTurn&) = delete;
  PlannerTurn& operator=(const PlannerTurn&) = delete;
  ~PlannerTurn() RELEASE() { lock_.unlock_as_planner(); }

 private:
  TurnLock& lock_;
};

}  // namespace rmac::gateway
