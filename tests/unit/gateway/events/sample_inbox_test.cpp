#include "gateway/events/sample_inbox.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

class SampleInboxTest : public testing::Test {
 protected:
  void run_cycles(std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) {
      CycleSample sample;
      sample.cycle = ++cycle_;
      link_.history.add(sample);
    }
  }
  std::vector<std::int64_t> next_until(std::int64_t cycle) {
    std::vector<std::int64_t> cycles;
    while (const auto sample = inbox_.next(cycle)) cycles.push_back(sample->cycle);
    return cycles;
  }
  std::int64_t cycle_ = 0;
  ServoLink link_{1};
  SampleInbox inbox_{link_};
};

TEST_F(SampleInboxTest, HandsOutEachCycleOnceAndInOrder) {
  run_cycles(3);
  inbox_.take_over();
  EXPECT_THAT(next_until(2), testing::ElementsAre(1, 2));
  run_cycles(2);
  EXPECT_THAT(next_until(100), testing::ElementsAre(3)) << "later ones are not taken over yet";
  inbox_.take_over();
  EXPECT_THAT(next_until(100), testing::ElementsAre(4, 5));
}

TEST_F(SampleInboxTest, LetsTheServoThreadKnowHowFarItIs) {
  run_cycles(7);
  EXPECT_EQ(link_.delivered.load(), 0);
  inbox_.take_over();
  EXPECT_EQ(link_.delivered.load(), 7) << "virtual time goes on when samples are taken, told or not";
}

TEST_F(SampleInboxTest, GoesOnWithTheOldestCycleThatIsStillThere) {
  run_cycles(kMostUndelivered + 10);
  inbox_.take_over();
  EXPECT_EQ(next_until(1000).front(), 11);
}

}  // namespace
}  // namespace rmac::gateway
