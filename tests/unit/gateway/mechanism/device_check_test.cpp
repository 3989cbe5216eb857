#include <gmock/gmock.h>

#include <limits>
#include <random>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using sdk::DeviceObject;
using testing::AllOf;
using testing::HasSubstr;

/// One number of a device object that acts on motion.
struct Field {
  const char* name;
  double& (*of)(DeviceObject& device);
};

const std::vector<Field>& fields() {
  static const std::vector<Field> kFields{
      {"MaxFeedrate", [](DeviceObject& d) -> double& { return d.max_feedrate_mm_min; }},
      {"PathAccelRise", [](DeviceObject& d) -> double& { return d.path_accel_rise_mm_s2; }},
      {"PathAccelFall", [](DeviceObject& d) -> double& { return d.path_accel_fall_mm_s2; }},
      {"Min", [](DeviceObject& d) -> double& { return d.joints[0].limits.min; }},
      {"Max", [](DeviceObject& d) -> double& { return d.joints[1].limits.max; }},
      {"MaxSpeed", [](DeviceObject& d) -> double& { return d.joints[2].limits.max_speed; }},
      {"MaxAcceleration", [](DeviceObject& d) -> double& { return d.joints[0].limits.max_acceleration; }},
      {"MaxJerk", [](DeviceObject& d) -> double& { return d.joints[1].limits.max_jerk; }},
      {"Gains", [](DeviceObject& d) -> double& { return d.joints[2].gains[0]; }},
      {"MaxFollowingError", [](DeviceObject& d) -> double& { return d.joints[0].max_following_error; }},
      {"MaxEffort", [](DeviceObject& d) -> double& { return d.joints[1].max_effort; }},
      {"CountsPerRevolution", [](DeviceObject& d) -> double& { return d.actuators[2].scale.counts_per_revolution; }},
      {"RatedTorque", [](DeviceObject& d) -> double& { return d.actuators[0].scale.rated_torque_nm; }},
      {"MaxSpeed", [](DeviceObject& d) -> double& { return d.spindles[0].max_speed_rpm; }},
      {"SpeedTolerance", [](DeviceObject& d) -> double& { return d.spindles[0].speed_tolerance_rpm; }},
      {"SpeedTimeout", [](DeviceObject& d) -> double& { return d.spindles[0].speed_timeout_s; }}};
  return kFields;
}

TEST(BadDevice, EachAbsurdNumberIsRefusedAndTheMechanismInForceStays) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::mt19937 random(20261121);
  for (const Field& field : fields()) {
    std::vector<double> bad{std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity};
    for (int i = 0; i < 6; ++i) bad.push_back(std::pow(10, std::uniform_real_distribution<>(13, 300)(random)));
    for (int i = 0; i < 6; ++i) bad.push_back(-std::pow(10, std::uniform_real_distribution<>(13, 300)(random)));
    // A joint may well end near zero, a gain may be small.
    const bool may_be_small =
        field.name == std::string("Min") || field.name == std::string("Max") || field.name == std::string("Gains");
    for (int i = 0; i < 6 && !may_be_small; ++i) {
      bad.push_back(std::pow(10, std::uniform_real_distribution<>(-300, -6)(random)));
    }
    for (const double value : bad) {
      DeviceObject device = TestMachine::mill();
      device.name = "Spoiled";
      field.of(device) = value;
      const auto loaded = machine.load(device);
      ASSERT_FALSE(loaded) << field.name << " = " << value;
      ASSERT_EQ(machine.controller.mechanism()->name, "Mill");
    }
  }
  machine.controller.discard_draft();
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(6000));
  ASSERT_TRUE(machine.line(1, {0, 0, 0}, {1, 1, 1}));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  EXPECT_TRUE(machine.run_until_event(Event::Kind::MoveDone, 1));
}

TEST(BadDevice, LimitsThatExcludeWhereAJointStandsAreRefusedWhenItIsLoaded) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(6000));
  ASSERT_TRUE(machine.line(1, {0, 0, 0}, {0, -30, 0}));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until_event(Event::Kind::MoveDone, 1));
  DeviceObject narrow = TestMachine::mill();
  narrow.name = "Narrow";
  narrow.joints[1].limits.min = -20;

  const auto beside = machine.load(narrow);
  ASSERT_FALSE(beside);
  EXPECT_EQ(beside.error().code, MinorCode::TravelLimit);
  EXPECT_THAT(beside.error().message, AllOf(HasSubstr("joint 1 \"Y\""), HasSubstr("-30.0000"), HasSubstr("-20 to 50")));
  EXPECT_EQ(machine.controller.mechanism()->name, "Mill");
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(machine.controller.sample().statusword[i] & 0x6F, 0x27) << "drive " << i;

  ASSERT_TRUE(machine.controller.unload());
  const auto alone = machine.load(narrow);
  ASSERT_FALSE(alone);
  EXPECT_THAT(alone.error().message, HasSubstr("joint 1 \"Y\" stands at -"));
  EXPECT_EQ(machine.controller.mechanism(), nullptr);
}

}  // namespace
}  // namespace rmac::gateway
