#include "gateway/threads/turn_lock.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace rmac::gateway
