#pragma once

#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "gateway/threads/thread_safety.hpp"

namespace rmac::gateway {

/// The planner has had its turn for longer than any planning takes: a module that it called does not return. Nothing
/// that needs the lock can be done any more in this process.
class PlannerHangs : public std::runtime_error {
 public:
  PlannerHangs();
};

/// One lock for two who take turns. The gateway goes first: the planner, which takes the lock cycle after cycle, would
/// otherwise starve it. What the gateway did may be work, so the end of its turn wakes a planner that waits for some.
/// Never taken by a servo thread in real pace. Not recursive. Use it through `GatewayTurn` and `PlannerTurn`.
class CAPABILITY("mutex") TurnLock {
 public:
  /// A turn of the planner that takes more is not planning: of its thread's CPU time, so that a busy computer makes no
  /// difference, or by the clock where it waits for something.
  struct Patience {
    std::chrono::nanoseconds cpu = std::chrono::seconds(2);
    std::chrono::nanoseconds wall = std::chrono::seconds(30);
  };

  TurnLock() = default;
  explicit TurnLock(Patience patience) : patience_(patience) {}

  /// Throws PlannerHangs instead of waiting for ever.
  void lock_as_gateway() ACQUIRE();
  /// Waits no longer than `most`; false: the planner still has its turn.
  [[nodiscard]] bool try_lock_as_gateway(std::chrono::nanoseconds most) TRY_ACQUIRE(true);
  void unlock_as_gateway() RELEASE();
  void lock_as_planner() ACQUIRE();
  void unlock_as_planner() RELEASE();

  /// Planner thread, without the lock: until a turn of the gateway has ended since the planner's last turn began, or
  /// `period` is over. True when there is work.
  bool wait_for_work(std::chrono::nanoseconds period);
  /// Any thread: the planner's turn takes longer than the patience.
  [[nodiscard]] bool planner_hangs();

 private:
  /// The first look at a turn of the planner: who takes it does not pay for that.
  struct Look {
    std::uint64_t turn = 0;
    std::chrono::nanoseconds cpu{};  ///< of the planner's thread
    std::chrono::steady_clock::time_point at;
  };
  [[nodiscard]] bool turn_is_over(std::unique_lock<std::mutex>& hold, std::chrono::nanoseconds most);
  [[nodiscard]] bool hangs();

  Patience patience_;
  std::mutex mutex_;  ///< of what follows; held for moments only
  std::condition_variable free_;
  std::condition_variable work_;
  bool taken_ = false;
  std::optional<pthread_t> planner_;  ///< its thread, while it has its turn
  std::uint64_t turn_ = 0;            ///< of the planner
  Look look_;
  int gateway_waits_ = 0;
  bool work_to_do_ = false;
};

/// The lock is the gateway's until the end of the scope. Throws PlannerHangs.
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
