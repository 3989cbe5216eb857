// When the daemon has to look often at a machine in virtual time, and when it need not.
#include "gateway/rmacd/clock_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace rmac::gateway {
namespace {

using std::chrono::milliseconds;

class Watched : public testing::Test {
 protected:
  /// So long, in steps of `step`, in which the machine's time goes `speed` times as fast as the clock.
  bool run(milliseconds length, milliseconds step, double speed) {
    bool keeps = false;
    for (milliseconds gone{0}; gone < length; gone += step) {
      now_ += step;
      machine_ += speed * ClockWatch::Length(step);
      keeps = watch_.keeps(machine_, now_);
    }
    return keeps;
  }
  ClockWatch watch_{milliseconds(1)};
  ClockWatch::Time now_ = ClockWatch::Time(std::chrono::hours(1));
  ClockWatch::Length machine_{7};
};

TEST_F(Watched, KeepsToTheClockAfterAWhileOfThat) {
  EXPECT_FALSE(run(milliseconds(15), milliseconds(1), 1));
  EXPECT_TRUE(run(milliseconds(30), milliseconds(1), 1));
  EXPECT_TRUE(run(milliseconds(300), milliseconds(2), 1));
  EXPECT_TRUE(run(milliseconds(300), milliseconds(2), 0.7)) << "a computer that is busy elsewhere";
}

TEST_F(Watched, IsSeenAtOnceToRunAheadOrToStand) {
  for (const double speed : {5.0, 100.0, 0.0}) {
    ASSERT_TRUE(run(milliseconds(100), milliseconds(2), 1));
    EXPECT_FALSE(run(milliseconds(4), milliseconds(4), speed)) << speed;
    EXPECT_FALSE(run(milliseconds(500), milliseconds(1), speed)) << speed;
  }
}

// The daemon looks every 2 ms where it need not look more often.
TEST_F(Watched, IsSeenToStandByLooksOfTwoMillisecondsWhateverTheCycle) {
  for (const int period : {1, 2, 4}) {
    watch_ = ClockWatch(milliseconds(period));
    ASSERT_TRUE(run(milliseconds(200), milliseconds(std::max(2, period)), 1)) << period;
    EXPECT_FALSE(run(milliseconds(2 * period + 4), milliseconds(2), 0)) << period;
  }
}

TEST_F(Watched, DoesNotKeepToItForALookInWhichNoCycleWasDue) {
  ASSERT_TRUE(run(milliseconds(100), milliseconds(2), 1));
  EXPECT_TRUE(watch_.keeps(machine_, now_ + std::chrono::microseconds(100)));
}

}  // namespace
}  // namespace rmac::gateway
