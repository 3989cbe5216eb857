// A joint under velocity control: it goes as fast as the plan says, and makes nothing good that kept it from going.
#include <cmath>
#include <random>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

constexpr double kFollowingError = 1;  // mm, of the fixture's joints
constexpr double kSlip = kFollowingError / 2;
constexpr double kGives = 0.1;  // mm an N, what blocks it

/// Joint 0 under velocity control. Its drive stands exactly where its setpoint is, or is blocked.
class VelocityControlled : public ServoLoopTest {
 protected:
  void start(const JointBounds& bounds = {.stop_deceleration = 1000}) {
    ServoLoopParts made = parts();
    made.joints[0].method = ControlMethod::Velocity;
    made.joints[0].bounds = bounds;
    build(std::move(made));
    engage();
  }
  /// The plan goes at a steady speed, from wherever it is.
  void run(int cycles, double speed) {
    for (int i = 0; i < cycles; ++i) {
      if (!blocked) stands_at = report.position_set[0];
      put_at(0, stands_at + (blocked ? kGives * report.effort[0] : 0));
      command.setpoint.velocity[0] = speed;
      command.setpoint.position[0] += speed * kPeriod;
      const double before = report.velocity_set[0];
      cycle();
      if (i > 0) largest_step = std::max(largest_step, std::abs(report.velocity_set[0] - before));
    }
  }
  [[nodiscard]] double wanted() const { return report.position_set[0]; }
  bool blocked = false;
  double stands_at = 0;
  double largest_step = 0;
};

TEST_F(VelocityControlled, GoesAsFastAsThePlanSays) {
  start();
  run(1000, 12.5);
  EXPECT_NEAR(wanted(), 12.5, 1e-9);
  EXPECT_EQ(report.velocity_set[0], 12.5);
  run(1000, 0);
  EXPECT_NEAR(wanted(), 12.5, 1e-9);
  EXPECT_EQ(report.velocity_set[0], 0);
}

TEST_F(VelocityControlled, SlipsWhereItIsBlockedAndGoesOnFromThere) {
  start();
  run(100, 10);
  blocked = true;
  run(2000, 10);
  EXPECT_EQ(report.state, ServoState::Engaged) << "a joint whose position is controlled stops with FollowingError here";
  EXPECT_NEAR(wanted() - report.position[0], kSlip, 0.011) << "no further ahead than half of MaxFollowingError";
  const double stuck = report.position[0];
  run(60, -10);
  EXPECT_LT(wanted(), stuck) << "and back at once, not after the way that was lost";
  blocked = false;
  const double released = wanted();
  run(1000, 10);
  EXPECT_NEAR(wanted(), released + 10, 1e-9);
}

TEST_F(VelocityControlled, OthersFollowTheirPositions) {
  start();
  command.setpoint.position[1] = 0.5;
  run(1, 10);
  EXPECT_EQ(report.position_set[1], 0.5);
}

TEST_F(VelocityControlled, StopsInTimeAtTheEndsOfItsTravelOverSeededPlans) {
  std::mt19937 random(11);
  constexpr double kDeceleration = 800;
  for (int i = 0; i < 100; ++i) {
    fake = std::make_shared<FakeBus>(5);
    bus = std::make_shared<ServoBus>(fake);
    command = {};
    report = {};
    start({.stop_deceleration = kDeceleration, .min_position = -20, .max_position = 30});
    const double speed = std::uniform_real_distribution(-150.0, 150.0)(random);
    largest_step = 0;
    for (int part = 0; part < 20; ++part) run(50, speed);
    EXPECT_GE(wanted(), -20 - 1e-9);
    EXPECT_LE(wanted(), 30 + 1e-9);
    EXPECT_LE(largest_step, 1.2 * kDeceleration * kPeriod) << "at " << speed << " mm/s";
    if (std::abs(speed) > 40) {
      EXPECT_NEAR(wanted(), speed > 0 ? 30 : -20, 1e-6);
    }
    run(10, -speed);
    EXPECT_EQ(report.velocity_set[0], -speed) << "away from the end it is free";
  }
}

TEST_F(VelocityControlled, StandsWhenTheMachineNoLongerFollows) {
  start();
  run(100, 10);
  command.quick_stop = true;
  run(1, 10);
  EXPECT_EQ(report.velocity_set[0], 0);
}

TEST_F(VelocityControlled, GoesBackToItsPositionInMotionWithoutAStepUnlessItSlippedOverSeededPlans) {
  start();
  std::mt19937 random(5);
  double speed = 0;
  for (int i = 0; i < 200; ++i) {
    loop->set_control_method(0, i % 2 == 0 ? ControlMethod::Velocity : ControlMethod::Position);
    const double next = std::uniform_real_distribution(-20.0, 20.0)(random);
    for (int part = 0; part < 20; ++part) {
      const double before = wanted();
      speed += std::clamp(next - speed, -1.0, 1.0);
      run(1, speed);
      EXPECT_NEAR(wanted() - before, speed * kPeriod, 1e-12) << "cycle " << part << " of change " << i;
      EXPECT_EQ(report.position_set[0], command.setpoint.position[0]) << "it is where the plan has it";
      EXPECT_EQ(loop->slipped(0), 0);
    }
  }
  loop->set_control_method(0, ControlMethod::Velocity);
  blocked = true;
  run(2000, 10);
  EXPECT_NEAR(loop->slipped(0), wanted() - command.setpoint.position[0], 1e-9);
  EXPECT_LT(loop->slipped(0), -15) << "of the 20 mm that were planned";
}

TEST_F(VelocityControlled, TakesItsPlaceAlongToPositionControl) {
  start();
  run(100, 10);
  blocked = true;
  run(500, 10);
  run(1, 0);
  const double held = wanted();
  const ServoHandover handover = loop->handover();
  build(parts());
  loop->engage(handover);
  for (int i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 2; ++j) command.setpoint.position[j] = loop->hold_position()[j];
    command.setpoint.velocity.fill(0);
    cycle();
    EXPECT_NEAR(wanted(), held, 1e-9);
  }
}

TEST_F(VelocityControlled, DriveInVelocityModeIsSentNoMoreThanTheSlipAsks) {
  constexpr double kGain = 20;
  ServoLoopParts made = parts();
  made.joints[0].method = ControlMethod::Velocity;
  made.joints[0].law = nullptr;
  made.actuators[0].mode = DriveMode::CyclicSyncVelocity;
  made.actuators[0].position_gain = kGain;
  build(std::move(made));
  engage();
  blocked = true;
  run(2000, 10);
  const double sent = bus->commands[0].target_velocity_rpm * 2 * std::numbers::pi / 60;
  EXPECT_LE(sent, 10 + kGain * (kSlip + 10 * kPeriod) + 1e-9);
}

}  // namespace
}  // namespace rmac::servo_test
