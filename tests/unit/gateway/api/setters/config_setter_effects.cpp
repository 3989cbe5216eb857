// RMAC_Config's setters: each is called, applied, and seen in what the machine then does.
#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>

#include "unit/gateway/api/setters/setter_bench.hpp"

namespace rmac::gateway {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Sets one value of joint 0, and applies it.
void apply_to_joint(SetterBench& bench, const char* setter, const char* parameter, double value) {
  bench.call(setter, fmt::format(R"({{"JntNum": 0, "{}": {}}})", parameter, value));
  bench.apply();
}

/// The mill without its third axis takes four setters. Each must be needed: without it the configuration is refused,
/// and the mill goes on as it was; with it the machine moves in the plane, and the third drive is let go.
void becomes_planar_by(SetterBench& bench, const std::string& setter, const std::string& params) {
  const std::vector<std::pair<std::string, std::string>> all{
      {"RMAC_Config.SetMechanismKinematics", R"({"DMACKin": "TestKinematics2"})"},
      {"RMAC_Config.SetMechanismActuatorMap", R"({"DMACMachineActMap": "PlaneMap"})"},
      {"RMAC_Config.SetMechanismNumJnts", R"({"NumJnts": 2})"},
      {"RMAC_Config.SetMechanismNumActuators", R"({"NumActuators": 2})"}};
  for (const auto& [other, its_params] : all) {
    if (other != setter) bench.call(other, its_params);
  }
  bench.refusal("RMAC_Config.Apply");
  EXPECT_NEAR(bench.tip_to(0, 0, 2).back().position_set[2], 2, 1e-5) << "still the mill with three axes";
  bench.tip_to(0, 0, 0);
  bench.call(setter, params);
  bench.apply();
  EXPECT_THAT(bench.tip_refusal(0, 0, 2), HasSubstr("reach"));
  const Trace trace = bench.tip_to(3, 4, 0);
  EXPECT_NEAR(trace.back().position_set[1], 4, 1e-5);
  EXPECT_EQ(trace.back().joint_count_with_held, 2U);
}

/// Puts the spindle's drive into torque mode, behind a PID with these gains.
void drive_spindle_by_torque(SetterBench& bench, const char* gains) {
  bench.call("RMAC_Config.SetMechanismDigitalControlInterface", R"({"DigitalControlInterface": "TorqueInterface"})");
  bench.call("RMAC_Config.SetMechanismSpindleServoControlLaw", R"({"ControlLaw": "DMAC_PID_CONTROL"})");
  bench.call("RMAC_Config.SetMechanismSpindleServoControlGains", fmt::format(R"({{"ServoControlGains": {}}})", gains));
}

constexpr const char* kSpindleGains = "[0.06, 1, 0]";

/// How far the spindle falls behind 600 rpm when 2 N·m brake it.
double slowed_by_load(SetterBench& bench) {
  bench.call("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 600})");
  bench.run_until([&] { return std::abs(bench.now().spindle_rpm[0] - 600) < 1; });
  bench.torque_bus->push(3, -2);
  double slowest = 600;
  const double until = bench.now().t_s + 0.5;
  bench.run_until([&] {
    slowest = std::min(slowest, bench.now().spindle_rpm[0]);
    return bench.now().t_s > until;
  });
  bench.torque_bus->push(3, 0);
  return 600 - slowest;
}

}  // namespace

const std::vector<SetterEffect>& config_setter_effects() {
  static const std::vector<SetterEffect> kEffects{
      {"RMAC_Config.SetMechanismKinematics",
       [](SetterBench& bench) {
         EXPECT_NEAR(bench.tip_to(10, 0, 0).back().position_set[0], 10, 1e-5);
         bench.call("RMAC_Config.SetMechanismKinematics", R"({"DMACKin": "ShiftedKinematics"})");
         bench.apply();
         EXPECT_NEAR(bench.tip_to(20, 0, 0).back().position_set[0], 13, 1e-5) << "its tool stands 7 mm ahead";
       }},
      {"RMAC_Config.SetMechanismActuatorMap",
       [](SetterBench& bench) {
         constexpr double kTurn = 2 * std::numbers::pi;
         const double at_home = bench.bus->plant(0).angle_rad();
         bench.joints_to({10, 0, 0});
         EXPECT_NEAR(bench.bus->plant(0).angle_rad() - at_home, 2 * kTurn, 0.1) << "a pitch of 5 mm";
         bench.joints_to({0, 0, 0});
         bench.call("RMAC_Config.SetMechanismActuatorMap", R"({"DMACMachineActMap": "CoarseMap"})");
         // The same motor moves a quarter of the mass at twice the pitch.
         for (const int joint : {0, 1, 2}) {
           bench.call("RMAC_Config.SetMechanismJointServoControlGains",
                      fmt::format(R"({{"JntNum": {}, "ServoControlGains": [300, 27000, 2.1]}})", joint));
         }
         bench.apply();
         bench.joints_to({10, 0, 0});
         EXPECT_NEAR(bench.bus->plant(0).angle_rad() - at_home, kTurn, 0.1) << "a pitch of 10 mm";
       }},
      {"RMAC_Config.SetMechanismNumJnts",
       [](SetterBench& bench) { becomes_planar_by(bench, "RMAC_Config.SetMechanismNumJnts", R"({"NumJnts": 2})"); }},
      {"RMAC_Config.SetMechanismNumActuators",
       [](SetterBench& bench) {
         becomes_planar_by(bench, "RMAC_Config.SetMechanismNumActuators", R"({"NumActuators": 2})");
       }},
      {"RMAC_Config.SetMechanismNumSpindle",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 600})");
         bench.run_until([&] { return bench.now().spindle_rpm[0] > 590; });
         bench.call("RMAC_Config.SetMechanismNumSpindle", R"({"NumSpindle": 0})");
         bench.apply();
         bench.run_until([&] { return bench.bus->spindle(3).speed_rpm() == 0; });
         EXPECT_THAT(bench.refusal("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 600})"),
                     HasSubstr("no spindle"));
       }},
      {"RMAC_Config.SetMechanismSpindleMaxRPM",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 800})");
         bench.run_until([&] { return bench.now().spindle_rpm[0] > 790; });
         bench.call("RMAC_Config.SetMechanismSpindleMaxRPM", R"({"MaxSpindleRPM": 500})");
         bench.apply();
         bench.run_until([&] { return std::abs(bench.now().spindle_rpm[0] - 500) < 1; });
         EXPECT_THAT(bench.refusal("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 800})"), HasSubstr("500"));
         EXPECT_NEAR(bench.tip_to(5, 0, 0).back().position_set[0], 5, 1e-5)
             << "the spindle is at the speed that it may have";
       }},
      {"RMAC_Config.SetMechanismSpindleControlMethod",
       [](SetterBench& bench) {
         bench.call("RMAC_Config.SetMechanismSpindleControlMethod",
                    R"({"DMACServoControlMethod": "DMAC_POSITION_CONTROL"})");
         EXPECT_THAT(bench.refusal("RMAC_Config.Apply"),
                     AllOf(HasSubstr("spindle 0 (bus sim0, axis 3)"), HasSubstr("mode 3"), HasSubstr("angle")));
         EXPECT_THAT(bench.refusal("RMAC_Config.SetMechanismSpindleControlMethod",
                                   R"({"DMACServoControlMethod": "DMAC_FORCE_CONTROL"})"),
                     HasSubstr("nothing asks a spindle for a force"));
         const auto given_way = [&] {  // to 1 N·m, at rest
           bench.run_until([&] { return bench.now().servo_state == ServoState::Engaged; });
           const double before = bench.torque_bus->plant(3).angle_rad();
           bench.torque_bus->push(3, 1);
           const double until = bench.now().t_s + 1;
           bench.run_until([&] { return bench.now().t_s > until; });
           bench.torque_bus->push(3, 0);
           return std::abs(bench.torque_bus->plant(3).angle_rad() - before);
         };
         bench.call("RMAC_Config.SetMechanismSpindleControlMethod",
                    R"({"DMACServoControlMethod": "DMAC_VELOCITY_CONTROL"})");
         drive_spindle_by_torque(bench, kSpindleGains);
         bench.apply_interface();
         EXPECT_GT(given_way(), 0.06) << "its speed is held, and its angle is not";
         bench.call("RMAC_Config.SetMechanismSpindleControlMethod",
                    R"({"DMACServoControlMethod": "DMAC_POSITION_CONTROL"})");
         bench.call("RMAC_Config.SetMechanismSpindleServoControlGains", R"({"ServoControlGains": [0.7, 4, 0.012]})");
         bench.apply();
         EXPECT_LT(given_way(), 0.02) << "it stands where it is";
         bench.call("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 300})");
         bench.run_until([&] { return std::abs(bench.now().spindle_rpm[0] - 300) < 1; });
       }},
      {"RMAC_Config.SetMechanismSpindleServoControlLaw",
       [](SetterBench& bench) {
         drive_spindle_by_torque(bench, kSpindleGains);
         bench.apply_interface();
         EXPECT_LT(slowed_by_load(bench), 100) << "it holds its speed";
         bench.call("RMAC_Config.SetMechanismSpindleServoControlLaw", R"({"ControlLaw": ""})");
         EXPECT_THAT(bench.refusal("RMAC_Config.Apply"),
                     AllOf(HasSubstr("spindle 0 (bus sim0, axis 3)"), HasSubstr("no servo law to make it")));
         // A spring without an integral.
         bench.call("RMAC_Config.SetMechanismSpindleServoControlLaw", R"({"ControlLaw": "TestLaw"})");
         bench.call("RMAC_Config.SetMechanismSpindleServoControlGains", R"({"ServoControlGains": [0.06, 0]})");
         bench.apply();
         bench.call("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 600})");
         bench.torque_bus->push(3, -1);
         const double until = bench.now().t_s + 2;
         bench.run_until([&] { return bench.now().t_s > until; });
         EXPECT_NEAR(bench.now().spindle_rpm[0], 600 - (1 + 0.1) / 0.06, 3) << "it gives way to load and friction";
       }},
      {"RMAC_Config.SetMechanismSpindleServoControlGains",
       [](SetterBench& bench) {
         drive_spindle_by_torque(bench, kSpindleGains);
         bench.apply_interface();
         const double soft = slowed_by_load(bench);
         bench.call("RMAC_Config.SetMechanismSpindleServoControlGains", R"({"ServoControlGains": [0.12, 4, 0]})");
         bench.apply();
         EXPECT_LT(slowed_by_load(bench), 0.7 * soft);
       }},
      {"RMAC_Config.SetMechanismDigitalControlInterface",
       [](SetterBench& bench) {
         EXPECT_NEAR(bench.tip_to(5, 0, 0).back().position_set[0], 5, 1e-5);
         drive_spindle_by_torque(bench, "[1]");
         EXPECT_THAT(bench.refusal("RMAC_Config.Apply"),
                     AllOf(HasSubstr("PIDServoControlLaw does not accept the gains"),
                           HasSubstr("in force again over SimulatedInterface")));
         bench.call("RMAC_CAM.CycleStart", R"({"Mode": "AUTOMATIC"})");
         EXPECT_NEAR(bench.tip_to(0, 0, 0).back().position[0], 0, 0.05) << "the old drives do their work";
         drive_spindle_by_torque(bench, kSpindleGains);
         bench.apply_interface();
         const double old_shaft = bench.bus->plant(0).angle_rad();
         bench.tip_to(10, 0, 0);
         EXPECT_NEAR(bench.torque_bus->plant(0).angle_rad(), 4 * std::numbers::pi, 0.1) << "two turns of 5 mm";
         EXPECT_EQ(bench.bus->plant(0).angle_rad(), old_shaft);
       }},
      {"RMAC_Config.SetMechanismMaxFeedrate",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetFeedOverride", R"({"Percent": 200})");
         EXPECT_NEAR(peak_feed(bench.tip_to(20, 0, 0)), 2000.0 / 60, 0.1);
         bench.call("RMAC_Config.SetMechanismMaxFeedrate", R"({"MaxFeedrate": 600})");
         bench.apply();
         EXPECT_THAT(bench.tip_refusal(0, 0, 0), HasSubstr("above the maximum of 600"));
         bench.call("RMAC_CAM.SetFeedrate", R"({"Feedrate": 600})");
         EXPECT_NEAR(peak_feed(bench.tip_to(0, 0, 0)), 10, 0.01) << "no override passes it";
       }},
      {"RMAC_Config.SetMechanismJointType",
       [](SetterBench& bench) {
         bench.call("RMAC_Config.SetMechanismJointType", R"({"JntNum": 1, "JointType": "DMAC_ROT_JNT"})");
         EXPECT_THAT(bench.refusal("RMAC_Config.Apply"), AllOf(HasSubstr("\"Y\""), HasSubstr("Rotary"),
                                                               HasSubstr("DMACXYZKinematics"), HasSubstr("Linear")));
         EXPECT_NEAR(bench.tip_to(0, 2, 0).back().position_set[1], 2, 1e-5) << "the old mechanism is in force";
         bench.call("RMAC_Config.SetMechanismJointType", R"({"JntNum": 1, "JointType": "DMAC_LIN_JNT"})");
         bench.apply();
       }},
      {"RMAC_Config.SetMechanismJointName",
       [](SetterBench& bench) {
         bench.call("RMAC_Config.SetMechanismJointName", R"({"JntNum": 0, "Name": "Long"})");
         bench.apply();
         EXPECT_THAT(bench.tip_refusal(60, 0, 0), HasSubstr("Long"));
         bench.call("RMAC_Config.SetMechanismJointName", R"({"JntNum": 1, "Name": "Long"})");
         EXPECT_THAT(bench.refusal("RMAC_Config.Apply"), HasSubstr("a name of its own"));
       }},
      {"RMAC_Config.SetMechanismJointWatch",
       [](SetterBench& bench) {
         EXPECT_NEAR(bench.joints_to({30, 0, 0}).back().position[0], 30, 0.05);
         bench.call("RMAC_Config.SetMechanismJointWatch", R"({"JntNum": 0, "MaxFollowingError": 0.2, "MaxEffort": 5})");
         bench.apply();
         bench.call("RMAC_CAM.MoveToJointTarget", R"({"MoveID": 2, "JointTargetFrame": {"joints": [0, 0, 0]}})");
         bench.run_until([&] { return bench.now().fault.kind == ServoFault::Kind::StandsStill; });
         EXPECT_NEAR(bench.now().fault.value, -0.2, 0.02) << "5 N do not even overcome friction";
       }},
      {"RMAC_Config.SetMechanismJointFilters",
       [](SetterBench& bench) {
         EXPECT_NEAR(bench.joints_to({30, 0, 0}).back().position[0], 30, 0.05);
         const auto refusal = [&](const char* filters) {
           return bench.refusal("RMAC_Config.SetMechanismJointFilters", fmt::format(R"({{"JntNum": 0, {}}})", filters));
         };
         EXPECT_THAT(refusal(R"("Resonances": [{"Frequency": 80}], "LowPass": 0)"),
                     AllOf(HasSubstr("Resonances"), HasSubstr("Damping")));
         EXPECT_THAT(refusal(R"("Resonances": [], "LowPass": -1)"), HasSubstr("LowPass"));
         bench.call("RMAC_Config.SetMechanismJointFilters",
                    R"({"JntNum": 0, "Resonances": [{"Frequency": 80, "Damping": 0.9, "Width": 0.5}], "LowPass": 0})");
         EXPECT_THAT(bench.refusal("RMAC_Config.Apply"), HasSubstr("a width above the damping"));
         EXPECT_NEAR(bench.joints_to({0, 0, 0}).back().position[0], 0, 0.05) << "nothing was changed";
         bench.call("RMAC_Config.SetMechanismJointFilters", R"({"JntNum": 0, "Resonances": [], "LowPass": 20})");
         bench.apply();
         bench.call("RMAC_CAM.MoveToJointTarget", R"({"MoveID": 2, "JointTargetFrame": {"joints": [30, 0, 0]}})");
         bench.run_until([&] { return bench.now().fault.kind != ServoFault::Kind::None; });
         EXPECT_LT(bench.now().position[0], 29) << "a loop that is so late does not hold";
       }},
      {"RMAC_Config.SetMechanismJointLimitType",
       [](SetterBench& bench) {
         EXPECT_THAT(bench.tip_refusal(60, 0, 0), HasSubstr("beyond its limit of 50"));
         bench.call("RMAC_Config.SetMechanismJointLimitType",
                    R"({"JntNum": 0, "JointLimitType": "DMAC_INFINITY_JNT_POS"})");
         bench.apply();
         EXPECT_NEAR(bench.joints_to({60, 0, 0}).back().position[0], 60, 0.05);
         EXPECT_THAT(bench.tip_refusal(-60, 0, 0), HasSubstr("beyond its limit of -50"));
       }},
      {"RMAC_Config.SetMechanismJointMaximumLimit",
       [](SetterBench& bench) {
         apply_to_joint(bench, "RMAC_Config.SetMechanismJointMaximumLimit", "MaxJntLimit", 20);
         EXPECT_THAT(bench.tip_refusal(30, 0, 0), HasSubstr("beyond its limit of 20"));
         apply_to_joint(bench, "RMAC_Config.SetMechanismJointMaximumLimit", "MaxJntLimit", 60);
         EXPECT_NEAR(bench.joints_to({55, 0, 0}).back().position[0], 55, 0.05);
       }},
      {"RMAC_Config.SetMechanismJointMinimumLimit",
       [](SetterBench& bench) {
         apply_to_joint(bench, "RMAC_Config.SetMechanismJointMinimumLimit", "MinJntLimit", -20);
         EXPECT_THAT(bench.tip_refusal(-30, 0, 0), HasSubstr("beyond its limit of -20"));
         apply_to_joint(bench, "RMAC_Config.SetMechanismJointMinimumLimit", "MinJntLimit", -60);
         EXPECT_NEAR(bench.joints_to({-55, 0, 0}).back().position[0], -55, 0.05);
       }},
      {"RMAC_Config.SetMechanismJointMaximumSpeed",
       [](SetterBench& bench) {
         EXPECT_GT(peak(bench.joints_to({40, 0, 0}), &CycleSample::velocity_set, 0), 140);
         apply_to_joint(bench, "RMAC_Config.SetMechanismJointMaximumSpeed", "MaxJntSpeed", 25);
         EXPECT_NEAR(peak(bench.joints_to({0, 0, 0}), &CycleSample::velocity_set, 0), 25, 0.1);
       }},
      {"RMAC_Config.SetMechanismJointMaximumAcceleration",
       [](SetterBench& bench) {
         EXPECT_NEAR(peak(bench.joints_to({40, 0, 0}), &CycleSample::acceleration_set, 0), 1000, 10);
         apply_to_joint(bench, "RMAC_Config.SetMechanismJointMaximumAcceleration", "MaxJntAccel", 250);
         EXPECT_NEAR(peak(bench.joints_to({0, 0, 0}), &CycleSample::acceleration_set, 0), 250, 2.5);
       }},
      {"RMAC_Config.SetMechanismJointMaximumJerk",
       [](SetterBench& bench) {
         EXPECT_NEAR(peak_jerk(bench.joints_to({40, 0, 0}), 0), 10000, 100);
         apply_to_joint(bench, "RMAC_Config.SetMechanismJointMaximumJerk", "MaxJntJerk", 2000);
         EXPECT_NEAR(peak_jerk(bench.joints_to({0, 0, 0}), 0), 2000, 20);
       }},
      {"RMAC_Config.SetMechanismJointControlMethod",
       [](SetterBench& bench) {
         EXPECT_NEAR(bench.joints_to({0, 0, 5}).back().position[2], 5, 0.05);
         bench.call("RMAC_Config.SetMechanismJointControlMethod",
                    R"({"JntNum": 2, "DMACServoControlMethod": "DMAC_FORCE_CONTROL"})");
         bench.apply();
         EXPECT_EQ(bench.now().contact[2], ContactState::Holding);
         EXPECT_NEAR(bench.joints_to({5, 0, 0}).back().position[2], 5, 0.05) << "it is out of the plan";
         bench.call("RMAC_Config.SetMechanismJointControlMethod",
                    R"({"JntNum": 2, "DMACServoControlMethod": "DMAC_POSITION_CONTROL"})");
         bench.apply();
         EXPECT_NEAR(bench.joints_to({0, 0, 2}).back().position[2], 2, 0.05) << "and follows it again";
       }},
      {"RMAC_Config.SetMechanismJointServoControlGains",
       [](SetterBench& bench) {
         const double stiff = peak_following_error(bench.joints_to({30, 0, 0}), 0);
         bench.call("RMAC_Config.SetMechanismJointServoControlGains",
                    R"({"JntNum": 0, "ServoControlGains": [172, 3650, 4.2]})");
         bench.apply();
         EXPECT_GT(peak_following_error(bench.joints_to({0, 0, 0}), 0), 1.5 * stiff) << "half the stiffness";
       }},
      {"RMAC_Config.SetMechanismJointServoControlLaw",
       [](SetterBench& bench) {
         const auto settled = [](const Trace& trace) {  // in the middle, at a steady speed
           const CycleSample& sample = trace[trace.size() / 2];
           return std::abs(sample.position_set[0] - sample.position[0]);
         };
         EXPECT_LT(settled(bench.tip_to(30, 0, 0)), 0.005) << "an integral takes the friction";
         bench.call("RMAC_Config.SetMechanismJointServoControlLaw", R"({"JntNum": 0, "ControlLaw": "TestLaw"})");
         bench.call("RMAC_Config.SetMechanismJointServoControlGains",
                    R"({"JntNum": 0, "ServoControlGains": [300, 4]})");
         bench.apply();
         EXPECT_GT(settled(bench.tip_to(0, 0, 0)), 0.03) << "a spring gives way to it";
       }},
      {"RMAC_Config.SetMechanismJointServoControlParameter",
       [](SetterBench& bench) {
         bench.call("RMAC_Config.SetMechanismJointServoControlLaw",
                    R"({"JntNum": 0, "ControlLaw": "DMAC_FEEDFORWARDFEEDBACK_CONTROL",
                        "Parameters": {"lead_s": 0.0033, "presliding": 0.0098, "breakaway": 1.2}})");
         bench.call("RMAC_Config.SetMechanismJointServoControlGains",
                    R"({"JntNum": 0, "ServoControlGains": [345, 14600, 6.0, 0.158, 0.0349, 18.9, 0]})");
         bench.apply();
         const double known = peak_following_error(bench.joints_to({30, 0, 0}), 0);
         const auto set = [&](const char* name, double value) {
           bench.call("RMAC_Config.SetMechanismJointServoControlParameter",
                      fmt::format(R"({{"JntNum": 0, "Name": "{}", "Value": {}}})", name, value));
         };
         set("presliding", 1);
         bench.apply();
         EXPECT_GT(peak_following_error(bench.joints_to({0, 0, 0}), 0), 1.5 * known) << "friction made good too late";
         set("friction_sped", 0.5);
         EXPECT_THAT(bench.refusal("RMAC_Config.Apply"), HasSubstr("friction_sped is not understood"));
       }},
      {"RMAC_Config.SetMechanismDigitalIOInterface",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.TurnCoolantOn");
         bench.run_until([&] { return bench.io->outputs() == 1; });
         bench.call("RMAC_Config.SetMechanismDigitalIOInterface", R"({"DigitalIOInterface": "OtherIo"})");
         bench.apply();
         bench.run_until([&] { return bench.other_io->outputs() == 1; });
         bench.call("RMAC_CAM.TurnCoolantOff");
         bench.run_until([&] { return bench.other_io->outputs() == 0; });
       }},
  };
  return kEffects;
}

}  // namespace rmac::gateway
