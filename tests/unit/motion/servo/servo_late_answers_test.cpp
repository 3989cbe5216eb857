// Drives that tell where they were a cycle before, as those on CAN do: what a law and the watches make of it.
#include <random>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

constexpr double kCount = 1 / kCountsPerMm;

class ServoLateAnswers : public ServoLoopTest {
 protected:
  ServoLateAnswers() { fake->late = true; }

  /// Joint 0 goes `step` further; its drive was `behind` in the cycle that it tells of.
  void go_on(double step, double behind = 0) {
    put_at(0, command.setpoint.position[0] - behind);
    command.setpoint.position[0] += step;
    command.setpoint.velocity[0] = step / kPeriod;
    cycle();
  }
  [[nodiscard]] double seen_error() const { return laws[0]->last.position_setpoint - laws[0]->last.position; }
};

TEST_F(ServoLateAnswers, ADriveThatFollowsExactlyHasNoErrorAtAnySpeed) {
  ServoLoopParts made = parts();
  made.joints[0].max_following_error = 0.01;
  build(std::move(made));
  engage();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> change(-0.01, 0.01);
  double step = 0;
  for (int i = 0; i < 5000; ++i) {
    step = std::clamp(step + change(random), -0.5, 0.5);
    go_on(step);
    ASSERT_EQ(report.fault.kind, ServoFault::Kind::None) << "cycle " << i << ", " << step / kPeriod << " mm/s";
    ASSERT_NEAR(seen_error(), 0, kCount) << "cycle " << i;
  }
  EXPECT_EQ(report.position_set[0], command.setpoint.position[0]) << "what is told is what is";
  EXPECT_NEAR(report.position[0], command.setpoint.position[0] - step, kCount) << "and what was measured";
}

TEST_F(ServoLateAnswers, TheSameWordsOfDrivesThatTellWhatIsAreAnError) {
  fake->late = false;
  ServoLoopParts made = parts();
  made.joints[0].max_following_error = 0.01;
  build(std::move(made));
  engage();
  go_on(0.05);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::FollowingError);
}

TEST_F(ServoLateAnswers, ADriveThatIsBehindIsSeenToBeAsFarBehindAsItIs) {
  build();
  engage();
  for (int i = 0; i < 20; ++i) go_on(0.2, 0.3);
  EXPECT_NEAR(seen_error(), 0.3, kCount);
  EXPECT_NEAR(laws[0]->last.velocity_setpoint - laws[0]->last.velocity, 0, 2 * kCount / kPeriod);
  go_on(0.2, 1.1);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::FollowingError);
  EXPECT_NEAR(report.fault.value, 1.1, kCount);
}

TEST_F(ServoLateAnswers, AVelocityDriveThatFollowsIsSentTheSetpointsVelocityAlone) {
  ServoLoopParts made = parts();
  made.joints[0].law = nullptr;
  made.actuators[0].mode = DriveMode::CyclicSyncVelocity;
  made.actuators[0].position_gain = 20;
  build(std::move(made));
  engage();
  for (int i = 0; i < 20; ++i) go_on(0.1);
  // 1 rad a mm.
  EXPECT_NEAR(bus->commands[0].target_velocity_rpm * 2 * std::numbers::pi / 60, 100, 20 * kCount);
}

TEST_F(ServoLateAnswers, TheLawIsEngagedWithoutAnErrorAndAStopEndsOnTheSetpoint) {
  build();
  engage();
  EXPECT_NEAR(seen_error(), 0, kCount);
  for (int i = 0; i < 100; ++i) go_on(0.1);
  for (int i = 0; i < 10; ++i) go_on(0);
  EXPECT_NEAR(seen_error(), 0, kCount);
  EXPECT_EQ(report.position_set[0], command.setpoint.position[0]);
}

}  // namespace
}  // namespace rmac::servo_test
