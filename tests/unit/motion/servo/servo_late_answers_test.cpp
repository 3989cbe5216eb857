// Drives that tell where they were a cycle before, as those on CAN do, or several: what a law and the watches make of
// it.
#include <deque>
#include <random>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

constexpr double kCount = 1 / kCountsPerMm;

/// The parameter: so many cycles before.
class ServoLateAnswers : public ServoLoopTest, public testing::WithParamInterface<int> {
 protected:
  ServoLateAnswers() { fake->delays.fill(GetParam()); }

  /// Joint 0 goes `step` further; its drive was `behind` in the cycle that it tells of.
  void go_on(double step, double behind = 0) {
    was_.push_back(command.setpoint.position[0]);
    if (was_.size() > static_cast<std::size_t>(GetParam())) was_.pop_front();
    put_at(0, was_.front() - behind);
    command.setpoint.position[0] += step;
    command.setpoint.velocity[0] = step / kPeriod;
    cycle();
  }
  [[nodiscard]] double seen_error() const { return laws[0]->last.position_setpoint - laws[0]->last.position; }

  std::deque<double> was_;  ///< setpoints of the last cycles
};

TEST_P(ServoLateAnswers, ADriveThatFollowsExactlyHasNoErrorAtAnySpeed) {
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
    ASSERT_NEAR(report.following_error[0], 0, kCount) << "as it is told, in cycle " << i;
  }
  EXPECT_EQ(report.position_set[0], command.setpoint.position[0]) << "what is told is what is";
  EXPECT_NEAR(report.position[0], was_.front(), kCount) << "and what was measured";
}

TEST_P(ServoLateAnswers, TheSameWordsOfDrivesThatAnswerACycleSoonerAreAnError) {
  fake->delays.fill(GetParam() - 1);
  ServoLoopParts made = parts();
  made.joints[0].max_following_error = 0.01;
  build(std::move(made));
  engage();
  for (int i = 0; i < GetParam(); ++i) go_on(0.05);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::FollowingError);
}

TEST_P(ServoLateAnswers, ADriveThatIsBehindIsSeenToBeAsFarBehindAsItIs) {
  build();
  engage();
  for (int i = 0; i < 20; ++i) go_on(0.2, 0.3);
  EXPECT_NEAR(seen_error(), 0.3, kCount);
  EXPECT_NEAR(report.following_error[0], 0.3, kCount);
  EXPECT_NEAR(laws[0]->last.velocity_setpoint - laws[0]->last.velocity, 0, 2 * kCount / kPeriod);
  go_on(0.2, 1.1);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::FollowingError);
  EXPECT_NEAR(report.fault.value, 1.1, kCount);
  EXPECT_EQ(report.following_error[0], report.fault.value) << "what stops it is what is told";
}

TEST_P(ServoLateAnswers, AVelocityDriveThatFollowsIsSentTheSetpointsVelocityAlone) {
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

TEST_P(ServoLateAnswers, TheLawIsEngagedWithoutAnErrorAndAStopEndsOnTheSetpoint) {
  build();
  engage();
  EXPECT_NEAR(seen_error(), 0, kCount);
  for (int i = 0; i < 100; ++i) go_on(0.1);
  EXPECT_NEAR(seen_error(), 0, kCount);
  for (int i = 0; i < 10; ++i) go_on(0);
  EXPECT_NEAR(seen_error(), 0, kCount);
  EXPECT_EQ(report.position_set[0], command.setpoint.position[0]);
}

// Red when the way that was gone before a joint went under control counts.
TEST_P(ServoLateAnswers, AJointThatIsEngagedAnewHasNoErrorWhereverItWasPut) {
  build();
  engage();
  for (int i = 0; i < 20; ++i) go_on(0.1);
  command.power = false;
  cycle(20);
  ASSERT_EQ(report.state, ServoState::Off);
  put_at(0, -30);
  cycle(5);
  was_.clear();
  engage();
  EXPECT_NEAR(seen_error(), 0, kCount);
}

// Red when the way of a joint that nobody controls is taken for that of its setpoint.
TEST_P(ServoLateAnswers, AJointThatIsPushedByHandIsInNoError) {
  build();
  for (int i = 0; i < 30; ++i) {
    put_at(0, 0.3 * i);
    cycle();
    ASSERT_EQ(report.following_error[0], 0);
  }
  EXPECT_NEAR(report.position[0], 8.7, kCount);
  EXPECT_EQ(report.answer_delay[0], GetParam());
}

TEST_P(ServoLateAnswers, InVirtualModeNothingIsLate) {
  ServoLoopParts made = parts();
  made.virtual_mode = true;
  made.virtual_start = {1, 2, 3};
  build(std::move(made));
  engage();
  for (int i = 0; i < 30; ++i) {
    go_on(0.3);
    ASSERT_EQ(report.following_error[0], 0);
  }
  EXPECT_NEAR(report.position[0], 10, 1e-9);
  EXPECT_EQ(report.answer_delay[0], 0);
}

// Red when the way since its answer counts as what kept it from going.
TEST_P(ServoLateAnswers, UnderVelocityControlItSlipsNowhereAsLongAsItFollows) {
  ServoLoopParts made = parts();
  made.joints[0].method = ControlMethod::Velocity;
  build(std::move(made));
  engage();
  const double step = 0.8 / GetParam();  // seen to be behind by more than half of MaxFollowingError
  for (int i = 0; i < 100; ++i) {
    go_on(step);
    ASSERT_EQ(report.position_set[0], command.setpoint.position[0]) << "cycle " << i;
  }
  EXPECT_EQ(loop->slipped(0), 0);
  command.setpoint.velocity[0] = 80;
  for (int i = 0; i < 200; ++i) {  // it is blocked
    command.setpoint.position[0] += 0.08;
    cycle();
    ASSERT_EQ(report.state, ServoState::Engaged) << "cycle " << i;
  }
  EXPECT_LT(loop->slipped(0), -14);
  EXPECT_NEAR(report.following_error[0], std::min(0.5 + 0.08 * GetParam(), 0.9 - 0.08) + 0.08, 0.02)
      << "half of MaxFollowingError, the way of the cycles until it tells where it is, and that of one";
}

TEST_P(ServoLateAnswers, AJointUnderVelocityControlMayBeBlockedAtAnySpeed) {
  for (const double step : {0.02, 0.2, 0.3, 0.4, 0.45}) {
    ServoLoopParts made = parts();
    made.joints[0].method = ControlMethod::Velocity;
    build(std::move(made));
    engage();
    command.setpoint.velocity[0] = step / kPeriod;
    for (int i = 0; i < 200; ++i) {
      command.setpoint.position[0] += step;
      cycle();
      ASSERT_EQ(report.state, ServoState::Engaged) << step << " mm a cycle, cycle " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cycles, ServoLateAnswers, testing::Values(1, 2, 3, 5, kMostAnswerDelay));

}  // namespace
}  // namespace rmac::servo_test
