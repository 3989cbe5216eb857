#include <gmock/gmock.h>

#include <limits>

#include "servo/drives/shaft_aims.hpp"
#include "servo/drives/shaft_torques.hpp"
#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(ShaftTorques, AreThoseThatGiveTheJointsTheirEfforts) {
  const DifferentialMap map;
  ShaftTorques torques(map, 3);
  RecordedFaults faults;
  torques.make(std::array{0.0, 0.0, 0.0}, std::array{4.0, 2.0, 7.0}, faults);
  EXPECT_THAT(torques.all(), testing::ElementsAre(3, 1, 7));
  EXPECT_TRUE(faults.raised.empty());
  torques.let_go();
  EXPECT_THAT(torques.all(), testing::ElementsAre(0, 0, 0));
}

TEST(ShaftTorques, NoneIsLeftWhereOneIsNoNumber) {
  const DirectMap map;
  ShaftTorques torques(map, 3);
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
