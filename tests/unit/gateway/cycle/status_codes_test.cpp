// Appendix IV's StatusMinorCode: each of its codes, by what really causes it.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <set>

#include "gateway/api/enumeration.hpp"
#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

/// Whose first drive can be switched off from outside, as a safety chain does it.
class DroppingBus final : public fieldbus::SimulatedInterface {
 public:
  DroppingBus() : SimulatedInterface(fieldbus::default_simulated_axes(), 0.001) {}
  [[nodiscard]] bool receive(std::span<DriveFeedback> feedback) noexcept override {
    constexpr std::uint16_t kSwitchedOn = 0x23;
    const bool works = SimulatedInterface::receive(feedback);
    if (dropped) feedback[0].statusword = kSwitchedOn;
    return works;
  }
  std::atomic<bool> dropped{false};
};

/// A mill whose inputs are the names that the appliance acts on, and with a probe's.
sdk::DeviceObject wired_mill() {
  sdk::DeviceObject device = TestMachine::mill();
  device.inputs = {{"EmergencyStop", 0}, {"Air", 1}, {"Probe", 2}};
  return device;
}
constexpr std::uint64_t kPressed = 1, kAir = 2, kTouching = 4;

/// The mill at its home, with air, in a cycle.
class Running : public TestMachine {
 public:
  explicit Running(const sdk::DeviceObject& device = wired_mill(),
                   const ControllerOptions& options = TestMachine::options())
      : TestMachine(options) {
    const auto loaded = load(device);
    EXPECT_TRUE(loaded) << loaded.error().message;
    io->set_inputs(kAir);
    EXPECT_TRUE(run_until([&] { return (controller.sample().inputs & kAir) != 0; }));
    const auto started = controller.cam().positioning().home().and_then([&] {
      EXPECT_TRUE(run_until([&] { return std::abs(controller.sample().position_set[2]) < 1e-9; }));
      EXPECT_TRUE(run_until([&] { return controller.sample().state == CycleState::Idle; }));
      return controller.cam().path().set_feedrate(1200).and_then(
          [&] { return controller.cam().cycle().start(sdk::CycleMode::Automatic); });
    });
    EXPECT_TRUE(started) << started.error().message;
    events.clear();
  }
  /// What the next stop or fault is for; a stop at the end of what was asked for has no code.
  MinorCode stops() {
    const auto why = [&] {
      const auto found = std::ranges::find_if(events, [](const Event& event) { return event.code != MinorCode::None; });
      return found == events.end() ? MinorCode::None : found->code;
    };
    EXPECT_TRUE(run_until([&] { return why() != MinorCode::None; }));
    return why();
  }
};

MinorCode refused(const Expected<>& done) {
  return done ? MinorCode::None : done.error().code;
}

struct Cause {
  MinorCode code;
  const char* what;
  MinorCode (*raised)();
};

const std::vector<Cause> kCauses{
    {MinorCode::Unknown, "ADriveDropsOutWithoutAWord",
     [] {
       auto bus = std::make_shared<DroppingBus>();
       ControllerOptions options = TestMachine::options();
       options.control_interfaces["DroppingBus"] =
           [bus](const std::string&, const sdk::ModuleChoice&,
                 const ModuleLoader&) -> Expected<std::shared_ptr<DigitalControlInterface>> { return bus; };
       sdk::DeviceObject device = wired_mill();
       device.digital_control_interface.name = "DroppingBus";
       Running machine(device, options);
       bus->dropped = true;
       return machine.stops();
     }},
    {MinorCode::EmergencyStop, "TheEmergencyStopIsPressed",
     [] {
       Running machine;
       machine.io->set_inputs(kAir | kPressed);
       return machine.stops();
     }},
    {MinorCode::NoAir, "TheAirGoesOff",
     [] {
       Running machine;
       EXPECT_TRUE(machine.line(1, {0, 0, 0}, {40, 0, 0}));
       EXPECT_TRUE(machine.run_until([&] { return machine.controller.sample().moving; }));
       machine.io->set_inputs(0);
       return machine.stops();
     }},
    {MinorCode::TravelLimit, "AMoveEndsBeyondTheTravel",
     [] {
       return refused(Running().line(1, {0, 0, 0}, {51, 0, 0}));
     }},
    {MinorCode::SpeedLimit, "AFeedIsBeyondTheMachines",
     [] { return refused(Running().controller.cam().path().set_feedrate(12001)); }},
    {MinorCode::AccelerationLimit, "AnAccelerationIsBeyondTheJoints",
     [] { return refused(Running().controller.cam().joints().set_accel_rise(0, 1001)); }},
    {MinorCode::ProbeNotArmed, "ThereIsNoProbe",
     [] {
       sdk::DeviceObject device = wired_mill();
       device.inputs.erase("Probe");
       return refused(Running(device).controller.measuring().auto_measure(1, {0, 0, -5}, 20));
     }},
    {MinorCode::Scale, "AnEncoderJumps",
     [] {
       Running machine;
       machine.bus->shift_encoder(0, 131072);
       return machine.stops();
     }},
    {MinorCode::PartNotFound, "ThereIsNoPart",
     [] {
       Running machine;
       EXPECT_TRUE(machine.controller.measuring().auto_measure(1, {0, 0, -5}, 20));
       return machine.stops();
     }},
    {MinorCode::UnexpectedHit, "TheProbeTouchesOnItsWay",
     [] {
       Running machine;
       EXPECT_TRUE(machine.controller.cam().cmm_moves().to_point(1, {30, 0, 0}, 5));
       EXPECT_TRUE(machine.run_until([&] { return machine.controller.sample().position[0] > 1; }));
       machine.io->set_inputs(kAir | kTouching);
       return machine.stops();
     }},
    {MinorCode::CommTimeout, "ADriveFallsSilent",
     [] {
       Running machine;
       machine.bus->set_online(1, false);
       return machine.stops();
     }},
    {MinorCode::ResponseTimeout, "ASpindleDoesNotComeToItsSpeed",
     [] {
       sdk::DeviceObject device = wired_mill();
       device.spindles[0].speed_timeout_s = 0.1;
       Running machine(device);
       EXPECT_TRUE(machine.controller.cam().spindles().set_rpm(0, 1000));
       return machine.stops();
     }},
    {MinorCode::InvalidParameter, "AnInterfaceIsInitializedThatNobodyChose",
     [] {
       TestMachine machine;
       EXPECT_TRUE(machine.controller.config().begin(wired_mill()));
       return refused(machine.controller.config().interfaces().initialize_control());
     }},
    {MinorCode::InvalidParameterValue, "AFeedIsNone",
     [] { return refused(Running().controller.cam().path().set_feedrate(0)); }},
    {MinorCode::CommandQueueFull, "TheQueueIsFull",
     [] {
       ControllerOptions options = TestMachine::options();
       options.queue_capacity = 2;
       Running machine(wired_mill(), options);
       EXPECT_TRUE(machine.controller.cam().cycle().hold());
       MinorCode code = MinorCode::None;
       for (int i = 0; i < 4 && code == MinorCode::None; ++i) {
         code = refused(machine.line(1, {0, 0, 0.01 * i}, {0, 0, 0.01 * (i + 1)}));
       }
       return code;
     }},
    {MinorCode::UnsupportedOperation, "AHitIsSimulatedWhileDrivesAreLive",
     [] {
       return refused(Running().controller.measuring().simulate_probe({0, 0, 0}, true));
     }},
    {MinorCode::Other, "ADriveFaults",
     [] {
       Running machine;
       machine.bus->trip(2, 0x4310);
       return machine.stops();
     }},
};

class StatusMinorCode : public testing::TestWithParam<Cause> {};
INSTANTIATE_TEST_SUITE_P(AppendixIV, StatusMinorCode, testing::ValuesIn(kCauses),
                         [](const testing::TestParamInfo<Cause>& cause) { return std::string(cause.param.what); });

TEST_P(StatusMinorCode, IsRaisedByItsCause) {
  EXPECT_EQ(GetParam().raised(), GetParam().code);
}

TEST(StatusMinorCodes, AreAllRaisedAbove) {
  std::set<std::int64_t> raised{static_cast<std::int64_t>(MinorCode::None)};
  for (const Cause& cause : kCauses) raised.insert(static_cast<std::int64_t>(cause.code));
  for (const auto& value : kMinorCodeValues.values) EXPECT_TRUE(raised.contains(value.number)) << value.name;
}

}  // namespace
}  // namespace rmac::gateway
