#include "gateway/rmac_cam/cam_spindles.hpp"

#include "unit/gateway/rmac_cam/standing_mill.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class Spindles : public StandingMill {
 protected:
  void SetUp() override {
    StandingMill::SetUp();
    spindles_.mechanism_changed();
  }
  [[nodiscard]] double wished() { return supervisor_.wishes().spindle_rpm[0]; }
  CamSpindles spindles_{device_, supervisor_, link_.history, tools_};
};

TEST_F(Spindles, TurnAsTheyAreToldUpToTheMaximumInForce) {
  ASSERT_TRUE(spindles_.set_rpm(0, -1000));
  EXPECT_EQ(wished(), -1000);
  ASSERT_TRUE(spindles_.set_max_rpm(0, 400));
  EXPECT_EQ(spindles_.set_rpm(0, -401).error().message,
            "SetSpindleRPM: -401 rpm is above spindle 0's maximum of 400 rpm");
  EXPECT_EQ(wished(), -1000);
  EXPECT_FALSE(spindles_.set_rpm(0, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(spindles_.set_rpm(1, 100));
}

TEST_F(Spindles, HaveAMaximumThatOnlyTightensTheMechanisms) {
  EXPECT_EQ(spindles_.max_rpm(0).value(), 1000);
  EXPECT_EQ(spindles_.set_max_rpm(0, 1001).error().code, MinorCode::SpeedLimit);
  EXPECT_EQ(spindles_.set_max_rpm(0, 0).error().code, MinorCode::InvalidParameterValue);
  ASSERT_TRUE(spindles_.set_max_rpm(0, 400));
  EXPECT_EQ(spindles_.max_rpm(0).value(), 400);
  spindles_.mechanism_changed();
  EXPECT_EQ(spindles_.max_rpm(0).value(), 1000);
  device_.change(nullptr);
  spindles_.mechanism_changed();
  EXPECT_FALSE(spindles_.max_rpm(0));
}

TEST_F(Spindles, TellTheMeasuredSpeed) {
  CycleSample sample;
  sample.cycle = 1;
  sample.spindle_rpm[0] = 123;
  link_.history.add(sample);
  EXPECT_EQ(spindles_.rpm(0).value(), 123);
  EXPECT_FALSE(spindles_.rpm(1));
}

TEST_F(Spindles, HaveOutputsBesideThemThatAreSwitchedByName) {
  sdk::DeviceObject device = mechanism_->device;
  device.outputs["Laser"] = 2;
  device.outputs["Drawbar"] = 3;
  device.tool_change = {{.kind = sdk::ToolChangeStep::Kind::Switch, .outputs = {"Drawbar"}}};
  device_.change(&device);
  ASSERT_TRUE(spindles_.set_output("Laser", true));
  EXPECT_EQ(supervisor_.wishes().outputs, 0b100U);
  ASSERT_TRUE(spindles_.set_output("Coolant", true));
  ASSERT_TRUE(spindles_.set_output("Laser", false));
  EXPECT_EQ(supervisor_.wishes().outputs, 0b100000U);
  EXPECT_EQ(
      spindles_.set_output("laser", true).error().message,
      "SetOutput: there is no output named \"laser\"; the DigitalIOInterface of Mill has Coolant, Drawbar, Laser");
  for (const bool on : {true, false})
    EXPECT_THAT(spindles_.set_output("Drawbar", on).error().message, HasSubstr("the tool changer switches Drawbar"));
  EXPECT_EQ(supervisor_.wishes().outputs, 0b100000U);
  device_.change(nullptr);
  EXPECT_THAT(spindles_.set_output("Laser", true).error().message, HasSubstr("no mechanism is loaded"));
}

TEST_F(Spindles, HaveOutputsThatGoOffInAFaultAndNotOn) {
  fail();
  EXPECT_THAT(spindles_.set_output("Coolant", true).error().message, HasSubstr("SetOutput: the machine is faulted"));
  EXPECT_THAT(spindles_.set_coolant(true).error().message, HasSubstr("TurnCoolantOn: the machine is faulted"));
  EXPECT_EQ(supervisor_.wishes().outputs, 0U);
  EXPECT_TRUE(spindles_.set_output("Coolant", false));
}

TEST_F(Spindles, StayOffInAFault) {
  fail();
  EXPECT_THAT(spindles_.set_rpm(0, 100).error().message, HasSubstr("the machine is faulted"));
  EXPECT_TRUE(spindles_.set_rpm(0, 0));
}

TEST_F(Spindles, TurnNoFasterThanTheToolBears) {
  ASSERT_TRUE(tools_.set_tool({.number = 1, .max_rpm = 300}));
  supervisor_.set_mounted(1);
  EXPECT_THAT(spindles_.set_rpm(0, 301).error().message, HasSubstr("300 rpm that tool 1 may turn"));
  EXPECT_TRUE(spindles_.set_rpm(0, 300));
}

TEST_F(Spindles, SwitchTheCoolantAndNothingElse) {
  supervisor_.wish([](ServoWishes& wishes) { wishes.outputs = 0b1001; });
  ASSERT_TRUE(spindles_.set_coolant(true));
  EXPECT_EQ(supervisor_.wishes().outputs, 0b101001U);
  ASSERT_TRUE(spindles_.set_coolant(false));
  EXPECT_EQ(supervisor_.wishes().outputs, 0b1001U);
  sdk::DeviceObject dry = mechanism_->device;
  dry.outputs.clear();
  device_.change(&dry);
  EXPECT_EQ(spindles_.set_coolant(true).error().message,
            "TurnCoolantOn: Mill has no output named Coolant in its DigitalIOInterface");
}

}  // namespace
}  // namespace rmac::gateway
