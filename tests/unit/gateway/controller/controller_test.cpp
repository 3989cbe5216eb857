#include "gateway/controller/controller.hpp"

#include <gmock/gmock.h>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

TEST(Controller, RefusesToStartWithoutAPeriod) {
  ControllerOptions options = TestMachine::options();
  options.period_s = 0;
  Controller controller(options);
  const auto started = controller.start();
  ASSERT_FALSE(started);
  EXPECT_THAT(started.error().message, HasSubstr("the servo period 0 s must be above 0"));
}

TEST(Controller, PutsNothingInBeforeItRuns) {
  TestMachine machine;
  machine.controller.stop();
  const auto loaded = machine.load(TestMachine::mill());
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message, HasSubstr("the controller is not running; start it"));
}

TEST(Controller, LetsGoOfTheBusWhenItStopsAndTakesItUpAgainWhenItStarts) {
  TestMachine machine;
  ASSERT_TRUE(machine.load(TestMachine::mill()));
  machine.controller.stop();
  EXPECT_EQ(machine.controller.mechanism(), nullptr);
  machine.controller.stop();
  ASSERT_TRUE(machine.controller.start());
  const auto loaded = machine.load_at_zero(TestMachine::mill());
  EXPECT_TRUE(loaded) << loaded.error().message;
}

TEST(Controller, CountsBothMotorsOfAGantryAndEnablesThem) {
  ControllerOptions options = TestMachine::options();
  options.module_folders.emplace_back(RMAC_BINARY_DIR "/drivers/modules");
  TestMachine machine(options);
  sdk::DeviceObject device = TestMachine::mill();
  device.actuators.push_back(device.actuators[2]);
  device.actuators[3].axis = 5;
  device.actuator_map = {
      "TransmissionMap", {{"t1", {5, 1}}, {"t2", {5, 1}}, {"t3", {5, 1}}}, {{"transmissions", "screw screw gantry"}}};
  const auto loaded = machine.load(device);
  ASSERT_TRUE(loaded) << loaded.error().message;
  const CycleSample now = machine.controller.sample();
  EXPECT_EQ(now.joint_count, 3U);
  EXPECT_EQ(now.actuator_count, 4U);
  for (std::size_t drive = 0; drive < 4; ++drive) EXPECT_EQ(now.statusword[drive] & 0x6F, 0x27) << "drive " << drive;
}

}  // namespace
}  // namespace rmac::gateway
