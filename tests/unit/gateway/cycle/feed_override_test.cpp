#include "gateway/cycle/feed_override.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

TEST(FeedOverride, IsAPersonsTimesTheJogsShare) {
  FeedOverride feed;
  EXPECT_EQ(feed.effective_percent(), 100);
  feed.set(80);
  feed.jog_at(0.25);
  EXPECT_EQ(feed.effective_percent(), 20);
  EXPECT_EQ(feed.percent(), 80) << "people see what they set";
}

TEST(FeedOverride, IsThePersonsAloneWhenTheJogEnds) {
  FeedOverride feed;
  feed.set(50);
  feed.jog_at(0.5);
  EXPECT_TRUE(feed.end_jog());
  EXPECT_EQ(feed.effective_percent(), 50);
  EXPECT_FALSE(feed.end_jog()) << "nothing changes";
}

}  // namespace
}  // namespace rmac::gateway
