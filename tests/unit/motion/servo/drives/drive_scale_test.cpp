#include "rmac/motion/drive_scale.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace rmac {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// 1000 counts a turn, 2 N·m, home at 250 counts.
constexpr DriveScale kScale{1000, 2, 1, 250};
constexpr DriveScale kReversed{1000, 2, -1, 250};

TEST(DriveScale, CountsFromHomeOnAreTheShaftsAngle) {
  EXPECT_NEAR(shaft_rad(kScale, 250), 0, 1e-12);
  EXPECT_NEAR(shaft_rad(kScale, 500), kTurn / 4, 1e-12);
  EXPECT_NEAR(shaft_rad(kReversed, 500), -kTurn / 4, 1e-12);
}

TEST(DriveScale, AngleMakesTheCountsThatShowIt) {
  EXPECT_NEAR(shaft_counts(kScale, kTurn / 4), 500, 1e-9);
  EXPECT_NEAR(shaft_counts(kReversed, kTurn / 4), 0, 1e-9);
}

TEST(DriveScale, TurnsDoNotKnowHome) {
  EXPECT_EQ(shaft_turns(kScale, 500), 0.5);
  EXPECT_EQ(shaft_turns(kReversed, 500), -0.5);
  EXPECT_FALSE(std::signbit(shaft_turns(kReversed, 0)));
}

TEST(DriveScale, TorqueWordIsPerMilleOfTheRatedTorqueInTheDrivesSense) {
  EXPECT_EQ(torque_word(kScale, 0.5), 250);
  EXPECT_EQ(torque_word(kReversed, 0.5), -250);
  EXPECT_EQ(torque_word(kScale, 0.0009), 0);
  EXPECT_EQ(torque_word(kScale, 0.0011), 1);
  EXPECT_EQ(shaft_nm(kScale, 250), 0.5);
  EXPECT_EQ(shaft_nm(kReversed, 250), -0.5);
}

TEST(DriveScale, TorqueWordStaysWithinItsSixteenBits) {
  EXPECT_EQ(torque_word(kScale, 1000), 32767);
  EXPECT_EQ(torque_word(kScale, -1000), -32767);
}

TEST(DriveScale, PositionWordWraps) {
  EXPECT_EQ(position_word(-3.4), -3);
  EXPECT_EQ(position_word(2147483648.0), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(position_word(4294967301.0), 5);
}

TEST(DriveScale, CountsGoneAreCountedByTheNearerWay) {
  EXPECT_EQ(counts_gone(100, 90), -10);
  EXPECT_EQ(counts_gone(std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min()), 1);
  EXPECT_EQ(counts_gone(std::int64_t{3} << 32, 7), 7);
}

}  // namespace
}  // namespace rmac
