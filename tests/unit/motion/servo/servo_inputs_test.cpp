// Inputs that drives tell, limit switches of known ends, and positions that drives latch at a hit.
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {

constexpr std::uint64_t kProbe = 1U << 5U, kUpper = 1U << 6U, kLower = 1U << 7U;

/// Drives whose touch probes do what the standard says: an edge is latched once, until the function was 0.
class LatchingBus : public FakeBus {
 public:
  using FakeBus::FakeBus;
  [[nodiscard]] bool send(std::span<const DriveCommand> commands) noexcept override {
    for (std::size_t i = 0; i < drives.size(); ++i) {
      DriveFeedback& words = drives[i].words;
      words.touch_probe = static_cast<std::uint16_t>((commands[i].touch_probe & 1U) != 0 ? words.touch_probe | 1U : 0U);
      functions.at(i) = commands[i].touch_probe;
    }
    return FakeBus::send(commands);
  }
  void latch(std::size_t axis, std::int32_t counts) {
    if ((functions.at(axis) & 0x11U) != 0x11U || (drives[axis].words.touch_probe & 2U) != 0) return;
    drives[axis].words.touch_probe |= 2U;
    drives[axis].words.latched_counts[0] = counts;
  }
  std::array<std::uint16_t, 8> functions{};
};

class ServoInputs : public ServoLoopTest {
 protected:
  void SetUp() override {
    fake = latching;
    bus = std::make_shared<ServoBus>(fake);
    ServoLoopParts with_inputs = parts();
    with_inputs.drive_inputs = {{0, 1U << 16U, kProbe}, {0, 2U, kUpper}, {0, 1U, kLower}};
    with_inputs.limit_inputs = kUpper | kLower;
    with_inputs.limits = {{kUpper, 0, 1}, {kLower, 0, -1}};
    with_inputs.probe.touch_input = kProbe;
    for (const std::size_t i : {0U, 2U}) with_inputs.actuators[i].probe_edge = TouchProbeEdge::FirstRising;
    build(std::move(with_inputs));
  }
  void tell(std::uint32_t inputs) { fake->drives[0].words.inputs = inputs; }
  void reset() {
    command.power = false;
    command.reset = true;
    cycle(30);
    command.reset = false;
    cycle();
    ASSERT_EQ(report.state, ServoState::Off);
  }
  std::shared_ptr<LatchingBus> latching = std::make_shared<LatchingBus>(5);
};

TEST_F(ServoInputs, OfADriveAreAmongTheMachines) {
  tell(1U << 16U | 1U << 20U);
  cycle();
  EXPECT_EQ(report.inputs, kProbe);
  EXPECT_TRUE(report.probe.touching);
  tell(0);
  cycle();
  EXPECT_EQ(report.inputs, 0U);
}

TEST_F(ServoInputs, LimitSwitchHoldsAJointBackFromGoingOnAfterAReset) {
  engage();
  tell(2);
  cycle();
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::LimitSwitch);
  cycle(30);
  reset();
  engage();
  command.setpoint.velocity[0] = -3;
  cycle(5);
  EXPECT_EQ(report.state, ServoState::Engaged) << "off it is free";
  command.setpoint.velocity[0] = 0;
  command.setpoint.velocity[1] = 5;
  cycle(5);
  EXPECT_EQ(report.state, ServoState::Engaged) << "another joint is none of its business";
  command.setpoint.velocity = {};
  command.setpoint.velocity[0] = 0.001;
  cycle();
  EXPECT_EQ(report.state, ServoState::Faulted);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::LimitSwitch);
  EXPECT_EQ(report.fault.index, 6U);
  EXPECT_FALSE(report.follows);
  expect_all_quick_stopped();
}

TEST_F(ServoInputs, LimitSwitchThatWasOnBeforePowerHoldsBackToo) {
  tell(1);
  cycle();
  reset();
  engage();
  command.setpoint.velocity[0] = -1;
  cycle();
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::LimitSwitch);
  EXPECT_EQ(report.fault.index, 7U);
}

TEST_F(ServoInputs, HitIsWhereTheDrivesLatchedIt) {
  cycle(3);
  EXPECT_EQ(report.probe.latching, 0b101U) << "joints 0 and 2 have drives that latch";
  put_at(0, 1.5);
  put_at(2, -2);
  latching->latch(0, 1437);
  cycle();
  EXPECT_EQ(report.probe.hits, 1U) << "a latch is a hit, though the contact may be over";
  EXPECT_TRUE(report.probe.touching);
  EXPECT_EQ(report.probe.latched, 0U) << "its position may come with another PDO";
  latching->latch(2, -2100);
  tell(1U << 16U);
  cycle();
  EXPECT_EQ(report.probe.latched, 0b001U);
  cycle();
  EXPECT_EQ(report.probe.latched, 0b101U);
  EXPECT_EQ(report.probe.hits, 1U);
  EXPECT_NEAR(report.probe.latched_position[0], 1.437, 1e-9);
  EXPECT_NEAR(report.probe.latched_position[2], -2.1, 1e-9);
}

TEST_F(ServoInputs, IsArmedAnewWhenTheProbeHasLetGo) {
  for (int hit = 1; hit <= 5; ++hit) {
    cycle(3);
    latching->latch(0, 100 * hit);
    latching->latch(2, -100 * hit);
    tell(1U << 16U);
    cycle(4);
    EXPECT_EQ(report.probe.hits, static_cast<std::uint32_t>(hit));
    EXPECT_EQ(report.probe.latched, 0b101U);
    EXPECT_NEAR(report.probe.latched_position[0], 0.1 * hit, 1e-9);
    latching->latch(0, 7);
    cycle();
    EXPECT_NEAR(report.probe.latched_position[0], 0.1 * hit, 1e-9) << "a bounce changes nothing";
    tell(0);
    cycle(10);
    EXPECT_EQ(report.probe.latched, 0U);
  }
}

TEST_F(ServoInputs, LatchOfACounterThatHasWrappedSinceIsNearWhereTheDriveIs) {
  fake->drives[0].words.position_counts = INT32_MAX - 5;
  cycle(3);
  fake->drives[0].words.position_counts = INT32_MIN + 10;
  latching->latch(0, INT32_MAX);
  cycle(2);
  ASSERT_EQ(report.probe.latched & 1U, 1U);
  EXPECT_NEAR(report.position[0] - report.probe.latched_position[0], 0.011, 1e-9);
}

TEST_F(ServoInputs, DriveThatWasAwayIsNotReliedOn) {
  cycle(3);
  fake->drives[2].words.online = false;
  cycle();
  EXPECT_EQ(report.probe.latching, 0b001U);
}

TEST_F(ServoInputs, LimitSwitchOfAJointThatIsNotThereIsRefused) {
  ServoLoopParts wrong = parts();
  wrong.limits = {{kUpper, 3, 1}};
  const auto refused = ServoLoop::create(std::move(wrong));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "servo loop: a limit switch is of joint 3, and there are 3");
}

}  // namespace rmac::servo_test
