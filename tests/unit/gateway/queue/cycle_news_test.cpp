#include "gateway/queue/cycle_news.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

TEST(CycleNews, TellsWhenItHappenedAndInItsOrder) {
  CycleNews news;
  news.set_time(1.5, 1500);
  news.tell(Event::Kind::Stopped, "first", MinorCode::NoAir);
  news.set_time(2, 2000);
  news.tell(Event::Kind::Fault, "second");
  const auto taken = news.take();
  ASSERT_EQ(taken.events.size(), 2U);
  EXPECT_EQ(taken.events[0].message, "first");
  EXPECT_EQ(taken.events[0].code, MinorCode::NoAir);
  EXPECT_EQ(taken.events[0].t_s, 1.5);
  EXPECT_EQ(taken.events[0].cycle, 1500);
  EXPECT_EQ(taken.events[1].kind, Event::Kind::Fault);
  EXPECT_EQ(taken.events[1].cycle, 2000);
}

TEST(CycleNews, IsToldOnce) {
  CycleNews news;
  news.tell({QueueChange::Kind::Cleared, 0, 7, {}});
  news.tell(Event{});
  const auto taken = news.take();
  ASSERT_EQ(taken.queue.size(), 1U);
  EXPECT_EQ(taken.queue[0].cycle, 7);
  EXPECT_EQ(taken.events.size(), 1U);
  EXPECT_TRUE(news.take().queue.empty());
  EXPECT_TRUE(news.take().events.empty());
}

}  // namespace
}  // namespace rmac::gateway
