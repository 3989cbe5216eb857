#include <gmock/gmock.h>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t kPressed = 1U << 2U;
constexpr std::uint64_t kLimitX = 1U << 3U;

/// A mill with an emergency stop and a limit switch, at rest in its origin.
class EmergencyStop : public testing::Test {
 protected:
  void SetUp() override {
    device_ = TestMachine::mill();
    device_.inputs = {{"EmergencyStop", 2}, {"LimitX", 3}, {"Door", 4}};
    const auto loaded = machine_.load_at_zero(device_);
    ASSERT_TRUE(loaded) << loaded.error().message;
  }
  sdk::RmacCam& cam() { return machine_.controller.cam(); }
  CycleState state() { return machine_.controller.sample().state; }
  void start_line() {
    ASSERT_TRUE(cam().path().set_feedrate(120));
    ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {40, 0, 0}));
    ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
    ASSERT_TRUE(machine_.run_until([&] { return !machine_.samples.empty() && machine_.samples.back().moving; }));
  }
  sdk::DeviceObject device_;
  TestMachine machine_;
};

TEST_F(EmergencyStop, StopsAMoveDropsOutputsAndHoldsUntilItIsReleasedAndReset) {
  ASSERT_TRUE(cam().spindles().set_coolant(true));
  ASSERT_TRUE(machine_.run_until([&] { return machine_.io->outputs() == 1U << 5U; }));
  start_line();
  machine_.io->set_inputs(kPressed);
  ASSERT_TRUE(machine_.run_until([&] { return state() == CycleState::EmergencyStop; }));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::Fault, 1));
  EXPECT_THAT(machine_.last(Event::Kind::Fault), HasSubstr("EmergencyStop (input 2) stopped the machine; release it"));
  ASSERT_TRUE(machine_.run_until([&] { return machine_.io->outputs() == 0; })) << "coolant";

  const auto early = cam().cycle().reset();
  ASSERT_FALSE(early);
  EXPECT_EQ(early.error().code, MinorCode::EmergencyStop);
  EXPECT_EQ(state(), CycleState::EmergencyStop);
  const auto refused = cam().cycle().start(sdk::CycleMode::Automatic);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::EmergencyStop);

  machine_.io->set_inputs(0);
  const auto reset = cam().cycle().reset();
  ASSERT_TRUE(reset) << reset.error().message;
  ASSERT_TRUE(machine_.run_until([&] { return state() == CycleState::Idle; }));
  const std::int64_t idle = machine_.controller.sample().cycle;
  ASSERT_TRUE(
      machine_.run_until([&] { return !machine_.samples.empty() && machine_.samples.back().cycle > idle + 200; }));
  for (const CycleSample& sample : machine_.samples) {
    if (sample.cycle < idle) continue;
    ASSERT_FALSE(sample.moving) << "nothing moves by itself";
    ASSERT_EQ(sample.outputs, 0U) << "and nothing flows";
  }
}

TEST_F(EmergencyStop, IsNoHindranceToOtherInputs) {
  start_line();
  machine_.io->set_inputs(1U << 4U);
  machine_.samples.clear();
  ASSERT_TRUE(machine_.run_until([&] { return machine_.samples.size() > 200; }));
  EXPECT_EQ(state(), CycleState::Running);
}

TEST_F(EmergencyStop, OfALimitSwitchIsAFaultThatCanBeResetToMoveOff) {
  start_line();
  machine_.io->set_inputs(kLimitX);
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::Fault, 1));
  EXPECT_THAT(machine_.last(Event::Kind::Fault), HasSubstr("LimitX (input 3) is reached"));
  EXPECT_TRUE(machine_.run_until([&] { return state() == CycleState::Faulted; })) << "the next samples say so too";
  const auto reset = cam().cycle().reset();
  ASSERT_TRUE(reset) << reset.error().message;
  ASSERT_TRUE(cam().positioning().jog_joint(0, -1));
}

/// A mill whose X drive has a limit switch at four turns, 20 mm, and tells of it.
sdk::DeviceObject mill_with_limit_switch() {
  sdk::DeviceObject device = TestMachine::mill();
  const std::vector<double> far(8, 1e6);
  std::vector<double> upper = far;
  upper[0] = 4;
  device.digital_control_interface = {"SimulatedInterface", {{"positive_switch_turns", upper}}, {}};
  device.digital_io_interface = {};
  device.outputs.clear();
  device.inputs = {{"LimitXPositive", 63}};
  device.drive_inputs[63] = {0, 1};
  return device;
}

TEST(LimitSwitchOfADrive, HoldsEveryJogBackThatGoesOnTowardsIt) {
  TestMachine machine;
  const auto loaded = machine.load_at_zero(mill_with_limit_switch());
  ASSERT_TRUE(loaded) << loaded.error().message;
  sdk::RmacCam& cam = machine.controller.cam();
  const auto idle = [&] {
    machine.controller.dispatch();
    return machine.controller.cycle_now().state == CycleState::Idle && !machine.controller.sample().moving;
  };
  ASSERT_TRUE(cam.positioning().jog_joint(0, 25));
  ASSERT_TRUE(machine.run_until_event(Event::Kind::Fault, -1));
  EXPECT_THAT(machine.last(Event::Kind::Fault), HasSubstr("LimitXPositive (input 63) is reached; reset, then jog"));
  EXPECT_NEAR(machine.controller.sample().position[0], 20, 1);
  ASSERT_TRUE(machine.run_until([&] { return cam.cycle().reset().has_value() && idle(); }));
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().servo_state == ServoState::Engaged; }));

  const auto refused = cam.positioning().jog_joint(0, 1);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::TravelLimit);
  EXPECT_EQ(refused.error().message,
            "JogJoint: joint X stands on its limit switch at the positive end; jog the other way");
  EXPECT_FALSE(cam.positioning().jog_joint_at(0, 5));
  machine.events.clear();
  ASSERT_TRUE(cam.positioning().jog_path({{1, 1, 0}}, 2));
  ASSERT_TRUE(machine.run_until_event(Event::Kind::Fault, -1)) << "whatever moves it there";
  EXPECT_THAT(machine.last(Event::Kind::Fault), HasSubstr("LimitXPositive"));
  ASSERT_TRUE(machine.run_until([&] { return cam.cycle().reset().has_value() && idle(); }));
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().servo_state == ServoState::Engaged; }));
  ASSERT_TRUE(cam.positioning().jog_joint(0, -5));
  ASSERT_TRUE(machine.run_until([&] { return idle() && machine.controller.sample().position[0] < 17; }));
  EXPECT_EQ(machine.controller.sample().inputs, 0U);
}

TEST(LimitSwitchOfADrive, ThatItsBusDoesNotCarryIsRefused) {
  TestMachine machine;
  sdk::DeviceObject device = mill_with_limit_switch();
  device.drive_inputs[63].bit = 5;
  const auto loaded = machine.load(device);
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message,
              HasSubstr("input of actuator 0 \"LimitXPositive\" is bit 5, to which nothing of its drive's interface is "
                        "connected; connected are 0, 1"));
}

/// As much as a device that has four inputs.
class FourInputs final : public DigitalIoInterface {
 public:
  [[nodiscard]] Expected<> start() override { return {}; }
  void stop() noexcept override {}
  [[nodiscard]] bool exchange(std::uint64_t, std::uint64_t& inputs) noexcept override {
    inputs = 0;
    return true;
  }
  [[nodiscard]] std::uint64_t input_bits() const noexcept override { return 0xF; }
};

TEST(IoNames, OfBitsThatNothingIsConnectedToAreRefused) {
  ControllerOptions options = TestMachine::options();
  options.io_interfaces["FourInputs"] = [](const sdk::ModuleChoice&,
                                           const ModuleLoader&) -> Expected<std::shared_ptr<DigitalIoInterface>> {
    return std::make_shared<FourInputs>();
  };
  TestMachine machine(options);
  sdk::DeviceObject device = TestMachine::mill();
  device.digital_io_interface = {"FourInputs", {}, {}};
  device.inputs = {{"EmergencyStop", 4}};
  const auto loaded = machine.load(device);
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message, HasSubstr("input \"EmergencyStop\" is bit 4, to which nothing of FourInputs is "
                                                "connected; connected are 0, 1, 2, 3"));
}

}  // namespace
}  // namespace rmac::gateway
