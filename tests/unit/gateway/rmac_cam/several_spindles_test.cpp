// A mechanism with two spindles: one whose drive follows speeds itself, one behind a law on a drive that takes torques.
#include <gmock/gmock.h>

#include "places.hpp"
#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

constexpr double kSlowRise_rpm_s = 400;

ControllerOptions with_shared_modules() {
  ControllerOptions options = TestMachine::options();
  options.module_folders.emplace_back(RMAC_BINARY_DIR "/drivers/modules");
  return options;
}

class SeveralSpindles : public testing::Test {
 protected:
  void SetUp() override {
    sdk::DeviceObject device = TestMachine::mill();
    sdk::Spindle second{.bus = "test", .axis = 4, .max_speed_rpm = 900, .max_torque_nm = 0.9};
    second.speed_tolerance_rpm = 10;
    second.speed_timeout_s = 5;
    second.servo_law = {"DMAC_PID_CONTROL", {}, {}};
    second.gains = {2.3e-4, 5.8e-3, 0};  // 100 rad/s with the inertia of the simulated axis
    second.scale = {131072, 0.318, 1, 0};
    second.max_acceleration_rpm_s = kSlowRise_rpm_s;
    device.spindles.push_back(second);
    const auto loaded = machine_.load_at_zero(device);
    ASSERT_TRUE(loaded) << loaded.error().message;
  }
  [[nodiscard]] sdk::RmacCam& cam() { return machine_.controller.cam(); }
  [[nodiscard]] double rpm(std::size_t spindle) { return machine_.controller.sample().spindle_rpm[spindle]; }
  [[nodiscard]] bool reaches(std::size_t spindle, double wanted) {
    return machine_.run_until([&] { return std::abs(rpm(spindle) - wanted) < 5; });
  }
  [[nodiscard]] Expected<> number_of_spindles(int count) {
    return machine_.controller.config().mechanism().set_number_of_spindles(count).and_then(
        [&] { return machine_.controller.config().apply(); });
  }
  TestMachine machine_{with_shared_modules()};
};

TEST_F(SeveralSpindles, EachTurnsAsItIsTold) {
  ASSERT_TRUE(cam().spindles().set_rpm(0, 600));
  ASSERT_TRUE(cam().spindles().set_rpm(1, -300));
  EXPECT_TRUE(reaches(0, 600));
  EXPECT_TRUE(reaches(1, -300));
  ASSERT_TRUE(cam().spindles().set_rpm(0, 0));
  EXPECT_TRUE(reaches(0, 0));
  EXPECT_NEAR(rpm(1), -300, 5);
  EXPECT_THAT(cam().spindles().set_rpm(1, 901).error().message, HasSubstr("900"));
  EXPECT_FALSE(cam().spindles().set_rpm(2, 100));
}

TEST_F(SeveralSpindles, FeedWaitsForTheSlowestOfThem) {
  ASSERT_TRUE(cam().path().set_feedrate(3000));
  ASSERT_TRUE(cam().spindles().set_rpm(0, 200));
  ASSERT_TRUE(cam().spindles().set_rpm(1, 800));
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {5, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 1)) << machine_.last(Event::Kind::Fault);
  bool moved = false;
  for (const CycleSample& sample : machine_.samples) {
    if (!sample.moving || moved) continue;
    moved = true;
    EXPECT_NEAR(sample.spindle_rpm[1], 800, 11) << "in the cycle of the first motion";
    EXPECT_NEAR(sample.spindle_rpm[0], 200, 21);
  }
  EXPECT_TRUE(moved);
}

TEST_F(SeveralSpindles, TheirNumberLeavesTheOthersTurningAndBringsThemBack) {
  ASSERT_TRUE(cam().spindles().set_rpm(0, 600));
  ASSERT_TRUE(cam().spindles().set_rpm(1, 300));
  ASSERT_TRUE(reaches(0, 600));
  ASSERT_TRUE(reaches(1, 300));
  const auto one = number_of_spindles(1);
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(machine_.controller.mechanism()->spindles.size(), 1U);
  EXPECT_NEAR(rpm(0), 600, 5);
  EXPECT_FALSE(cam().spindles().set_rpm(1, 100));
  const auto two = number_of_spindles(2);
  ASSERT_TRUE(two) << two.error().message;
  EXPECT_NEAR(rpm(0), 600, 5);
  ASSERT_TRUE(cam().spindles().set_rpm(1, 300));
  EXPECT_TRUE(reaches(1, 300));
  const auto three = number_of_spindles(3);
  ASSERT_FALSE(three);
  EXPECT_THAT(three.error().message, HasSubstr("spindle 2"));
}

TEST_F(SeveralSpindles, AFaultNamesTheOneThatHasIt) {
  ASSERT_TRUE(cam().spindles().set_rpm(1, 300));
  ASSERT_TRUE(reaches(1, 300));
  machine_.bus->trip(4, 0x2310);
  ASSERT_TRUE(machine_.run_until([&] { return !machine_.last(Event::Kind::Fault).empty(); }));
  EXPECT_THAT(machine_.last(Event::Kind::Fault), HasSubstr("spindle 1 (bus test, axis 4)"));
}

}  // namespace
}  // namespace rmac::gateway
