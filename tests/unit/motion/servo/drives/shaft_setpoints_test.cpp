#include <gmock/gmock.h>

#include <limits>
#include <numbers>
#include <random>

#include "servo/drives/shaft_aims.hpp"
#include "servo/drives/shaft_torques.hpp"
#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(ShaftTorques, AreThoseThatGiveTheJointsTheirEfforts) {
  const DifferentialMap map;
  const std::vector<ServoActuator> actuators(3);
  ShaftTorques torques(map, actuators, kPeriod);
  RecordedFaults faults;
  torques.make(std::array{0.0, 0.0, 0.0}, std::array{4.0, 2.0, 7.0}, faults);
  EXPECT_THAT(torques.all(), testing::ElementsAre(3, 1, 7));
  EXPECT_TRUE(faults.raised.empty());
  torques.let_go();
  EXPECT_THAT(torques.all(), testing::ElementsAre(0, 0, 0));
}

TEST(ShaftTorques, NoneIsLeftWhereOneIsNoNumber) {
  const DirectMap map;
  const std::vector<ServoActuator> actuators(3);
  ShaftTorques torques(map, actuators, kPeriod);
  RecordedFaults faults;
  const double infinity = std::numeric_limits<double>::infinity();
  torques.make(std::array{0.0, 0.0, 0.0}, std::array{4.0, infinity, 7.0}, faults);
  EXPECT_THAT(torques.all(), testing::ElementsAre(0, 0, 0));
  ASSERT_EQ(faults.raised.size(), 1U);
  EXPECT_EQ(faults.raised[0].kind, ServoFault::Kind::NotANumber);
  EXPECT_EQ(faults.raised[0].part, ServoFault::Part::Actuator);
  EXPECT_EQ(faults.raised[0].index, 1U);
  EXPECT_EQ(faults.raised[0].value, infinity);
}

/// One motor with two harmonics, whose shaft and encoder go either way.
class KnownCogging : public testing::TestWithParam<int> {
 protected:
  /// What is added to no effort where the shaft is `measured`, and was to be at `before` and is to be at `wanted`.
  double added(double measured, double before, double wanted) {
    torques_.cancel_cogging(std::array{before}, std::array{before}, 1);
    torques_.let_go();
    torques_.cancel_cogging(std::array{measured}, std::array{wanted}, 1);
    return torques_[0];
  }
  [[nodiscard]] double at_shaft(double shaft_rad) const {
    const double angle = 2 * std::numbers::pi * (shaft_counts(actuators_[0].scale, shaft_rad) / 1000);
    return GetParam() * (0.02 * std::cos(12 * angle) - 0.05 * std::sin(60 * angle) + 0.01 * std::cos(999 * angle));
  }
  std::vector<ServoActuator> actuators_ = [] {
    std::vector<ServoActuator> made(1);
    made[0].scale = {1000, 1, GetParam(), 123};
    made[0].cogging = {{{12, 0.02, 0}, {60, 0, -0.05}, {999, 0.01, 0}}, 0.0015};
    return made;
  }();
  DirectMap map_;
  ShaftTorques torques_{map_, actuators_, kPeriod};
};
INSTANTIATE_TEST_SUITE_P(Directions, KnownCogging, testing::Values(1, -1));

// Red with the angle of the shaft instead of the encoder's, the sign of the other direction, or no lead.
TEST_P(KnownCogging, IsTakenAwayWhereTheMotorWillBeWhenItsTorqueActs) {
  ASSERT_TRUE(torques_.know_cogging());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1000, 1000), way(-0.3, 0.3);
  for (int i = 0; i < 200; ++i) {
    const double at = place(random), step = way(random), off = way(random) / 100;
    EXPECT_NEAR(added(at + off, at - step, at), -at_shaft(at + off + 1.5 * step), 1e-9);
  }
}

TEST_P(KnownCogging, IsLeftWhereTheMotorIsNotUnderControl) {
  torques_.cancel_cogging(std::array{0.3}, std::array{0.3}, 0);
  EXPECT_EQ(torques_[0], 0);
  torques_.cancel_cogging(std::array{0.3}, std::array{0.3}, 1);
  EXPECT_NEAR(torques_[0], -at_shaft(0.3), 1e-9) << "where it was to be before it was followed is no way";
}

TEST(ShaftTorques, KnowNoCoggingUnlessItIsTold) {
  const DirectMap map;
  const std::vector<ServoActuator> actuators(3);
  EXPECT_FALSE(ShaftTorques(map, actuators, kPeriod).know_cogging());
}

/// A drive in position mode, and two in velocity mode of which the last tells where it was a cycle before.
class ShaftAiming : public testing::Test {
 protected:
  void step(double first, double second, double third, IndexSet followed = 0b111) {
    aims_.step(std::array{first, second, third}, followed, faults_);
  }
  DriveCommand command(std::size_t actuator, double measured_rad) {
    DriveCommand words;
    aims_.command(actuator, measured_rad, words);
    return words;
  }
  static constexpr double kTurn = 2 * std::numbers::pi;
  std::vector<ServoActuator> actuators_ = [] {
    std::vector<ServoActuator> made(3);
    for (ServoActuator& actuator : made) actuator.scale = {1000, 1, 1, 50};
    made[0].mode = DriveMode::CyclicSyncPosition;
    made[1].mode = made[2].mode = DriveMode::CyclicSyncVelocity;
    made[1].position_gain = made[2].position_gain = 20;
    made[2].scale.direction = -1;
    return made;
  }();
  ShaftAims aims_{actuators_, {0, 0, 2}, kPeriod};
  RecordedFaults faults_;
};

TEST_F(ShaftAiming, DriveInPositionModeIsSentTheCountsOfItsAim) {
  step(kTurn / 4, 0, 0);
  EXPECT_TRUE(aims_.sends(0));
  EXPECT_EQ(command(0, 0).target_position_counts, 300);
}

TEST_F(ShaftAiming, DriveInVelocityModeIsSentTheWayOfTheCycleAndAShareOfItsError) {
  step(0, 1, 0);
  EXPECT_NEAR(command(1, 0.9).target_velocity_rpm, 20 * 0.1 * 60 / kTurn, 1e-9) << "its first aim is no way";
  step(0, 1.002, 0);
  EXPECT_NEAR(command(1, 1).target_velocity_rpm, (2 + 20 * 0.002) * 60 / kTurn, 1e-9);
}

TEST_F(ShaftAiming, DriveThatAnswersLateIsHeldToTheAimOfItsAnswer) {
  step(0, 0, 1);
  step(0, 0, 1.001);
  step(0, 0, 1.003);
  EXPECT_NEAR(command(2, 1).target_velocity_rpm, -2 * 60 / kTurn, 1e-9) << "in the drive's sense, without error";
  step(0, 0, 1.006);
  EXPECT_NEAR(command(2, 1.001).target_velocity_rpm, -3 * 60 / kTurn, 1e-9);
  EXPECT_NEAR(command(2, 1).target_velocity_rpm, -(3 + 20 * 0.001) * 60 / kTurn, 1e-9);
}

TEST_F(ShaftAiming, WayOfADriveThatWasLetGoIsNotMadeUp) {
  step(0, 1, 0);
  step(0, 5, 0, 0b101);
  EXPECT_FALSE(aims_.sends(1));
  EXPECT_TRUE(aims_.sends(0));
  step(0, 9, 0);
  EXPECT_NEAR(command(1, 9).target_velocity_rpm, 0, 1e-9);
}

TEST_F(ShaftAiming, NothingIsSentAnywhereWhereAnAimIsNoNumber) {
  step(0, 1, 0);
  step(0, 1, kNaN);
  EXPECT_FALSE(aims_.sends(0));
  EXPECT_FALSE(aims_.sends(1));
  ASSERT_EQ(faults_.raised.size(), 1U);
  EXPECT_EQ(faults_.raised[0].kind, ServoFault::Kind::NotANumber);
  EXPECT_EQ(faults_.raised[0].part, ServoFault::Part::Actuator);
  EXPECT_EQ(faults_.raised[0].index, 2U);
}

TEST_F(ShaftAiming, AimOfADriveThatIsNotFollowedNeedBeNoNumber) {
  step(0, 1, kNaN, 0b011);
  EXPECT_TRUE(aims_.sends(1));
  EXPECT_TRUE(faults_.raised.empty());
}

}  // namespace
}  // namespace rmac::servo_test
