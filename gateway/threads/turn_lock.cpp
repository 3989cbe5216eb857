#include "gateway/threads/turn_lock.hpp"

#include "gateway/threads/cpu_time.hpp"

namespace rmac::gateway {
namespace {

/// How often whoever waits for the planner looks whether it still gets on.
constexpr std::chrono::milliseconds kLookAgain{20};

}  // namespace

PlannerHangs::PlannerHangs()
    : std::runtime_error(
          "the planner hangs in a module of the mechanism (its kinematics), so this cannot be done; the machine is "
          "brought to rest without it, and the daemon ends: start it again, and have the module mended") {}

bool TurnLock::turn_is_over(std::unique_lock<std::mutex>& hold, std::chrono::nanoseconds most) {
  ++gateway_waits_;
  const bool over = free_.wait_for(hold, most, [this] { return !taken_; });
  --gateway_waits_;
  return over;
}

bool TurnLock::hangs() {
  if (!planner_) return false;
  clockid_t clock{};
  // The thread lives: it has its turn.
  if (pthread_getcpuclockid(*planner_, &clock) != 0) return false;
  const Look now{turn_, cpu_time(clock), std::chrono::steady_clock::now()};
  if (look_.turn != turn_) look_ = now;
  return now.cpu - look_.cpu > patience_.cpu || now.at - look_.at > patience_.wall;
}

bool TurnLock::planner_hangs() {
  const std::lock_guard hold(mutex_);
  return hangs();
}

void TurnLock::lock_as_gateway() NO_THREAD_SAFETY_ANALYSIS {
  std::unique_lock hold(mutex_);
  while (taken_ && !turn_is_over(hold, kLookAgain)) {
    if (hangs()) throw PlannerHangs();
  }
  taken_ = true;
}

bool TurnLock::try_lock_as_gateway(std::chrono::nanoseconds most) NO_THREAD_SAFETY_ANALYSIS {
  std::unique_lock hold(mutex_);
  if (taken_ && !turn_is_over(hold, most)) return false;
  taken_ = true;
  return true;
}

void TurnLock::unlock_as_gateway() NO_THREAD_SAFETY_ANALYSIS {
  {
    const std::lock_guard hold(mutex_);
    work_to_do_ = true;
    taken_ = false;
  }
  free_.notify_all();
  work_.notify_one();
}

void TurnLock::lock_as_planner() NO_THREAD_SAFETY_ANALYSIS {
  std::unique_lock hold(mutex_);
  free_.wait(hold, [this] { return !taken_ && gateway_waits_ == 0; });
  taken_ = true;
  planner_ = pthread_self();
  ++turn_;
  work_to_do_ = false;
}

void TurnLock::unlock_as_planner() NO_THREAD_SAFETY_ANALYSIS {
  {
    const std::lock_guard hold(mutex_);
    planner_.reset();
    taken_ = false;
  }
  free_.notify_all();
}

bool TurnLock::wait_for_work(std::chrono::nanoseconds period) {
  std::unique_lock hold(mutex_);
  return work_.wait_for(hold, period, [this] { return work_to_do_; });
}

}  // namespace rmac::gateway
