// RMAC_CAM's setters: what holds for moves that follow, and the machine's auxiliaries.
#include <gmock/gmock.h>

#include "unit/gateway/api/setters/setter_bench.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

/// Two lines with a right angle between them, one after the other.
Trace corner(SetterBench& bench) {
  bench.call("RMAC_CAM.MoveAlongLine", R"({"MoveID": 1, "StartPoint": {"p": [0, 0, 0], "axis": [0, 0, 1]},
                                           "EndPoint": {"p": [10, 0, 0], "axis": [0, 0, 1]}})");
  bench.call("RMAC_CAM.MoveAlongLine", R"({"MoveID": 2, "StartPoint": {"p": [10, 0, 0], "axis": [0, 0, 1]},
                                           "EndPoint": {"p": [10, 10, 0], "axis": [0, 0, 1]}})");
  return bench.run();
}

/// A clamp on the table, its middle at this x; the spindle's nose has a radius of 25 mm at its height.
std::string setup_with_clamp(double x) {
  return fmt::format(R"({{"Setup": {{"Machine": "DMACXYZ", "Fixtures": [
                            {{"Name": "clamp", "Shape": {{"Box": {{"Size": [10, 10, 20]}}}},
                              "Pose": {{"p": [{}, 0, 0], "axis": [0, 0, 1]}}}}]}}}})",
                     x);
}

/// Changes over to a five-axis machine, and is ready to run.
void load_five_axes(SetterBench& bench) {
  bench.call("Device.Load", R"({"Name": "SuginoXYZAC", "Virtual": true})");
  bench.call("RMAC_CAM.Home");
  bench.run_until([&] { return !bench.now().moving && bench.now().state == CycleState::Idle; });
  bench.call("RMAC_CAM.SetFeedrate", R"({"Feedrate": 1800})");
  bench.call("RMAC_CAM.SetPathTolerance", R"({"Tolerance": 0.05})");
  bench.call("RMAC_CAM.CycleStart", R"({"Mode": "AUTOMATIC"})");
}

/// Straight on by 20 mm with a leaning tool, which leans over further on the second half alone: the slowest in the
/// middle.
double slowest_where_the_axis_begins_to_turn(SetterBench& bench) {
  const std::string start = R"({"p": [0, 0, 0], "axis": [0, 0.28, 0.96]})",
                    half = R"({"p": [10, 0, 0], "axis": [0, 0.28, 0.96]})",
                    end = R"({"p": [20, 0, 0], "axis": [0, 0.6, 0.8]})";
  bench.call("RMAC_CAM.MoveToPathTarget", fmt::format(R"({{"MoveID": 1, "TargetFrame": {}}})", start));
  bench.run();
  const auto line = [&](int id, const std::string& from, const std::string& to) {
    bench.call("RMAC_CAM.MoveAlongLine",
               fmt::format(R"({{"MoveID": {}, "StartPoint": {}, "EndPoint": {}}})", id, from, to));
  };
  line(2, start, half);
  line(3, half, end);
  double slowest = 1e9;
  for (const CycleSample& sample : bench.run()) {
    if (std::abs(sample.pose_set.tip[0] - 10) < 0.2) slowest = std::min(slowest, sample.feed_set_mm_s);
  }
  return slowest;
}

double slowest_at_corner(const Trace& trace) {
  double slowest = 1e9;
  for (const CycleSample& sample : trace) {
    if (std::abs(sample.position_set[0] - 10) < 0.1 && sample.position_set[1] < 0.1) {
      slowest = std::min(slowest, sample.feed_set_mm_s);
    }
  }
  return slowest;
}

}  // namespace

const std::vector<SetterEffect>& cam_setter_effects() {
  static const std::vector<SetterEffect> kEffects{
      {"RMAC_CAM.SetFeedrate",
       [](SetterBench& bench) {
         EXPECT_NEAR(peak_feed(bench.tip_to(20, 0, 0)), 30, 0.01);
         bench.call("RMAC_CAM.SetFeedrate", R"({"Feedrate": 300})");
         EXPECT_NEAR(peak_feed(bench.tip_to(10, 0, 0)), 5, 0.01);
       }},
      {"RMAC_CAM.SetMaxFeedrate",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetMaxFeedrate", R"({"MaxFeedrate": 600})");
         EXPECT_THAT(bench.tip_refusal(20, 0, 0), HasSubstr("above the maximum of 600"));
         EXPECT_THAT(bench.refusal("RMAC_CAM.SetFeedrate", R"({"Feedrate": 601})"), HasSubstr("600"));
       }},
      {"RMAC_CAM.SetJointForce",
       [](SetterBench& bench) {
         EXPECT_THAT(bench.refusal("RMAC_CAM.SetJointForce", R"({"JntNum": 2, "Force": -50})"),
                     HasSubstr("joint 2 (Z) is under position control"));
         bench.joints_to({0, 0, SetterBench::kSurfaceMm + 1});
         bench.call("RMAC_Config.SetMechanismJointControlMethod",
                    R"({"JntNum": 2, "DMACServoControlMethod": "DMAC_FORCE_CONTROL"})");
         bench.apply();
         EXPECT_THAT(bench.refusal("RMAC_CAM.SetJointForce", R"({"JntNum": 2, "Force": -500})"), HasSubstr("5 to 400"));
         bench.call("RMAC_CAM.SetJointForce", R"({"JntNum": 2, "Force": -50})");
         bench.run_until([&] { return std::abs(bench.now().force[2] + 50) < 0.5; });
         bench.call("RMAC_CAM.StopNow");
         bench.run_until([&] { return bench.now().contact[2] == ContactState::Holding; });
       }},
      {"RMAC_CAM.SetFeedOverride",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetFeedOverride", R"({"Percent": 50})");
         EXPECT_NEAR(peak_feed(bench.tip_to(20, 0, 0)), 15, 0.01);
       }},
      {"RMAC_CAM.SetPathAccelRise",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetPathAccelRise", R"({"newVal": 100})");
         const Trace trace = bench.tip_to(40, 0, 0);
         EXPECT_NEAR(peak_feed_rise(trace), 100, 1);
         EXPECT_GT(peak_feed_fall(trace), 300);
       }},
      {"RMAC_CAM.SetPathAccelFall",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetPathAccelFall", R"({"newVal": 100})");
         const Trace trace = bench.tip_to(40, 0, 0);
         EXPECT_NEAR(peak_feed_fall(trace), 100, 1);
         EXPECT_GT(peak_feed_rise(trace), 300);
       }},
      {"RMAC_CAM.SetJointInterpSpeed",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetJointInterpSpeed", R"({"newVal": 10})");
         EXPECT_NEAR(peak(bench.joints_to({40, 0, 0}), &CycleSample::velocity_set, 0), 20, 0.1);
       }},
      {"RMAC_CAM.SetJointAccelRise",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetJointAccelRise", R"({"JointNum": 0, "newVal": 100})");
         const Trace trace = bench.joints_to({40, 0, 0});
         EXPECT_NEAR(peak_feed_rise(trace), 100, 1);
         EXPECT_GT(peak_feed_fall(trace), 300);
       }},
      {"RMAC_CAM.SetJointAccelFall",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetJointAccelFall", R"({"JointNum": 0, "newVal": 100})");
         const Trace trace = bench.joints_to({40, 0, 0});
         EXPECT_NEAR(peak_feed_fall(trace), 100, 1);
         EXPECT_GT(peak_feed_rise(trace), 300);
       }},
      {"RMAC_CAM.SetPathTolerance",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetPathTolerance", R"({"Tolerance": 0})");
         EXPECT_LT(slowest_at_corner(corner(bench)), 1) << "an exact stop";
         bench.tip_to(0, 0, 0);
         bench.call("RMAC_CAM.SetPathTolerance", R"({"Tolerance": 0.05})");
         EXPECT_GT(slowest_at_corner(corner(bench)), 3) << "rounded";
       }},
      {"RMAC_CAM.SetLearnedOffsets",
       [](SetterBench& bench) {
         const nlohmann::json told = bench.call("RMAC_CAM.GetLearnedOffsets");
         const double size = told["Joints"][0]["LargestOffset"].get<double>() / 2;
         nlohmann::json learned{{"Machine", told["Machine"]},
                                {"Configuration", told["Configuration"]},
                                {"Moves", {{1, 0}}},
                                {"End", 40},
                                {"Places", {0, 10, 20, 30, 40}}};
         for (std::size_t j = 0; j < told["Joints"].size(); ++j) {
           const double moved = j == 0 ? size : 0;
           learned["Joints"].push_back({{"Offsets", {0, moved, moved, moved, 0}}});
         }
         // Where the joint comes out, half-way of a move of 40 mm, beside where it is wanted.
         const auto beside = [](const Trace& trace) {
           const CycleSample& half = trace.at(trace.size() / 2);
           return half.position[0] - half.position_set[0];
         };
         const double before = beside(bench.tip_to(40, 0, 0));
         bench.tip_to(0, 0, 0);
         const std::string request = nlohmann::json{{"Learned", learned}}.dump();
         learned["Configuration"] = "another";
         EXPECT_THAT(bench.refusal("RMAC_CAM.SetLearnedOffsets", nlohmann::json{{"Learned", learned}}.dump()),
                     HasSubstr("another configuration"));
         bench.call("RMAC_CAM.SetLearnedOffsets", request);
         EXPECT_NEAR(beside(bench.tip_to(40, 0, 0)) - before, size, 0.1 * size);
       }},
      {"RMAC_CAM.SetOrientationTolerance",
       [](SetterBench& bench) {
         load_five_axes(bench);
         bench.call("RMAC_CAM.SetOrientationTolerance", R"({"Tolerance": 0})");
         EXPECT_LT(slowest_where_the_axis_begins_to_turn(bench), 0.1) << "an exact stop";
         bench.call("RMAC_CAM.SetOrientationTolerance", R"({"Tolerance": 2})");
         EXPECT_GT(slowest_where_the_axis_begins_to_turn(bench), 2) << "within it";
       }},
      {"RMAC_CAM.SetPartFrame",
       [](SetterBench& bench) {
         // Turned by 90 degrees about z: the part's x is the machine's y.
         bench.call("RMAC_CAM.SetPartFrame",
                    R"({"PartFrame": {"p": [1, 2, 3], "q": [0.7071067811865476, 0, 0, 0.7071067811865476]}})");
         const Trace trace = bench.tip_to(10, 0, 0);
         EXPECT_NEAR(trace.back().position_set[0], 1, 1e-5);
         EXPECT_NEAR(trace.back().position_set[1], 12, 1e-5);
         EXPECT_NEAR(trace.back().position_set[2], 3, 1e-5);
       }},
      {"RMAC_CAM.SetCalibratedPartFrame",
       [](SetterBench& bench) {
         bench.joints_to({12, -7, 3});
         bench.call("RMAC_CAM.SetCalibratedPartFrame");
         const Trace trace = bench.tip_to(10, 0, 0);
         EXPECT_NEAR(trace.back().position_set[0], 22, 1e-5) << "the part's zero is where it stood";
         EXPECT_NEAR(trace.back().position_set[1], -7, 1e-5);
         EXPECT_NEAR(trace.back().position_set[2], 3, 1e-5);
       }},
      {"RMAC_CAM.SetToolInterfaceFrame",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetToolInterfaceFrame",
                    R"({"ToolInterfaceFrame": {"p": [0, 1, -30], "q": [1, 0, 0, 0]}})");
         const Trace trace = bench.tip_to(10, 0, 0);
         EXPECT_NEAR(trace.back().position_set[0], 10, 1e-5);
         EXPECT_NEAR(trace.back().position_set[1], -1, 1e-5) << "a tip that stands ahead needs less of the joint";
         EXPECT_NEAR(trace.back().position_set[2], 30, 1e-5) << "a tool 30 mm long";
       }},
      {"RMAC_CAM.SetTool",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetTool", R"({"ToolNumber": 4, "Length": 30, "MaxRPM": 500, "MaxTorque": 1.5,
                                            "Frame": {"p": [0, 1, 0], "q": [1, 0, 0, 0]}})");
         bench.call("RMAC_CAM.DoToolChange", R"({"ToolNumber": 4})");
         bench.run_until([&] { return bench.call("RMAC_CAM.GetTools")["Prompt"] != ""; });
         bench.call("RMAC_CAM.ConfirmToolChange", R"({"ToolNumber": 4})");
         bench.run_until([&] { return bench.call("RMAC_CAM.GetTools")["Mounted"] == 4; });
         const Trace trace = bench.tip_to(10, 0, 0);
         EXPECT_NEAR(trace.back().position_set[1], -1, 1e-5);
         EXPECT_NEAR(trace.back().position_set[2], 30, 1e-5) << "a tool 30 mm long";
         EXPECT_THAT(bench.refusal("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 501})"), HasSubstr("500"));
         bench.call("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 500})");
         bench.run_until([&] { return std::abs(bench.now().spindle_rpm[0] - 500) < 1; });
         bench.bus->push(3, 2);
         bench.run_until([&] { return bench.now().fault.kind == ServoFault::Kind::TorqueBound; });
         EXPECT_EQ(bench.now().fault.bound, 1.5) << "what the tool bears";
       }},
      {"RMAC_CAM.SetSpindleRPM",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 600})");
         bench.tip_to(1, 0, 0);
         EXPECT_NEAR(bench.bus->spindle(3).speed_rpm(), 600, 20) << "feed waited for it";
       }},
      {"RMAC_CAM.SetSpindleMaxRPM",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetSpindleMaxRPM", R"({"SpindleNumber": 0, "MaxRPM": 500})");
         EXPECT_THAT(bench.refusal("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 501})"), HasSubstr("500"));
         bench.call("RMAC_CAM.SetSpindleRPM", R"({"SpindleNumber": 0, "RPM": 500})");
         bench.run_until([&] { return std::abs(bench.now().spindle_rpm[0] - 500) < 1; });
       }},
      {"RMAC_CAM.SetOptionalStop",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.ProgramStop", R"({"MoveID": 1, "Optional": true})");
         bench.tip_to(1, 0, 0);
         EXPECT_EQ(bench.now().state, CycleState::Running) << "passed over";
         bench.call("RMAC_CAM.SetOptionalStop", R"({"On": true})");
         bench.call("RMAC_CAM.ProgramStop", R"({"MoveID": 2, "Optional": true})");
         bench.run_until([&] { return bench.now().state == CycleState::Holding; });
       }},
      {"RMAC_CAM.SetSetup",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetSetup", setup_with_clamp(-40));
         bench.call("RMAC_CAM.SetCollisionCheck", R"({"On": true})");
         bench.tip_to(20, 0, 0);
         bench.call("RMAC_CAM.SetSetup", setup_with_clamp(60));
         bench.call("RMAC_CAM.MoveToJointTarget", R"({"MoveID": 5, "JointTargetFrame": {"joints": [40, 0, 0]}})");
         bench.run_until([&] { return bench.now().state == CycleState::Holding; });
         EXPECT_LT(bench.now().position_set[0], 30) << "the other side is not free any more";
       }},
      {"RMAC_CAM.SetCollisionCheck",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetSetup", setup_with_clamp(60));
         bench.tip_to(40, 0, 0);
         bench.tip_to(0, 0, 0);
         bench.call("RMAC_CAM.SetCollisionCheck", R"({"On": true})");
         bench.call("RMAC_CAM.MoveToJointTarget", R"({"MoveID": 5, "JointTargetFrame": {"joints": [40, 0, 0]}})");
         bench.run_until([&] { return bench.now().state == CycleState::Holding; });
         EXPECT_LT(bench.now().position_set[0], 30) << "nothing was in the way before";
         EXPECT_THAT(bench.refusal("RMAC_CAM.FeedResume"), HasSubstr("a collision lies ahead"));
       }},
      {"RMAC_CAM.SetOutput",
       [](SetterBench& bench) {
         const std::uint64_t before = bench.now().outputs;
         bench.call("RMAC_CAM.SetOutput", R"({"Name": "Coolant", "On": true})");
         bench.run_until([&] { return bench.now().outputs != before; });
         bench.call("RMAC_CAM.SetOutput", R"({"Name": "Coolant", "On": false})");
         bench.run_until([&] { return bench.now().outputs == before; });
       }},
      {"RMAC_CAM.SetCycleStartStatus",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.CycleStop", R"({"Mode": "AUTOMATIC"})");
         bench.run_until([&] { return bench.now().state == CycleState::Idle; });
         bench.call("RMAC_CAM.SetCycleStartStatus", R"({"status": true})");
         EXPECT_NEAR(bench.tip_to(1, 0, 0).back().position_set[0], 1, 1e-5);
       }},
      {"RMAC_CAM.SetCycleStopStatus",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetFeedrate", R"({"Feedrate": 60})");
         bench.call("RMAC_CAM.MoveToPathTarget",
                    R"({"MoveID": 1, "TargetFrame": {"p": [40, 0, 0], "axis": [0, 0, 1]}})");
         bench.run_until([&] { return bench.now().moving; });
         bench.call("RMAC_CAM.SetCycleStopStatus", R"({"status": true})");
         bench.run_until([&] { return bench.now().state == CycleState::Idle; });
         EXPECT_LT(bench.now().position_set[0], 39);
         EXPECT_EQ(bench.call("RMAC_CAM.NumMovesInBuffer"), 1);
       }},
      {"RMAC_CAM.SetAnimation",
       [](SetterBench& bench) {
         bench.call("RMAC_CAM.SetAnimation", R"({"mode": true})");
         EXPECT_TRUE(bench.session.animation) << "what the session then streams is the server's tests' to show";
         bench.call("RMAC_CAM.SetAnimation", R"({"mode": false})");
         EXPECT_FALSE(bench.session.animation);
       }},
  };
  return kEffects;
}

}  // namespace rmac::gateway
