#include "servo/joints/wiring.hpp"

#include <gmock/gmock.h>

#include "servo/joints/live_joints.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

std::vector<ServoActuator> actuators(std::size_t count, const std::array<int, kMaxJoints>& delays = {}) {
  const auto fake = std::make_shared<FakeBus>(count);
  fake->delays = delays;
  const auto bus = std::make_shared<ServoBus>(fake);
  std::vector<ServoActuator> made;
  for (std::uint32_t i = 0; i < count; ++i) made.push_back({bus, i, {1000, 1, 1, 0}});
  return made;
}

TEST(Wiring, MotorOfAJointOfItsOwnIsAlone) {
  const Wiring wiring(DirectMap(), 3, actuators(3));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(wiring.actuators_of(i), only(i));
    EXPECT_EQ(wiring.sense(i), 1);
    EXPECT_EQ(wiring.joint_of(i), i);
    EXPECT_TRUE(wiring.alone(i));
  }
}

TEST(Wiring, SharedMotorsHaveNoSenseAndAreNotAlone) {
  const Wiring wiring(DifferentialMap(), 3, actuators(3));
  EXPECT_EQ(wiring.actuators_of(0), 0b011U);
  EXPECT_EQ(wiring.actuators_of(1), 0b011U);
  EXPECT_EQ(wiring.sense(0), 0);
  EXPECT_EQ(wiring.sense(1), 0);
  EXPECT_FALSE(wiring.alone(0));
  EXPECT_EQ(wiring.joint_of(2), 2U);
  EXPECT_TRUE(wiring.alone(2));
}

TEST(Wiring, TwoMotorsOfOneJointHaveTheirSenseAndAreNotAlone) {
  const Wiring wiring(GantryMap(), 2, actuators(3));
  EXPECT_EQ(wiring.actuators_of(0), 0b101U);
  EXPECT_EQ(wiring.sense(0), 1);
  EXPECT_EQ(wiring.sense(2), -1);
  EXPECT_EQ(wiring.joint_of(2), 0U);
  EXPECT_FALSE(wiring.alone(0));
  EXPECT_FALSE(wiring.alone(2));
  EXPECT_TRUE(wiring.alone(1));
}

TEST(Wiring, JointsOfMotorsAndMotorsWithinJoints) {
  const Wiring wiring(DifferentialMap(), 3, actuators(3));
  EXPECT_EQ(wiring.joints_of(0b001), 0b011U);
  EXPECT_EQ(wiring.joints_of(0b100), 0b100U);
  EXPECT_EQ(wiring.actuators_within(0b111), 0b111U);
  EXPECT_EQ(wiring.actuators_within(0b101), 0b100U) << "a shared motor needs both of its joints";
}

TEST(Wiring, KnowsWhatDrivesTakeAndWhenTheyTell) {
  auto mixed = actuators(3, {1, 4, 9});
  mixed[1].mode = DriveMode::CyclicSyncVelocity;
  const Wiring wiring(DirectMap(), 3, mixed);
  EXPECT_EQ(wiring.torque_drives(), 0b101U);
  EXPECT_FALSE(wiring.all_take_torque());
  EXPECT_THAT(std::span(wiring.actuator_delays()).first(3), testing::ElementsAre(1, 4, kMostAnswerDelay));
  EXPECT_EQ(wiring.joint_delays(), wiring.actuator_delays());
  const Wiring shared(DifferentialMap(), 3, mixed);
  EXPECT_THAT(std::span(shared.joint_delays()).first(3), testing::ElementsAre(4, 4, kMostAnswerDelay))
      << "by the slowest of its actuators";

  const Wiring prompt(DirectMap(), 3, actuators(3));
  EXPECT_TRUE(prompt.all_take_torque());
  EXPECT_EQ(prompt.joint_delays(), Wiring::Delays{});
}

TEST(LiveJoints, AreTakenOneByOneAndLetGo) {
  LiveJoints live;
  live.take(1);
  live.take(2);
  EXPECT_FALSE(live[0]);
  EXPECT_TRUE(live[1]);
  EXPECT_FALSE(live.handed(1));
  live.let_go(only(1));
  EXPECT_EQ(live.all(), only(2));
}

TEST(LiveJoints, ThatWereHandedOverWaitForTheirLaws) {
  LiveJoints live;
  live.take_over(0b101);
  EXPECT_TRUE(live[0]);
  EXPECT_TRUE(live.handed(0));
  live.let_go(only(0));
  EXPECT_FALSE(live.handed(0));
  EXPECT_TRUE(live.handed(2));
  live.engaged();
  EXPECT_FALSE(live.handed(2));
  EXPECT_EQ(live.all(), 0b100U);
}

}  // namespace
}  // namespace rmac::servo_test
