// What tune and measure-following refuse, and how they move; what they find is tried on simulated joints
// (tests/system).
#include <gmock/gmock.h>

#include "gateway/rmac/wire/authority.hpp"
#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class TuneCommand : public CommandBench {
 protected:
  TuneCommand() {
    appliance_.answers("RMAC_CAM.GetJointInterpSpeed", 42.0);
    appliance_.answers("Device.Machine_GetMechanismJntServoControlLaw", "DMAC_PID_CONTROL");
    // Whatever moved, nothing is recorded: the command ends there.
    appliance_.refuses("FlightRecorder.Record", -32001, "the recorder is off");
    appliance_.handles("RMAC_CAM.JogJoint", [this](const json& params) {
      place_ += params.at("Distance").get<double>();
      appliance_.answers("RMAC_CAM.GetState", state({{"joints", {0.0, place_}}, {"joints_set", {0.0, place_}}}));
      return gateway::Answer(true);
    });
  }
  double place_ = 0;  ///< of joint 1
  Outcome tune(std::vector<std::string> words = {"--travel", "8"}) {
    words.insert(words.begin(), {"tune", "1", "-o", testing::TempDir() + "tune_test.png"});
    return run(words);
  }
};

class MeasureFollowingCommand : public CommandBench {
 protected:
  MeasureFollowingCommand() {
    appliance_.answers("RMAC_CAM.GetState", state({{"pose", {10.0, 20.0, 30.0, 0.0, 0.0, 1.0}}}));
    appliance_.answers("RMAC_CAM.GetPathTolerance", 0.02);
    appliance_.answers("Device.Machine_GetMechanismMaxFeedrate", 6000.0);
    appliance_.refuses("FlightRecorder.Record", -32001, "the recorder is off");
  }
  Outcome follow(std::vector<std::string> words = {}) {
    words.insert(words.begin(), {"measure-following", "-o", testing::TempDir() + "following_test.png"});
    return run(words);
  }
};

TEST_F(TuneCommand, SwingsSlowlyFirstAndPutsTheSpeedBack) {
  EXPECT_EQ(tune().err, "rmac: the recorder is off\n");
  std::vector<double> speeds, ways;
  for (const json& params : appliance_.params_of("RMAC_CAM.SetJointInterpSpeed")) speeds.push_back(params.at("newVal"));
  for (const json& params : appliance_.params_of("RMAC_CAM.JogJoint")) {
    EXPECT_EQ(params.at("JntNum"), 1);
    ways.push_back(params.at("Distance"));
  }
  EXPECT_THAT(speeds, testing::ElementsAre(10, 25, 50, 100, 42));
  ASSERT_EQ(ways.size(), 8U);
  for (std::size_t i = 0; i < 8; i += 2) EXPECT_DOUBLE_EQ(ways[i + 1], -ways[i]) << "it comes back";
  EXPECT_DOUBLE_EQ(ways[6], 8);
  EXPECT_THAT(appliance_.methods(), testing::Contains("RMAC_CAM.StopNow"));
  EXPECT_EQ(appliance_.methods().back(), kReleaseAuthority);
}

TEST_F(TuneCommand, MovesNothingOfAFaultedMachineAndTellsWhatStoppedIt) {
  appliance_.answers("RMAC_CAM.GetState",
                     state({{"state", "Faulted"}, {"last_stop", {{"kind", "Fault"}, {"message", "the bus is gone"}}}}));
  EXPECT_THAT(tune().err, testing::AllOf(HasSubstr("is faulted"), HasSubstr("the bus is gone")));
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.JogJoint"), IsEmpty());
}

TEST_F(TuneCommand, GoesNoFurtherFromWhereSomebodyStoppedTheJoint) {
  appliance_.handles("RMAC_CAM.JogJoint", [this](const json&) {
    appliance_.answers("RMAC_CAM.GetState", state({{"joints", {0.0, 1.3}}, {"joints_set", {0.0, 1.3}}}));
    return gateway::Answer(true);
  });
  EXPECT_THAT(tune().err, HasSubstr("joint 1 stands at 1.300 instead of 2.530: somebody stopped it"));
  EXPECT_EQ(appliance_.params_of("RMAC_CAM.JogJoint").size(), 1U);
}

TEST_F(TuneCommand, TellsAJointThatFrictionHoldsFromOneThatSomebodyStopped) {
  appliance_.handles("RMAC_CAM.JogJoint", [this](const json& params) {
    place_ += params.at("Distance").get<double>();
    appliance_.answers("RMAC_CAM.GetState", state({{"joints", {0.0, 0.1}}, {"joints_set", {0.0, place_}}}));
    return gateway::Answer(true);
  });
  EXPECT_THAT(tune().err, testing::AllOf(HasSubstr("joint 1 was sent 2.53 further, and rests 2.43 beside that"),
                                         HasSubstr("too soft for its friction")));
  EXPECT_EQ(appliance_.params_of("RMAC_CAM.JogJoint").size(), 1U);
}

TEST_F(TuneCommand, RefusesASweepThatIsNone) {
  EXPECT_EQ(tune({"--travel", "8", "--sweep-effort", "-1"}).exit_code, 2);
}

TEST_F(TuneCommand, PutsTheSpeedBackAndSwingsNoMoreWhenAJogIsRefused) {
  appliance_.refuses("RMAC_CAM.JogJoint", -32004, "out of its travel");
  EXPECT_EQ(tune().err, "rmac: out of its travel\n");
  EXPECT_EQ(appliance_.params_of("RMAC_CAM.JogJoint").size(), 1U);
  EXPECT_EQ(appliance_.params_of("RMAC_CAM.SetJointInterpSpeed").back(), (json{{"newVal", 42.0}}));
}

TEST_F(TuneCommand, RefusesAMachineOfWhichNothingWouldBeFound) {
  appliance_.answers("RMAC_CAM.GetState", state({{"mechanism", ""}}));
  EXPECT_THAT(tune().err, HasSubstr("no machine is loaded"));
  appliance_.answers("RMAC_CAM.GetState", state({{"virtual", true}}));
  EXPECT_THAT(tune().err, HasSubstr("in virtual mode"));
  appliance_.answers("RMAC_CAM.GetState", state({{"joints", {0.0}}}));
  EXPECT_THAT(tune().err, HasSubstr("there is no joint 1; the machine has 1"));
  appliance_.answers("RMAC_CAM.GetState", state());
  appliance_.answers("Device.Machine_GetMechanismJntServoControlLaw", "");
  EXPECT_THAT(tune().err, HasSubstr("its drive closes the loop itself"));
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.JogJoint"), IsEmpty());
}

TEST_F(TuneCommand, AsksNothingOfTheMachineForWordsThatMakeNoSense) {
  EXPECT_THAT(tune({"--travel", "0"}).err, HasSubstr("give the way that the joint may go"));
  EXPECT_THAT(run({"tune", "0", "--travel", "1", "-o", "x.bmp"}).err, HasSubstr("ends in .png"));
  EXPECT_EQ(tune({}).exit_code, 2);
  EXPECT_EQ(tune({"--travel", "1", "--bandwidth", "0"}).exit_code, 2);
  EXPECT_EQ(tune({"--travel", "1", "--phase-margin", "31.9"}).exit_code, 2);
  EXPECT_EQ(tune({"--travel", "1", "--phase-margin", "70.1"}).exit_code, 2);
  EXPECT_EQ(run({"tune", "32", "--travel", "1"}).exit_code, 2);
  EXPECT_THAT(appliance_.methods(), IsEmpty());
}

TEST_F(MeasureFollowingCommand, GoesRoundUpwardsInYFromWhereTheToolStands) {
  EXPECT_EQ(follow({"--radius", "5"}).err, "rmac: the recorder is off\n");
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.SetFeedrate"), testing::ElementsAre(json{{"Feedrate", 6000.0}}));
  const auto arcs = appliance_.params_of("RMAC_CAM.MoveAlongArc");
  ASSERT_EQ(arcs.size(), 3U);
  for (const json& arc : arcs) EXPECT_EQ(arc.at("CenterPoint").at("p"), (json{10.0, 25.0, 30.0}));
  EXPECT_EQ(arcs[0].at("StartPoint").at("p"), (json{10.0, 20.0, 30.0})) << "where the tool stands";
  EXPECT_EQ(arcs[1].at("Closed"), true);
  EXPECT_EQ(arcs[1].at("StartPoint"), arcs[1].at("EndPoint"));
  EXPECT_EQ(arcs[2].at("EndPoint").at("p"), (json{10.0, 30.0, 30.0}));
}

TEST_F(MeasureFollowingCommand, IsExactlyOnTheCircleAndPutsTheToleranceBack) {
  follow({"--feed", "1200"});
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.SetPathTolerance"),
              testing::ElementsAre(json{{"Tolerance", 0}}, json{{"Tolerance", 0.02}}));
  EXPECT_EQ(appliance_.params_of("RMAC_CAM.SetFeedrate").front().at("Feedrate"), 1200.0);
  EXPECT_THAT(appliance_.methods(), Not(testing::Contains("Device.Machine_GetMechanismMaxFeedrate")));
}

TEST_F(MeasureFollowingCommand, PutsTheToleranceBackWhenAMoveIsRefused) {
  appliance_.refuses("RMAC_CAM.MoveAlongArc", -32004, "out of reach");
  EXPECT_EQ(follow().err, "rmac: out of reach\n");
  EXPECT_EQ(appliance_.params_of("RMAC_CAM.SetPathTolerance").back().at("Tolerance"), 0.02);
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.CycleStart"), IsEmpty());
}

TEST_F(MeasureFollowingCommand, TakesACircleThatAMachineMayGo) {
  EXPECT_EQ(follow({"--radius", "0.05"}).exit_code, 2);
  EXPECT_EQ(follow({"--radius", "10001"}).exit_code, 2);
  EXPECT_EQ(follow({"--feed", "0"}).exit_code, 2);
}

}  // namespace
}  // namespace rmac::cli
