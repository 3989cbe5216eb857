#include "gateway/threads/turn_lock.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

namespace rmac::gateway {
namespace {

TEST(TurnLock, LetsOneAtATimeIn) {
  TurnLock lock;
  int turns = 0;  // no atomic: a turn too many loses some, and the thread sanitizer sees it
  constexpr int kEach = 20000;
  std::thread planner([&] {
    for (int i = 0; i < kEach; ++i) {
      const PlannerTurn turn(lock);
      ++turns;
    }
  });
  for (int i = 0; i < kEach; ++i) {
    const GatewayTurn turn(lock);
    ++turns;
  }
  planner.join();
  EXPECT_EQ(turns, 2 * kEach);
}

TEST(TurnLock, EndsTheWaitOfAPlannerWithTheGatewaysTurn) {
  TurnLock lock;
  EXPECT_FALSE(lock.wait_for_work(std::chrono::nanoseconds(0))) << "nobody did anything";
  { const GatewayTurn turn(lock); }
  EXPECT_TRUE(lock.wait_for_work(std::chrono::hours(1))) << "work that came before the wait counts";
  std::thread gateway([&] { const GatewayTurn turn(lock); });
  EXPECT_TRUE(lock.wait_for_work(std::chrono::hours(1)));
  gateway.join();
}

TEST(TurnLock, HasNoWorkLeftOnceThePlannerHadItsTurn) {
  TurnLock lock;
  { const GatewayTurn turn(lock); }
  { const PlannerTurn turn(lock); }
  EXPECT_FALSE(lock.wait_for_work(std::chrono::nanoseconds(0)));
}

TEST(TurnLock, IsNotKeptFromTheGatewayByAPlannerThatNeverRests) {
  TurnLock lock;
  bool gateway_was_in = false;  // guarded by `lock`
  std::thread gateway([&] {
    const GatewayTurn turn(lock);
    gateway_was_in = true;
  });
  for (bool in = false; !in;) {  // ends only if the gateway gets its turn
    const PlannerTurn turn(lock);
    in = gateway_was_in;
  }
  gateway.join();
}

TEST(TurnLock, TellsWhoWaitsForAPlannerThatHangs) {
  TurnLock lock({.cpu = std::chrono::milliseconds(20), .wall = std::chrono::hours(1)});
  std::atomic<bool> hangs{true}, has_its_turn{false};
  std::thread planner([&] {
    const PlannerTurn turn(lock);
    has_its_turn = true;
    while (hangs) {
    }
  });
  while (!has_its_turn) std::this_thread::yield();
  EXPECT_THROW(const GatewayTurn turn(lock), PlannerHangs);
  EXPECT_TRUE(lock.planner_hangs());
  EXPECT_FALSE(lock.try_lock_as_gateway(std::chrono::milliseconds(1)));
  hangs = false;
  planner.join();
  EXPECT_FALSE(lock.planner_hangs());
  const GatewayTurn turn(lock);  // it was slow, and is back
}

TEST(TurnLock, TellsWhoWaitsForAPlannerThatSleeps) {
  TurnLock lock({.cpu = std::chrono::hours(1), .wall = std::chrono::milliseconds(20)});
  std::promise<void> has_its_turn, may_go_on;
  std::thread planner([&] {
    const PlannerTurn turn(lock);
    has_its_turn.set_value();
    may_go_on.get_future().wait();
  });
  has_its_turn.get_future().wait();
  EXPECT_THROW(const GatewayTurn turn(lock), PlannerHangs);
  may_go_on.set_value();
  planner.join();
}

TEST(TurnLock, IsTakenAtOnceWhereItIsFree) {
  TurnLock lock;
  ASSERT_TRUE(lock.try_lock_as_gateway(std::chrono::nanoseconds(0)));
  lock.unlock_as_gateway();
  EXPECT_TRUE(lock.wait_for_work(std::chrono::nanoseconds(0)));
}

}  // namespace
}  // namespace rmac::gateway
