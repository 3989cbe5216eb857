#include "servo/drives/shaft_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "servo/drives/shafts.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

constexpr double kRadPerCount = 2 * std::numbers::pi / 1000;

class ShaftReading : public testing::Test {
 protected:
  void read(std::int32_t counts, bool online = true) { reader_.read({.position_counts = counts, .online = online}); }
  ShaftReader reader_{{1000, 1, 1, 200}, kPeriod};
};

TEST_F(ShaftReading, CountsFromHome) {
  read(450);
  EXPECT_TRUE(reader_.seen());
  EXPECT_EQ(reader_.counts(), 450);
  EXPECT_NEAR(reader_.rad(), 250 * kRadPerCount, 1e-12);
}

TEST_F(ShaftReading, FirstReadingHasNoVelocityTheSecondOneADifferenceTheThirdNoLag) {
  read(0);
  EXPECT_EQ(reader_.rad_s(), 0);
  read(10);
  EXPECT_NEAR(reader_.rad_s(), 10 * kRadPerCount / kPeriod, 1e-9);
  read(30);
  EXPECT_NEAR(reader_.rad_s(), (3 * 20 - 10) / 2.0 * kRadPerCount / kPeriod, 1e-9);
}

TEST_F(ShaftReading, SilentDriveStandsAndItsVelocityBeginsAnew) {
  for (const int counts : {0, 10, 20}) read(counts);
  read(500, false);
  EXPECT_EQ(reader_.rad_s(), 0);
  EXPECT_EQ(reader_.counts(), 20);
  read(60);
  EXPECT_EQ(reader_.rad_s(), 0);
  EXPECT_EQ(reader_.counts(), 60);
  read(70);
  EXPECT_NEAR(reader_.rad_s(), 10 * kRadPerCount / kPeriod, 1e-9);
}

TEST_F(ShaftReading, GoesOnAtItsSpeedWhereAnAnswerIsMissing) {
  for (const int counts : {0, 10, 20}) read(counts);
  const double speed = reader_.rad_s();
  for (const int gone : {30, 40, 50}) {
    reader_.read({.position_counts = 20, .online = true, .missed = true});
    EXPECT_NEAR(reader_.rad(), (gone - 200) * kRadPerCount, 1e-9);
    EXPECT_EQ(reader_.rad_s(), speed);
    EXPECT_EQ(reader_.counts(), 20) << "what was read";
  }
  read(60);
  EXPECT_NEAR(reader_.rad(), (60 - 200) * kRadPerCount, 1e-12);
  EXPECT_NEAR(reader_.rad_s(), speed, 1e-9);
  EXPECT_EQ(reader_.counts(), 60);
}

TEST_F(ShaftReading, StandsWhereItGotToAfterThreeCyclesWithoutAnAnswer) {
  for (const int counts : {0, 10, 20}) read(counts);
  for (int i = 0; i < 5; ++i) reader_.read({.position_counts = 20, .online = true, .missed = true});
  EXPECT_NEAR(reader_.rad(), (50 - 200) * kRadPerCount, 1e-9);
  EXPECT_EQ(reader_.rad_s(), 0);
  read(80);
  EXPECT_NEAR(reader_.rad(), (80 - 200) * kRadPerCount, 1e-9);
  EXPECT_EQ(reader_.rad_s(), 0) << "its velocity begins anew";
  read(90);
  EXPECT_NEAR(reader_.rad_s(), 10 * kRadPerCount / kPeriod, 1e-9);
}

TEST_F(ShaftReading, IsRefusedToItsLastAnswer) {
  for (const int counts : {0, 10, 20}) read(counts);
  reader_.read({.position_counts = 20, .online = true, .missed = true});
  reader_.refuse();
  EXPECT_NEAR(reader_.rad(), (20 - 200) * kRadPerCount, 1e-9);
  reader_.take_over((std::int64_t{1} << 32) + 500, true);
  reader_.read({.position_counts = 500, .online = true, .missed = true});
  reader_.refuse();
  EXPECT_EQ(reader_.counts(), (std::int64_t{1} << 32) + 500);
}

// Otherwise a loop would be told that it stands, and then that it is three times as fast.
TEST_F(ShaftReading, HasItsSpeedThroughMissingAnswers) {
  std::mt19937 random(5);
  double largest = 0;
  std::int32_t told = 0;
  for (int i = 0; i < 5000; ++i) {
    const double t = i * kPeriod, at = 50'000 * std::sin(6 * t), speed = 300'000 * std::cos(6 * t) * kRadPerCount;
    const bool misses = i > 2 && random() % 20 == 0;
    if (!misses) told = static_cast<std::int32_t>(std::lround(at));
    reader_.read({.position_counts = told, .online = true, .missed = misses});
    if (i > 2) largest = std::max(largest, std::abs(reader_.rad_s() - speed));
  }
  EXPECT_LT(largest, 0.02 * 300'000 * kRadPerCount);
}

TEST_F(ShaftReading, WrapIsFollowed) {
  read(2147483640);
  read(-2147483640);
  EXPECT_EQ(reader_.counts(), 2147483656);
  EXPECT_NEAR(reader_.rad_s(), 16 * kRadPerCount / kPeriod, 1e-4);  // angles of some 1e7 rad are rounded to 1e-9
}

TEST_F(ShaftReading, ForgottenCounterBeginsAnewNearHome) {
  read(2147483640);
  read(-2147483640);
  reader_.forget();
  EXPECT_FALSE(reader_.seen());
  read(90);
  EXPECT_EQ(reader_.counts(), 90);
  EXPECT_EQ(reader_.rad_s(), 0);
}

TEST_F(ShaftReading, GoesOnFromWhereAnotherLoopLeftIt) {
  reader_.take_over((std::int64_t{1} << 32) + 500, true);
  EXPECT_NEAR(reader_.rad(), ((1LL << 32) + 300) * kRadPerCount, 1e-3);
  read(510);
  EXPECT_EQ(reader_.counts(), (std::int64_t{1} << 32) + 510);
  EXPECT_NEAR(reader_.rad_s(), 10 * kRadPerCount / kPeriod, 1e-3);
}

TEST_F(ShaftReading, WhatAnotherLoopNeverReadIsCountedFromHome) {
  reader_.take_over(std::int64_t{1} << 32, false);
  read(510);
  EXPECT_EQ(reader_.counts(), 510);
  EXPECT_EQ(reader_.rad_s(), 0);
}

TEST(Shafts, AreReadInTheOrderOfTheMapFromTheirOwnDrives) {
  const auto bus = std::make_shared<ServoBus>(std::make_shared<FakeBus>(3));
  const std::vector<ServoActuator> actuators{{bus, 2, {1000, 1, 1, 0}}, {bus, 0, {1000, 1, -1, 0}}};
  Shafts shafts(actuators, kPeriod);
  for (const std::int32_t way : {0, 10}) {
    bus->feedback[2] = {.position_counts = 100 + way, .online = true};
    bus->feedback[0] = {.position_counts = 40 + 2 * way, .online = true};
    shafts.read();
  }
  EXPECT_NEAR(shafts.rad()[0], 110 * kRadPerCount, 1e-12);
  EXPECT_NEAR(shafts.rad()[1], -60 * kRadPerCount, 1e-12);
  EXPECT_NEAR(shafts.rad_s()[0], 10 * kRadPerCount / kPeriod, 1e-9);
  EXPECT_NEAR(shafts.rad_s()[1], -20 * kRadPerCount / kPeriod, 1e-9);
}

}  // namespace
}  // namespace rmac::servo_test
