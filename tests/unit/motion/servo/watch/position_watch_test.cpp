// Whether the servo loop believes what drives tell of their positions, and what it does where it does not.
#include <gmock/gmock.h>

#include <random>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using testing::DoubleNear;

/// Drives whose positions can be read beside their answers.
class ReadableBus final : public FakeBus {
 public:
  using FakeBus::FakeBus;
  [[nodiscard]] bool reads_positions(std::size_t) const noexcept override { return true; }
  [[nodiscard]] bool send(std::span<const DriveCommand> commands) noexcept override {
    for (std::size_t i = 0; i < drives.size(); ++i) {
      if (!commands[i].read_position || !reads || exchanges % 4 != 0) continue;
      drives[i].words.position_read_counts = truth[i] ? *truth[i] : drives[i].words.position_counts;
      ++drives[i].words.position_reads;
    }
    return FakeBus::send(commands);
  }
  bool reads = true;
  std::array<std::optional<std::int32_t>, 5> truth{};  ///< where it differs from what is answered
};

class PositionDoubts : public ServoLoopTest {
 protected:
  static constexpr double kMaxVelocity = 200;  // mm/s, 0.2 mm a cycle
  static constexpr double kMaxJump = 0.6;      // mm

  PositionDoubts() {
    readable = std::make_shared<ReadableBus>(5);
    fake = readable;
    bus = std::make_shared<ServoBus>(fake);
  }
  ServoLoopParts bounded() {
    ServoLoopParts made = parts();
    for (ServoJoint& joint : made.joints) joint.bounds = {kMaxVelocity, kMaxJump, 1000};
    return made;
  }
  /// The plan begins where the joints stand.
  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      loop->cycle(command, report);
      for (std::size_t j = 0; j < 2 && !report.follows; ++j) command.setpoint.position[j] = loop->hold_position()[j];
    }
  }
  void random_words(std::size_t axis, int cycles, unsigned seed = 1) {
    const std::int32_t before = fake->drives[axis].words.position_counts;
    std::uint32_t state = seed;
    for (int i = 0; i < cycles; ++i) {
      state = state * 1664525U + 1013904223U;
      fake->drives[axis].words.position_counts = static_cast<std::int32_t>(state);
      readable->truth[axis] = before;
      cycle();
    }
    fake->drives[axis].words.position_counts = before;
    readable->truth[axis].reset();
  }
  void power_off() {
    command.power = false;
    cycle(5);
  }
  void reset() {
    command.power = false;
    command.reset = true;
    cycle(100);
    command.reset = false;
    cycle();
  }
  /// The joint is moved while its drive is silent, and is told of then.
  void move_in_silence(std::size_t axis, double mm) {
    fake->drives[axis].words.online = false;
    cycle(3);
    put_at(axis, mm);
    cycle(3);
    fake->drives[axis].words.online = true;
  }
  void expect_displaced(std::uint32_t joint, double by) const {
    EXPECT_EQ(report.state, ServoState::Faulted);
    EXPECT_STREQ(to_string(report.fault.kind), "Displaced");
    EXPECT_EQ(report.fault.part, ServoFault::Part::Joint);
    EXPECT_EQ(report.fault.index, joint);
    EXPECT_NEAR(report.fault.value, by, 1e-6);
    EXPECT_EQ(report.fault.bound, kMaxJump);
  }
  /// As `engage`, but what comes of it is the test's.
  void try_power() {
    command.power = true;
    cycle(40);
  }

  std::shared_ptr<ReadableBus> readable;
};

// Red when unwrapping has no bound: random words add up to whole wraps, 4 294 967.296 mm each.
TEST_F(PositionDoubts, RandomWordsOfADriveThatIsOffMoveNoJoint) {
  build(bounded());
  put_at(0, 12.5);
  cycle(20);
  random_words(0, 1000);
  cycle(20);
  EXPECT_NEAR(report.position[0], 12.5, 1e-6);
  engage();
  EXPECT_NEAR(report.position[0], 12.5, 1e-6);
}

TEST_F(PositionDoubts, RandomWordsUnderPowerStopTheMachineAndCostTheReference) {
  build(bounded());
  put_at(0, 12.5);
  engage();
  random_words(0, 300);
  EXPECT_STREQ(to_string(report.fault.kind), "EncoderJump");
  EXPECT_NEAR(report.position[0], 12.5, 1e-6);
  reset();
  EXPECT_EQ(report.state, ServoState::Off);
  EXPECT_NEAR(report.position[0], 12.5, 1e-6);
  EXPECT_EQ(report.reference_lost, 1U);
  engage();
  EXPECT_EQ(report.reference_lost, 1U) << "power gives no reference";
}

TEST_F(PositionDoubts, BurstsOfRandomWordsNeverMoveAJointWhereverAndWheneverTheyCome) {
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&](int most) { return std::uniform_int_distribution<int>(0, most - 1)(random); };
    const bool under_power = below(2) == 0;
    const auto axis = static_cast<std::size_t>(below(2));
    const std::array<double, 2> stands{0.1 * below(1000) - 50, 0.1 * below(1000) - 50};
    build(bounded());
    command = ServoCommand{};
    report = ServoReport{};
    for (std::size_t j = 0; j < 2; ++j) put_at(j, stands[j]);
    cycle(20);
    if (under_power) engage();
    cycle(below(30));
    random_words(axis, 1 + below(40), static_cast<unsigned>(random()));
    cycle(20);
    for (std::size_t j = 0; j < 2; ++j) ASSERT_NEAR(report.position[j], stands[j], 1e-6) << "seed " << seed;
    if (under_power) {
      ASSERT_STREQ(to_string(report.fault.kind), "EncoderJump") << "seed " << seed;
      ASSERT_EQ(report.fault.index, axis) << "seed " << seed;
      reset();
      ASSERT_EQ(report.reference_lost, 1U << axis) << "seed " << seed;
    }
    engage();
    for (std::size_t j = 0; j < 2; ++j) {
      ASSERT_NEAR(report.position[j], stands[j], 1e-6) << "seed " << seed;
      ASSERT_NEAR(report.position_set[j], stands[j], 1e-6) << "seed " << seed;
    }
  }
}

// Red when the first word is believed: the loop would begin somewhere else, and take its drive there.
TEST_F(PositionDoubts, FirstPositionHasToBeReadBesideTheAnswersBeforePower) {
  build(bounded());
  readable->reads = false;
  put_at(0, 12.5);
  command.power = true;
  cycle(20);
  EXPECT_EQ(report.state, ServoState::Enabling);
  EXPECT_EQ(fake->drives[0].words.statusword, 0x40) << "it got power though nobody knows where it is";
  EXPECT_TRUE(bus->commands[0].read_position);
  readable->reads = true;
  cycle(20);
  EXPECT_EQ(report.state, ServoState::Engaged);
  EXPECT_FALSE(bus->commands[0].read_position) << "what is known is not asked for";
}

TEST_F(PositionDoubts, FirstWordThatIsWrongIsPutRight) {
  build(bounded());
  put_at(0, -983039.96);
  cycle();
  put_at(0, 3);
  cycle(20);
  EXPECT_NEAR(report.position[0], 3, 1e-6);
  engage();
}

TEST_F(PositionDoubts, DriveThatTellsTwoPositionsIsNotEnabled) {
  build(bounded());
  readable->truth[0] = 11400;  // the other answer is 0
  try_power();
  EXPECT_NE(report.state, ServoState::Engaged);
  EXPECT_EQ(fake->drives[0].words.statusword, 0x40);
}

// Red when a position that is read otherwise than it is answered is passed over under power.
TEST_F(PositionDoubts, AnAnswerThatIsLostHasThePositionReadAndAnotherOneStops) {
  build(bounded());
  engage();
  fake->drives[0].words.missed = true;
  cycle();
  fake->drives[0].words.missed = false;
  cycle(10);
  EXPECT_EQ(report.state, ServoState::Engaged) << "it is where it said";
  fake->drives[0].words.missed = true;
  readable->truth[0] = 11400;
  cycle();
  fake->drives[0].words.missed = false;
  cycle(10);
  EXPECT_STREQ(to_string(report.fault.kind), "EncoderJump");
  EXPECT_THAT(report.fault.value, DoubleNear(-11.4, 1e-6));
}

// Red when each lost answer takes the power of a machine that is to be enabled: one of a late gateway never would be.
TEST_F(PositionDoubts, AnswersThatAreLostNowAndThenKeepNothingFromBeingEnabled) {
  build(bounded());
  cycle(20);
  readable->reads = false;
  command.power = true;
  for (int i = 0; i < 40 && !report.follows; ++i) {
    fake->drives[0].words.missed = i % 3 == 0;
    cycle();
  }
  EXPECT_TRUE(report.follows);
}

TEST_F(PositionDoubts, JointThatStandsElsewhereThanItWasLeftIsNotEnabled) {
  build(bounded());
  engage();
  power_off();
  move_in_silence(1, 11.4);
  try_power();
  expect_displaced(1, 11.4);
  EXPECT_EQ(fake->drives[1].words.statusword, 0x40) << "it got power";
  EXPECT_EQ(report.reference_lost, 0U);
  reset();
  EXPECT_EQ(report.state, ServoState::Off);
  EXPECT_EQ(report.reference_lost, 2U);
  EXPECT_NEAR(report.position[1], 11.4, 1e-6);
  engage();
}

TEST_F(PositionDoubts, JointThatMovedByLessThanAJumpIsEnabled) {
  build(bounded());
  engage();
  power_off();
  move_in_silence(1, 0.5);
  try_power();
  EXPECT_EQ(report.state, ServoState::Engaged);
}

TEST_F(PositionDoubts, JointThatIsMovedByHandWhileItsDriveTellsItIsEnabled) {
  build(bounded());
  engage();
  power_off();
  for (int i = 1; i <= 200; ++i) {
    put_at(1, 0.1 * i);
    cycle();
  }
  engage();
  EXPECT_NEAR(report.position[1], 20, 1e-6);
}

// A drive that loses its master brakes by itself: where it ends is no riddle.
TEST_F(PositionDoubts, JointThatCoastedWhenItsDriveFellSilentIsEnabled) {
  build(bounded());
  engage();
  double at = 0;
  for (int i = 0; i < 100; ++i) {
    at += 0.1;
    command.setpoint.position[1] = at;
    put_at(1, at);
    cycle();
  }
  move_in_silence(1, at + 8);
  reset();
  try_power();
  EXPECT_EQ(report.state, ServoState::Engaged) << to_string(report.fault.kind);
  EXPECT_EQ(report.reference_lost, 0U);
}

TEST_F(PositionDoubts, JointWithoutAReferenceMayStandAnywhere) {
  ServoLoopParts made = bounded();
  made.actuators[1].homing_turn = 1;
  build(std::move(made));
  engage();
  power_off();
  move_in_silence(1, 11.4);
  try_power();
  EXPECT_EQ(report.state, ServoState::Engaged);
  EXPECT_EQ(report.reference_lost, 0U);
}

TEST_F(PositionDoubts, HomingFindsTheReferenceAgain) {
  ServoLoopParts made = bounded();
  made.actuators[1].homing_turn = 1;
  build(std::move(made));
  engage();
  const auto home = [&](double at) {
    command.home = true;
    cycle(2);
    fake->drives[1].words.mode = DriveMode::Homing;
    cycle(20);
    put_at(1, at);
    fake->drives[1].words.statusword |= statusword::kTargetReached | statusword::kHomingAttained;
    fake->drives[1].stuck = true;
    cycle(20);
    fake->drives[1].words.mode = DriveMode::CyclicSyncTorque;
    command.home = false;
    cycle(20);
    fake->drives[1].stuck = false;
    fake->drives[1].words.statusword = 0x27;
    ASSERT_EQ(report.state, ServoState::Engaged);
  };
  home(500);
  power_off();
  move_in_silence(1, 510);
  try_power();
  expect_displaced(1, 10);
  reset();
  EXPECT_EQ(report.reference_lost, 2U);
  engage();
  home(-3);
  EXPECT_EQ(report.reference_lost, 0U);
  EXPECT_NEAR(report.position[1], -3, 1e-6);
}

TEST_F(PositionDoubts, LoopThatTakesOverKnowsWhereTheMachineWasLeft) {
  build(bounded());
  engage();
  power_off();
  auto next = ServoLoop::create(bounded());
  ASSERT_TRUE(next);
  (*next)->engage(loop->handover());
  loop = std::move(*next);
  move_in_silence(1, 11.4);
  try_power();
  expect_displaced(1, 11.4);
  reset();
  next = ServoLoop::create(bounded());
  ASSERT_TRUE(next);
  (*next)->engage(loop->handover());
  loop = std::move(*next);
  cycle(5);
  EXPECT_EQ(report.reference_lost, 2U);
}

/// Sends its first joint 11.4 mm beside where it is.
class CrookedMap final : public DirectMap {
 public:
  void actuator_positions(std::span<const double> q, std::span<double> a) const noexcept override {
    DirectMap::actuator_positions(q, a);
    a[0] += 11.4;
  }
};

// Red when what a drive would be sent first is not held against where it stands.
TEST_F(PositionDoubts, DriveThatWouldBeSentElsewhereThanItStandsIsStopped) {
  ServoLoopParts made = bounded();
  made.actuator_map = std::make_shared<CrookedMap>();
  made.joints[0].law = nullptr;
  made.actuators[0].mode = DriveMode::CyclicSyncPosition;
  build(std::move(made));
  command.power = true;
  for (int i = 0; i < 40; ++i) {
    cycle();
    ASSERT_EQ(bus->commands[0].target_position_counts, 0) << "cycle " << i;
  }
  expect_displaced(0, 11.4);
}

// A bus that cannot read positions beside the answers: what is told three times on end counts.
TEST_F(PositionDoubts, WithoutAReadingTheAnswersHaveToAgree) {
  fake = std::make_shared<FakeBus>(5);
  bus = std::make_shared<ServoBus>(fake);
  build(bounded());
  engage();
  power_off();
  put_at(0, 700);
  cycle();
  put_at(0, 0);
  cycle(3);
  engage();
  EXPECT_NEAR(report.position[0], 0, 1e-6);
  power_off();
  put_at(0, 11.4);
  cycle(10);
  try_power();
  expect_displaced(0, 11.4);
}

}  // namespace
}  // namespace rmac::servo_test
