// A mill whose drives follow velocities or positions themselves: what a client sees is the machine that it knows.
#include <gmock/gmock.h>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

struct Mode {
  const char* name;
  DriveMode mode;
  double lag_s;  ///< what the drives' own loops add: how far behind a joint may be at a steady speed
};

void PrintTo(const Mode& mode, std::ostream* out) {
  *out << mode.name;
}

sdk::DeviceObject mill_of(DriveMode mode) {
  sdk::DeviceObject device = TestMachine::mill();
  const auto number = static_cast<double>(mode);
  device.digital_control_interface.numbers["mode"] = std::vector<double>(8, number);
  for (sdk::Joint& joint : device.joints) {
    joint.servo_law = {};
    joint.gains.clear();
  }
  if (mode != DriveMode::CyclicSyncVelocity) return device;
  for (sdk::Actuator& actuator : device.actuators) actuator.position_gain = 30;
  return device;
}

class DriveModes : public testing::TestWithParam<Mode> {
 protected:
  [[nodiscard]] double worst_error() const {
    double worst = 0;
    for (const CycleSample& sample : machine.samples) {
      for (std::size_t j = 0; j < 3; ++j)
        worst = std::max(worst, std::abs(sample.position_set[j] - sample.position[j]));
    }
    return worst;
  }
  TestMachine machine;
};

TEST_P(DriveModes, RunAProgramAndFollowIt) {
  const auto loaded = machine.load_at_zero(mill_of(GetParam().mode));
  ASSERT_TRUE(loaded) << loaded.error().message;
  auto& cam = machine.controller.cam();
  ASSERT_TRUE(cam.path().set_feedrate(6000));
  ASSERT_TRUE(machine.line(1, {0, 0, 0}, {20, 0, 0}));
  ASSERT_TRUE(machine.line(2, {20, 0, 0}, {20, 15, -5}));
  ASSERT_TRUE(machine.line(3, {20, 15, -5}, {0, 0, 0}));
  ASSERT_TRUE(cam.cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until_event(Event::Kind::MoveDone, 3)) << machine.last(Event::Kind::Fault);
  EXPECT_GT(machine.peak_velocity(0), 90);
  EXPECT_LT(worst_error(), 100 * GetParam().lag_s + 0.1);
  const auto rests = [&] {
    const CycleSample now = machine.controller.sample();
    double off = 0;
    for (std::size_t j = 0; j < 3; ++j) off = std::max(off, std::abs(now.position[j]));
    return off < 0.01;
  };
  EXPECT_TRUE(machine.run_until(rests)) << "it arrives where it was sent";
}

TEST_P(DriveModes, BlockedJointStopsTheMachine) {
  const auto loaded = machine.load_at_zero(mill_of(GetParam().mode));
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(3000));
  ASSERT_TRUE(machine.line(1, {0, 0, 0}, {40, 0, 0}));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().position[0] > 5; }));
  machine.bus->push(0, -5);
  ASSERT_TRUE(machine.run_until_event(Event::Kind::Fault, 1));
  EXPECT_THAT(machine.last(Event::Kind::Fault), testing::HasSubstr("X"));
}

INSTANTIATE_TEST_SUITE_P(Of, DriveModes,
                         testing::Values(Mode{"Velocity", DriveMode::CyclicSyncVelocity, 0.003},
                                         Mode{"Position", DriveMode::CyclicSyncPosition, 0.003}),
                         [](const auto& mode) { return std::string(mode.param.name); });

TEST(DriveMode, LawBesideADriveThatFollowsPositionsIsItsTorqueOffset) {
  TestMachine machine;
  sdk::DeviceObject device = mill_of(DriveMode::CyclicSyncPosition);
  device.joints[1].servo_law = {"TestLaw", {}, {}};
  device.joints[1].gains = {300, 4};
  const auto loaded = machine.load(device);
  EXPECT_TRUE(loaded) << loaded.error().message;
}

}  // namespace
}  // namespace rmac::gateway
