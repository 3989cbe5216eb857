// The device driver's setters (Appendix III): each takes effect once the driver configures the controller by it.
#include <gmock/gmock.h>

#include "unit/gateway/api/setters/setter_bench.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

constexpr const char* kConfigure = "Device.Machine_ConfigureMotionPlanner";

void set_joint(SetterBench& bench, const char* setter, const char* parameter, double value) {
  bench.call(setter, fmt::format(R"({{"JntNum": 0, "{}": {}}})", parameter, value));
  bench.call(kConfigure);
}

}  // namespace

const std::vector<SetterEffect>& device_setter_effects() {
  static const std::vector<SetterEffect> kEffects{
      {"Device.Machine_SetMechanismNumberOfJoints",
       [](SetterBench& bench) {
         bench.call("Device.Machine_SetMechanismNumberOfJoints", R"({"NumJnts": 2})");
         EXPECT_THAT(bench.refusal(kConfigure), HasSubstr("has 3 joints, but 2 are configured"));
         EXPECT_NEAR(bench.tip_to(0, 0, 2).back().position_set[2], 2, 1e-5) << "the old mechanism is in force";
       }},
      {"Device.Machine_SetMechanismMaxFeedrate",
       [](SetterBench& bench) {
         bench.call("Device.Machine_SetMechanismMaxFeedrate", R"({"MaxFeedrate": 3000})");
         bench.call(kConfigure);
         bench.call("RMAC_CAM.SetFeedrate", R"({"Feedrate": 3000})");
         EXPECT_NEAR(peak_feed(bench.tip_to(20, 0, 0)), 50, 0.01) << "the machine as loaded does 33.3 mm/s";
       }},
      {"Device.Machine_SetMechanismSpindleMaxSpeed",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 800})");
         bench.run_until([&] { return bench.now().spindle_rpm[0] > 790; });
         bench.call("Device.Machine_SetMechanismSpindleMaxSpeed", R"({"MaxSpindleSpeed": 400})");
         bench.call(kConfigure);
         bench.run_until([&] { return std::abs(bench.now().spindle_rpm[0] - 400) < 1; });
       }},
      {"Device.Machine_SetMechanismSpindleMaxTorque",
       [](SetterBench& bench) {
         const auto turn_under_load = [&] {
           bench.call("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 600})");
           bench.run_until([&] { return std::abs(bench.now().spindle_rpm[0] - 600) < 1; });
           bench.bus->push(3, 3);
         };
         turn_under_load();
         const double until = bench.now().t_s + 1;
         bench.run_until([&] { return bench.now().t_s > until; });
         EXPECT_NEAR(bench.now().spindle_torque_nm[0], 3, 0.01);
         EXPECT_EQ(bench.now().fault.kind, ServoFault::Kind::None) << "5 N·m is what it may give";
         bench.bus->push(3, 0);
         bench.call("Device.Machine_SetMechanismSpindleMaxTorque", R"({"MaxSpindleTorque": 2})");
         bench.call(kConfigure);
         turn_under_load();
         bench.run_until([&] { return bench.now().fault.kind == ServoFault::Kind::TorqueBound; });
         EXPECT_EQ(bench.now().fault.part, ServoFault::Part::Spindle);
       }},
      {"Device.Machine_SetMechanismJntTypes",
       [](SetterBench& bench) {
         bench.call("Device.Machine_SetMechanismJntTypes", R"({"JntNum": 0, "JntType": "DMAC_ROT_JNT"})");
         EXPECT_THAT(bench.refusal(kConfigure), HasSubstr("Rotary"));
         EXPECT_NEAR(bench.tip_to(2, 0, 0).back().position_set[0], 2, 1e-5) << "the old mechanism is in force";
       }},
      {"Device.Machine_SetMechanismJntMaxLimit",
       [](SetterBench& bench) {
         set_joint(bench, "Device.Machine_SetMechanismJntMaxLimit", "MaxJntLimit", 60);
         EXPECT_NEAR(bench.joints_to({55, 0, 0}).back().position[0], 55, 0.05);
       }},
      {"Device.Machine_SetMechanismJntMinLimit",
       [](SetterBench& bench) {
         set_joint(bench, "Device.Machine_SetMechanismJntMinLimit", "MinJntLimit", -60);
         EXPECT_NEAR(bench.joints_to({-55, 0, 0}).back().position[0], -55, 0.05);
       }},
      {"Device.Machine_SetMechanismJntMaxSpeed",
       [](SetterBench& bench) {
         set_joint(bench, "Device.Machine_SetMechanismJntMaxSpeed", "MaxJntSpeed", 25);
         EXPECT_NEAR(peak(bench.joints_to({40, 0, 0}), &CycleSample::velocity_set, 0), 25, 0.1);
       }},
      {"Device.Machine_SetMechanismJntMaxAccel",
       [](SetterBench& bench) {
         set_joint(bench, "Device.Machine_SetMechanismJntMaxAccel", "MaxJntAccel", 250);
         EXPECT_NEAR(peak(bench.joints_to({40, 0, 0}), &CycleSample::acceleration_set, 0), 250, 2.5);
       }},
      {"Device.Machine_SetMechanismJntMaxJerk",
       [](SetterBench& bench) {
         set_joint(bench, "Device.Machine_SetMechanismJntMaxJerk", "MaxJntJerk", 2000);
         EXPECT_NEAR(peak_jerk(bench.joints_to({40, 0, 0}), 0), 2000, 20);
       }},
      {"Device.Machine_SetFeedrate",
       [](SetterBench& bench) {
         bench.call("Device.Machine_SetFeedrate", R"({"Feedrate": 900})");
         EXPECT_NEAR(peak_feed(bench.tip_to(20, 0, 0)), 15, 0.01);
       }},
  };
  return kEffects;
}

}  // namespace rmac::gateway
