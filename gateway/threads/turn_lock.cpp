#include "gateway/threads/turn_lock.hpp"

#include <thread>

namespace rmac::gateway {

void TurnLock::lock_as_gateway() NO_THREAD_SAFETY_ANALYSIS {
  gateway_waits_.fetch_add(1, std::memory_order_relaxed);
  mutex_.lock();
  gateway_waits_.fetch_sub(1, std::memory_order_relaxed);
}

void TurnLock::unlock_as_gateway() NO_THREAD_SAFETY_ANALYSIS {
  work_to_do_ = true;
  mutex_.unlock();
  work_.notify_one();
}

void TurnLock::lock_as_planner() NO_THREAD_SAFETY_ANALYSIS {
  // Yielding to a waiting gateway costs at most one scheduling round; barging ahead could starve it for ever.
  while (gateway_waits_.load(std::memory_order_relaxed) > 0) std::this_thread::yield();
  mutex_.lock();
  work_to_do_ = false;
}

void TurnLock::unlock_as_planner() NO_THREAD_SAFETY_ANALYSIS {
  mutex_.unlock();
}

bool TurnLock::wait_for_work(std::chrono::nanoseconds period) {
  std::unique_lock lock(mutex_);
  return work_.wait_for(lock, period, [this] { return work_to_do_; });
}

}  // namespace rmac::gateway
