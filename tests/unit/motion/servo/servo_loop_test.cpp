#include <limits>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {

TEST_F(ServoLoopTest, SendsNoTorqueWhileOff) {
  build();
  put_at(0, 12.5);
  cycle(3);
  EXPECT_EQ(report.state, ServoState::Off);
  EXPECT_FALSE(report.follows);
  EXPECT_EQ(bus->commands[0].controlword, 0);
  EXPECT_EQ(torque(0), 0);
  EXPECT_NEAR(report.position[0], 12.5, 1e-9);
  EXPECT_NEAR(loop->hold_position()[0], 12.5, 1e-9);
}

TEST_F(ServoLoopTest, EngagesWhereTheJointsStand) {
  build();
  put_at(0, 12.5);
  put_at(1, -3);
  put_at(2, 7);
  engage();
  EXPECT_NEAR(report.position_set[0], 12.5, 1e-9);
  EXPECT_NEAR(report.position_set[1], -3, 1e-9);
  EXPECT_NEAR(report.position_set[2], 7, 1e-9);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(torque(axis), 0);
  for (const auto& law : laws) EXPECT_EQ(law->engaged, 1);
}

TEST_F(ServoLoopTest, GivesItsLawsTheEffortLimit) {
  build();
  EXPECT_EQ(laws[0]->limit, 5);
}

// Red when what a drive measured is answered a cycle later: at 1 kHz that is a third of a loop's delay.
TEST_F(ServoLoopTest, TurnsAnErrorIntoTorqueInItsOwnCycle) {
  build();
  engage();
  command.setpoint.position[0] = 0.5;
  cycle();
  EXPECT_EQ(torque(0), 50);  // 0.1 N/mm · 0.5 mm, in per mille of 1 N·m
  EXPECT_EQ(fake->drives[0].command.target_torque_permille, 50);
  EXPECT_EQ(fake->drives[0].command.mode, DriveMode::CyclicSyncTorque);
}

TEST_F(ServoLoopTest, HonoursTheDrivesSenseAndHome) {
  ServoLoopParts reversed = parts();
  reversed.actuators[0].scale.direction = -1;
  reversed.actuators[0].scale.home_counts = 2000;
  build(std::move(reversed));
  put_at(0, 12);
  engage();
  EXPECT_NEAR(report.position[0], -10, 1e-9);
  command.setpoint.position[0] = -9.5;
  cycle();
  EXPECT_EQ(torque(0), -50);
}

TEST_F(ServoLoopTest, ClampsTheEffortToItsBound) {
  build();
  engage();
  laws[0]->bias = 100;
  cycle();
  EXPECT_EQ(report.effort[0], 5);
  EXPECT_EQ(torque(0), 5000);
}

TEST_F(ServoLoopTest, FollowsCountsThroughTheirWrap) {
  build();
  constexpr double kWrap = 2147483.648;  // 2^31 counts in mm
  put_at(0, kWrap - 0.002);
  cycle();
  const double before = report.position[0];
  put_at(0, kWrap + 0.003);
  cycle();
  EXPECT_NEAR(report.position[0] - before, 0.005, 1e-6);
}

TEST_F(ServoLoopTest, MeasuresASteadilyAcceleratedVelocityWithoutLag) {
  build();
  for (int i = 0; i <= 10; ++i) {
    const double t = i * 1e-3;
    put_at(0, 2000 * t * t + 1000 * t);  // whole counts: 2·i² + 1000·i
    cycle();
    if (i < 2) continue;
    EXPECT_NEAR(report.velocity[0], 4000 * t + 1000, 1e-6) << "cycle " << i;
  }
}

TEST_F(ServoLoopTest, HoldsTheHeldJointWhateverTheSetpointSays) {
  build();
  put_at(2, 7);
  engage();
  command.setpoint.position[2] = 100;
  cycle(5);
  EXPECT_NEAR(report.position_set[2], 7, 1e-9);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
  put_at(2, 6.5);
  cycle();
  EXPECT_EQ(torque(2), 50);
}

TEST_F(ServoLoopTest, ReportsTheToolInThePartFrameAndItsSpeed) {
  build();
  command.frames.part.p = {1, 0, 0};
  command.frames.tool.p = {0, 0, 80};
  for (int i = 0; i < 5; ++i) {
    put_at(0, 3 * i * 1e-3);
    put_at(1, 4 * i * 1e-3);
    cycle();
  }
  EXPECT_NEAR(report.pose.tip[0], 0.012 - 1, 1e-9);
  EXPECT_NEAR(report.pose.tip[1], 0.016, 1e-9);
  EXPECT_NEAR(report.pose.tip[2], 80, 1e-9);
  EXPECT_NEAR(report.feed_mm_s, 5, 1e-9);
}

TEST_F(ServoLoopTest, PassesTheSpindlesSpeedWithinItsBound) {
  build();
  engage();
  command.spindle_rpm[0] = 700;
  cycle();
  EXPECT_EQ(bus->commands[3].target_velocity_rpm, 700);
  EXPECT_EQ(bus->commands[3].mode, DriveMode::ProfileVelocity);
  command.spindle_rpm[0] = 1e9;
  cycle();
  EXPECT_EQ(bus->commands[3].target_velocity_rpm, 1000);
  fake->drives[3].words.velocity_rpm = 640;
  cycle();
  EXPECT_EQ(report.spindle_rpm[0], 640);
}

TEST_F(ServoLoopTest, LeavesForeignAxesDisabled) {
  bus->commands[4].controlword = 0x0F;
  build();
  engage();
  EXPECT_EQ(bus->commands[4].controlword, 0);
}

TEST_F(ServoLoopTest, GoesOffWithoutPower) {
  build();
  engage();
  command.power = false;
  cycle();
  EXPECT_EQ(report.state, ServoState::Off);
  EXPECT_EQ(bus->commands[0].controlword, 0);
  command.power = true;
  engage();
}

TEST_F(ServoLoopTest, QuickStopsEveryDriveAtOnceWhenAsked) {
  build();
  engage();
  command.spindle_rpm[0] = 500;
  command.quick_stop = true;
  cycle();
  EXPECT_EQ(report.state, ServoState::QuickStop);
  EXPECT_FALSE(report.follows);
  expect_all_quick_stopped();
  command.quick_stop = false;
  cycle(10);
  EXPECT_EQ(report.state, ServoState::QuickStop) << "power must fall before drives are enabled again";
  command.power = false;
  cycle();
  EXPECT_EQ(report.state, ServoState::Off);
  engage();
}

TEST_F(ServoLoopTest, GivesADriveTheRestingEffortBesideTheWordThatEnablesIt) {
  build();
  laws[2]->resting = 0.4;
  laws[1]->resting = 100;  // more than the joint may get
  fake->drives[1].stuck = true;
  cycle(3);
  EXPECT_EQ(torque(2), 0) << "nobody asked for power";
  command.power = true;
  for (int i = 0; i < 20 && fake->drives[2].words.statusword != 0x27; ++i) cycle();
  ASSERT_EQ(fake->drives[2].words.statusword, 0x27);
  EXPECT_EQ(fake->drives[2].command.target_torque_permille, 400) << "in the very exchange that enabled it";
  EXPECT_EQ(torque(1), 5000) << "the joint's largest effort, still waiting for its drive";
  cycle(5);
  EXPECT_EQ(laws[2]->engaged, 1);
  EXPECT_EQ(torque(2), 400) << "the law goes on from there";
  fake->drives[1].stuck = false;
  engage();
  EXPECT_EQ(torque(2), 400);
  laws[0]->answer_nan = true;
  cycle(2);
  ASSERT_EQ(report.state, ServoState::Faulted);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(torque(axis), 0);
}

TEST_F(ServoLoopTest, TouchesNoBusInVirtualMode) {
  ServoLoopParts virtual_parts = parts();
  virtual_parts.virtual_mode = true;
  virtual_parts.virtual_start = {1, 2, 3};
  build(std::move(virtual_parts));
  engage();
  EXPECT_EQ(report.position_set[1], 2);
  command.setpoint.position[0] = 1.25;
  command.setpoint.velocity[0] = 3;
  command.spindle_rpm[0] = 500;
  cycle();
  EXPECT_EQ(report.position[0], 1.25);
  EXPECT_EQ(report.velocity[0], 3);
  EXPECT_EQ(report.position[2], 3);
  EXPECT_EQ(report.feed_mm_s, 3);
  EXPECT_EQ(report.spindle_rpm[0], 500);
  EXPECT_EQ(fake->exchanges, 0);
}

struct Misfit {
  const char* name;
  void (*spoil)(ServoLoopParts&);
  const char* message;
};

class ServoLoopMisfit : public ServoLoopTest, public testing::WithParamInterface<Misfit> {};

TEST_P(ServoLoopMisfit, IsRefused) {
  ServoLoopParts wrong = parts();
  GetParam().spoil(wrong);
  const auto made = ServoLoop::create(std::move(wrong));
  ASSERT_FALSE(made.has_value());
  EXPECT_NE(made.error().message.find(GetParam().message), std::string::npos) << made.error().message;
}

INSTANTIATE_TEST_SUITE_P(
    Each, ServoLoopMisfit,
    testing::Values(
        Misfit{"NoKinematics", [](auto& p) { p.kinematics = nullptr; }, "kinematics or actuator map is missing"},
        Misfit{"TooFewJoints", [](auto& p) { p.joints.pop_back(); }, "is for 3 joints, but 2 are configured"},
        Misfit{"TooFewActuators", [](auto& p) { p.actuators.pop_back(); }, "is for 3 actuators, but 2"},
        Misfit{"NoLaw", [](auto& p) { p.joints[1].law = nullptr; }, "joint 1 has no servo law"},
        Misfit{"ForceWithoutItsNumbers", [](auto& p) { p.joints[1].method = ControlMethod::Force; },
               "under force control, which needs an approach speed"},
        Misfit{"NoBound", [](auto& p) { p.joints[1].max_following_error = 0; }, "needs a following-error bound"},
        Misfit{"AxisBeyondTheBus", [](auto& p) { p.actuators[1].axis = 9; }, "axis 9, but its bus has 5 axes"},
        Misfit{"AxisTakenTwice", [](auto& p) { p.actuators[1].axis = 3; }, "spindle 0 is bus axis 3, which is taken"},
        Misfit{"NoRatedTorque", [](auto& p) { p.actuators[1].scale.rated_torque_nm = 0; }, "a rated torque above 0"},
        Misfit{"NoPeriod", [](auto& p) { p.period_s = 0; }, "the period must be above 0"}),
    [](const auto& each) { return each.param.name; });

}  // namespace rmac::servo_test
