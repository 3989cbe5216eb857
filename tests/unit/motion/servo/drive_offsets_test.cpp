// What drives that follow a position or a velocity get beside it: the velocity of their setpoint, and the torque that
// the joint's law says its motion takes.
#include <gmock/gmock.h>

#include <random>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

/// Mass, damping and load, and a part for the error, which must not be seen.
class ModelLaw : public RecordingLaw {
 public:
  [[nodiscard]] double resting_effort() const noexcept override { return load; }
  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    last = input;
    return model(input.velocity_setpoint, input.acceleration_setpoint) +
           100 * (input.position_setpoint - input.position) + 10 * (input.velocity_setpoint - input.velocity) + bias;
  }
  [[nodiscard]] double model(double v, double a) const { return load + 0.002 * v + 0.0005 * a; }
  double load = -0.7;
};

/// Joint 0 is moved by a drive that follows it; the motion is a sum of sines that begins at rest.
class DriveOffsets : public ServoLoopTest {
 protected:
  ServoLoopParts with(DriveMode mode, int direction) {
    fake->torque_offset = true;
    ServoLoopParts made = parts();
    law = std::make_shared<ModelLaw>();
    made.joints[0].law = law;
    made.joints[0].max_effort = 50;
    made.joints[0].bounds.stop_deceleration = 2000;
    made.joints[0].bounds.stop_jerk = 100'000;
    made.actuators[0].mode = mode;
    made.actuators[0].scale.direction = direction;
    made.actuators[0].scale.home_counts = 1234;
    if (mode == DriveMode::CyclicSyncVelocity) made.actuators[0].position_gain = 20;
    return made;
  }
  void begin(unsigned seed) {
    random.seed(seed);
    for (double& frequency : frequencies) frequency = std::uniform_real_distribution(0.5, 4.0)(random);
    t = 0;
  }
  void step_setpoint() {
    t += kPeriod;
    command.setpoint.position[0] = start;
    command.setpoint.velocity[0] = command.setpoint.acceleration[0] = 0;
    for (const double f : frequencies) {
      const double w = 2 * std::numbers::pi * f;
      command.setpoint.position[0] += 5 * (1 - std::cos(w * t));
      command.setpoint.velocity[0] += 5 * w * std::sin(w * t);
      command.setpoint.acceleration[0] += 5 * w * w * std::cos(w * t);
    }
  }
  /// The drive follows, and is off by up to 0.2 mm.
  void follow(int direction) {
    const double off = std::uniform_real_distribution(-0.2, 0.2)(random);
    fake->drives[0].words.position_counts =
        1234 + direction * static_cast<int>(std::lround((command.setpoint.position[0] + off) * kCountsPerMm));
  }
  void stand_at(double mm, int direction) {
    start = mm;
    fake->drives[0].words.position_counts = 1234 + direction * static_cast<int>(std::lround(mm * kCountsPerMm));
  }
  [[nodiscard]] const DriveCommand& words(std::size_t axis = 0) const { return bus->commands[axis]; }
  /// Counts that the velocity beside the position goes in a cycle.
  [[nodiscard]] double offset_counts() const {
    return words().velocity_offset_rpm / 60 * kScale.counts_per_revolution * kPeriod;
  }

  std::shared_ptr<ModelLaw> law;
  std::mt19937 random;
  std::array<double, 3> frequencies{};
  double t = 0, start = 0;
};

// Red with a sign that is not the drive's, another moment's velocity, or one of the measured motion.
TEST_F(DriveOffsets, VelocityBesideThePositionAddsUpToThePosition) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const int direction = seed % 2 == 0 ? 1 : -1;
    report = {};
    command = {};
    build(with(DriveMode::CyclicSyncPosition, direction));
    begin(seed);
    stand_at(3.5, direction);
    engage();
    const double from = words().target_position_counts;
    ASSERT_EQ(words().velocity_offset_rpm, 0);
    double sum = 0;
    for (int i = 0; i < 500; ++i) {
      step_setpoint();
      cycle();
      sum += offset_counts();
      ASSERT_NEAR(from + sum, words().target_position_counts, 1.01) << "seed " << seed << " cycle " << i;
      follow(direction);
    }
    EXPECT_GT(std::abs(sum), 100) << "it hardly moved";
  }
}

// Red where an error reaches the law, or the torque is not the drive's in sign and unit.
TEST_F(DriveOffsets, TorqueBesideIsWhatTheMotionTakesWhateverTheError) {
  for (const DriveMode mode : {DriveMode::CyclicSyncPosition, DriveMode::CyclicSyncVelocity}) {
    for (const int direction : {1, -1}) {
      report = {};
      command = {};
      build(with(mode, direction));
      begin(7);
      stand_at(-2, direction);
      engage();
      EXPECT_EQ(law->engaged, 0) << "nothing of an earlier torque stays in it";
      EXPECT_EQ(words().torque_offset_permille, direction * -700) << "a load is held";
      for (int i = 0; i < 300; ++i) {
        step_setpoint();
        cycle();
        const double wanted =
            law->model(command.setpoint.velocity[0], command.setpoint.acceleration[0]) * 1000 * direction;
        ASSERT_NEAR(words().torque_offset_permille, wanted, 0.51) << "cycle " << i;
        ASSERT_EQ(words().target_torque_permille, 0);
        if (mode == DriveMode::CyclicSyncVelocity) {
          ASSERT_EQ(words().velocity_offset_rpm, 0) << "60FFh has all of it";
        }
        follow(direction);
      }
    }
  }
}

TEST_F(DriveOffsets, KeepWithinTheirWordsAndTheJointsBound) {
  for (const double load : {1e6, -1e6}) {
    report = {};
    command = {};
    ServoLoopParts made = with(DriveMode::CyclicSyncPosition, 1);
    law->load = load;
    build(std::move(made));
    engage();
    cycle();
    EXPECT_EQ(words().torque_offset_permille, load > 0 ? 32767 : -32767) << "50 N are more than the word holds";
    made = with(DriveMode::CyclicSyncPosition, 1);
    law->load = load;
    made.joints[0].max_effort = 2;
    report = {};
    command = {};
    build(std::move(made));
    engage();
    cycle();
    EXPECT_EQ(words().torque_offset_permille, load > 0 ? 2000 : -2000);
  }
}

// Red where a word of the last cycle stays.
TEST_F(DriveOffsets, AreZeroWithoutPowerAndOfADriveThatTakesTorque) {
  build(with(DriveMode::CyclicSyncPosition, 1));
  begin(3);
  stand_at(0, 1);
  for (int i = 0; i < 5; ++i) {
    cycle();
    EXPECT_EQ(words().torque_offset_permille, 0);
    EXPECT_EQ(words().velocity_offset_rpm, 0);
  }
  engage();
  for (int i = 0; i < 100; ++i) {
    step_setpoint();
    cycle();
    follow(1);
  }
  EXPECT_NE(words().torque_offset_permille, 0);
  EXPECT_NE(words().velocity_offset_rpm, 0);
  for (std::size_t axis = 1; axis < 3; ++axis) {
    EXPECT_EQ(words(axis).torque_offset_permille, 0);
    EXPECT_EQ(words(axis).velocity_offset_rpm, 0);
  }
  command.power = false;
  for (int i = 0; i < 5; ++i) {
    cycle();
    EXPECT_EQ(words().torque_offset_permille, 0);
    EXPECT_EQ(words().velocity_offset_rpm, 0);
  }
}

// Red where a stop brakes the position, and leaves the offsets with the plan.
TEST_F(DriveOffsets, GoWithThePositionWhileAStopBrakesIt) {
  build(with(DriveMode::CyclicSyncPosition, 1));
  begin(5);
  stand_at(0, 1);
  engage();
  double position = words().target_position_counts;
  for (int i = 0; i < 60; ++i) {
    step_setpoint();
    cycle();
    follow(1);
  }
  ASSERT_GT(std::abs(command.setpoint.velocity[0]), 20);
  fake->drives[1].words.online = false;  // the rest brakes without it
  double before = words().velocity_offset_rpm;
  position = words().target_position_counts;
  int braking = 0;
  for (int i = 0; i < 400; ++i) {
    cycle();
    if (report.state != ServoState::Faulted) continue;
    if (drive_state(fake->drives[0].words.statusword) != DriveState::OperationEnabled) break;
    const double gone = words().target_position_counts - position;
    ASSERT_NEAR(gone, offset_counts(), 1.01) << "cycle " << i;
    ASSERT_NEAR(words().torque_offset_permille,
                1000 * law->model(law->last.velocity_setpoint, law->last.acceleration_setpoint), 0.51);
    ASSERT_NEAR(words().velocity_offset_rpm, before, 3000 * kPeriod * 60 / (2 * std::numbers::pi)) << "no step";
    if (words().velocity_offset_rpm != 0) ++braking;
    before = words().velocity_offset_rpm;
    position = words().target_position_counts;
    fake->drives[0].words.position_counts = words().target_position_counts;
  }
  EXPECT_GT(braking, 5) << "it did not brake";
}

TEST_F(DriveOffsets, LawIsRefusedWhereTheDriveTakesNoTorqueBeside) {
  ServoLoopParts made = with(DriveMode::CyclicSyncPosition, 1);
  fake->torque_offset = false;
  const auto built = ServoLoop::create(std::move(made));
  ASSERT_FALSE(built);
  EXPECT_THAT(built.error().message, testing::HasSubstr("60B2h in rpdo"));
}

}  // namespace
}  // namespace rmac::servo_test
