#include "servo/spindles/turn_reader.hpp"

#include <gtest/gtest.h>

#include "servo/spindles/overload_watch.hpp"
#include "unit/motion/servo/period.hpp"

namespace rmac {
namespace {

using servo_test::kPeriod;

/// 1000 counts a turn, against the drive: 10 counts a cycle are -600 rpm.
class TurningSpindle : public testing::Test {
 protected:
  void read(std::int32_t counts, bool online = true) { reader_.read({.position_counts = counts, .online = online}); }
  TurnReader reader_{{1000, 1, -1, 77}, kPeriod};
};

TEST_F(TurningSpindle, SpeedIsKnownFromTheSecondReadingOnAndItsChangeFromTheThird) {
  read(5000);
  EXPECT_EQ(reader_.rpm(), 0);
  EXPECT_EQ(reader_.counts(), 0) << "counted from the first reading on";
  read(5010);
  EXPECT_NEAR(reader_.rpm(), -600, 1e-9);
  EXPECT_EQ(reader_.rpm_per_s(), 0);
  EXPECT_TRUE(reader_.settled());
  read(5030);
  EXPECT_NEAR(reader_.rpm(), -60 * (3 * 20 - 10) / 2.0, 1e-9);
  EXPECT_NEAR(reader_.rpm_per_s(), (-1500 + 600) / kPeriod, 1e-6);
  EXPECT_EQ(reader_.counts(), 30);
}

TEST_F(TurningSpindle, SilentDriveKeepsItsSpeedAndBeginsAnew) {
  for (const int counts : {0, 10, 20}) read(counts);
  read(900, false);
  EXPECT_NEAR(reader_.rpm(), -600, 1e-9);
  EXPECT_FALSE(reader_.settled());
  read(60);
  EXPECT_FALSE(reader_.settled());
  EXPECT_NEAR(reader_.rpm(), -600, 1e-9);
  EXPECT_EQ(reader_.counts(), 60);
  read(65);
  EXPECT_NEAR(reader_.rpm(), -300, 1e-9);
  EXPECT_EQ(reader_.rpm_per_s(), 0);
}

TEST_F(TurningSpindle, WrapIsFollowed) {
  read(2147483640);
  read(-2147483646);
  EXPECT_NEAR(reader_.rpm(), -600, 1e-9);
  EXPECT_EQ(reader_.counts(), 10);
}

/// Within 50 rpm it is at speed; after half a second it should be.
class LoadedSpindle : public testing::Test {
 protected:
  bool run(int cycles, double wanted, double rpm, double torque, double bound = 4) {
    bool over = false;
    for (int i = 0; i < cycles; ++i) over = watch_.step(wanted, rpm, torque, bound);
    return over;
  }
  OverloadWatch watch_{50, 0.5, kPeriod};
};

TEST_F(LoadedSpindle, IsOverloadedAfterATenthOfASecondAtItsBound) {
  EXPECT_FALSE(run(98, 1000, 960, -4));
  EXPECT_TRUE(run(3, 1000, 960, -4));
}

TEST_F(LoadedSpindle, IsNotOverloadedBelowItsBoundOrWithoutOne) {
  EXPECT_FALSE(run(300, 1000, 1000, 3.99));
  EXPECT_FALSE(run(300, 1000, 1000, 400, 0));
}

TEST_F(LoadedSpindle, ReliefBeginsTheTimeAnew) {
  (void)run(90, 1000, 1000, 4);
  (void)run(1, 1000, 1000, 3);
  EXPECT_FALSE(run(90, 1000, 1000, 4));
}

TEST_F(LoadedSpindle, MayTakeAllItsTorqueToChangeItsSpeedForAWhile) {
  EXPECT_FALSE(run(500, 1000, 200, 4));
  EXPECT_TRUE(run(120, 1000, 200, 4)) << "it should be there by now";
  EXPECT_FALSE(run(300, 500, 200, 4)) << "another speed is wanted";
}

TEST_F(LoadedSpindle, SpeedThatDropsUnderLoadIsNoChangeOfSpeed) {
  (void)run(1, 1000, 1000, 1);
  EXPECT_TRUE(run(120, 1000, 100, 4));
}

}  // namespace
}  // namespace rmac
