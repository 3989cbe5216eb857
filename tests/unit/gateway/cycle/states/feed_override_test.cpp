#include "gateway/cycle/states/feed_override.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

TEST(FeedOverride, IsAPersonsTimesTheJogsShare) {
  FeedOverride feed;
  EXPECT_EQ(feed.effective_percent(), 100);
  ASSERT_TRUE(feed.set(80));
  feed.jog_at(0.25);
  EXPECT_EQ(feed.effective_percent(), 20);
  EXPECT_EQ(feed.percent(), 80) << "people see what they set";
}

TEST(FeedOverride, IsThePersonsAloneWhenTheJogEnds) {
  FeedOverride feed;
  ASSERT_TRUE(feed.set(50));
  feed.jog_at(0.5);
  EXPECT_TRUE(feed.end_jog());
  EXPECT_EQ(feed.effective_percent(), 50);
  EXPECT_FALSE(feed.end_jog()) << "nothing changes";
}

// Red when a program can let the machine go that an operator keeps at an override of 0.
TEST(FeedOverride, OfZeroThatAnOperatorSetIsNoProgramsToRaise) {
  FeedOverride feed;
  const auto panel = std::make_shared<Operator>("panel");
  ASSERT_TRUE(feed.set(0, panel));
  const auto refused = feed.set(100);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("panel, who is the operator"));
  EXPECT_EQ(feed.percent(), 0);
  panel->leave();
  EXPECT_THAT(feed.set(100).error().message, testing::HasSubstr("take it over with Reset"));
  ASSERT_TRUE(feed.set(40, std::make_shared<Operator>("the next one")));
  EXPECT_TRUE(feed.set(100)) << "an override that moves is anybody's";
  EXPECT_EQ(feed.kept_by(), nullptr);
}

TEST(FeedOverride, OfZeroIsTheProgramsWhenTheOperatorsIsLetGo) {
  FeedOverride feed;
  ASSERT_TRUE(feed.set(0, std::make_shared<Operator>("panel")));
  feed.let_go();
  EXPECT_EQ(feed.percent(), 0) << "nothing moves by it";
  EXPECT_TRUE(feed.set(100));
}

}  // namespace
}  // namespace rmac::gateway
