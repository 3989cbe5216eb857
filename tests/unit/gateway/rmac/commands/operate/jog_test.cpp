// Moving by hand: what goes over the wire, and which words are wrong.
#include <gmock/gmock.h>
#include <unistd.h>

#include <csignal>

#include "gateway/rmac/wire/authority.hpp"
#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using JogCommand = CommandBench;
using HomeCommand = CommandBench;

TEST_F(JogCommand, MovesAJointWithTheLeaseAndWaitsUntilItStands) {
  moves_once(appliance_);
  const auto jogged = run({"jog", "--joint", "2", "--distance", "-1.5"});
  EXPECT_EQ(jogged.exit_code, 0) << jogged.err;
  EXPECT_THAT(appliance_.methods(), ElementsAre(kAcquireAuthority, "subscribe", "RMAC_CAM.JogJoint",
                                                "RMAC_CAM.GetState", "RMAC_CAM.GetState", kReleaseAuthority));
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.JogJoint"), ElementsAre(json{{"JntNum", 2}, {"Distance", -1.5}}));
}

TEST_F(JogCommand, MovesTheToolInTheFrameThatIsAskedFor) {
  ASSERT_EQ(run({"jog", "--direction", "0", "0", "1", "--distance", "3"}).exit_code, 0);
  ASSERT_EQ(run({"jog", "--direction", "0", "1", "0", "--tool", "--distance", "4"}).exit_code, 0);
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.JogPath"),
              ElementsAre(json{{"Direction", {0, 0, 1}}, {"InToolFrame", false}, {"Distance", 3}},
                          json{{"Direction", {0, 1, 0}}, {"InToolFrame", true}, {"Distance", 4}}));
}

TEST_F(JogCommand, StopsTheMachineAtAFault) {
  appliance_.answers("RMAC_CAM.GetState", state({{"moving", true}}));
  appliance_.handles("RMAC_CAM.JogJoint", [&](const json&) {
    appliance_.push_event(gateway::Event::Kind::Fault, {{"message", "joint 0 hit its limit switch"}});
    return gateway::Answer(true);
  });
  const auto failed = run({"jog", "--joint", "0", "--distance", "9"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.err, "rmac: joint 0 hit its limit switch\n");
  EXPECT_THAT(appliance_.methods(), testing::IsSupersetOf({"RMAC_CAM.StopNow", kReleaseAuthority}));
}

TEST_F(JogCommand, EndsAtARefusalOfAJogAtAVelocity) {
  appliance_.refuses("RMAC_CAM.JogJoint", -32001, "drives are off");
  const auto failed = run({"jog", "--joint", "0", "--velocity", "2"});
  EXPECT_EQ(failed.err, "rmac: drives are off\n");
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.JogJoint"), ElementsAre(json{{"JntNum", 0}, {"Velocity", 2.0}}));
  EXPECT_EQ(appliance_.methods().back(), kReleaseAuthority);
}

TEST_F(JogCommand, AtAVelocityIsSentAgainUntilAPersonInterruptsIt) {
  appliance_.handles("RMAC_CAM.JogJoint", [&](const json&) {
    if (appliance_.params_of("RMAC_CAM.JogJoint").size() == 2) ::kill(::getpid(), SIGINT);
    return gateway::Answer(true);
  });
  const auto ended = run({"jog", "--joint", "0", "--velocity", "2"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  const auto sent = appliance_.params_of("RMAC_CAM.JogJoint");
  ASSERT_GE(sent.size(), 3U);
  EXPECT_EQ(sent.at(1), (json{{"JntNum", 0}, {"Velocity", 2.0}}));
  EXPECT_EQ(sent.back(), (json{{"JntNum", 0}, {"Velocity", 0}}));
}

TEST_F(JogCommand, AtAVelocityEndsInOrderWhereThePersonDoesNotWaitForAnAnswer) {
  appliance_.handles("RMAC_CAM.JogJoint", [&](const json& params) {
    if (params.at("Velocity") != 0) {
      appliance_.keep_silent();
      ::kill(::getpid(), SIGINT);
    }
    return gateway::Answer(true);
  });
  const auto ended = run({"jog", "--joint", "0", "--velocity", "2"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.JogJoint"),
              ElementsAre(json{{"JntNum", 0}, {"Velocity", 2.0}}, json{{"JntNum", 0}, {"Velocity", 0}}));
}

TEST_F(JogCommand, MovesNothingWithoutTheLease) {
  appliance_.refuses(kAcquireAuthority, -32041, "the panel has it");
  EXPECT_EQ(run({"jog", "--joint", "0", "--distance", "1"}).err, "rmac: the panel has it\n");
  EXPECT_THAT(appliance_.methods(), ElementsAre(kAcquireAuthority));
}

TEST_F(JogCommand, TakesOneOfEachAlternative) {
  const std::vector<std::vector<std::string>> wrong{
      {"jog", "--distance", "1"},
      {"jog", "--joint", "1"},
      {"jog", "--joint", "1", "--distance", "1", "--velocity", "1"},
      {"jog", "--joint", "1", "--direction", "1", "0", "0", "--distance", "1"},
      {"jog", "--joint", "1", "--tool", "--distance", "1"},
      {"jog", "--direction", "1", "0", "--distance", "1"}};
  for (const auto& words : wrong) EXPECT_EQ(run(words).exit_code, 2) << testing::PrintToString(words);
  EXPECT_THAT(appliance_.methods(), IsEmpty());
}

TEST_F(JogCommand, TakesJointsThatAMachineMayHave) {
  EXPECT_EQ(run({"jog", "--joint", "-1", "--distance", "1"}).exit_code, 2);
  EXPECT_EQ(run({"jog", "--joint", "32", "--distance", "1"}).exit_code, 2);
  EXPECT_EQ(run({"jog", "--joint", "31", "--distance", "1"}).exit_code, 0) << "the machine knows what it has";
}

TEST_F(HomeCommand, SaysThatTheMachineIsInAnOldFault) {
  appliance_.answers("RMAC_CAM.GetState", state({{"state", "Faulted"}}));
  const auto failed = run({"home"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("the machine is in a fault"));
  EXPECT_THAT(appliance_.methods(), testing::Contains("RMAC_CAM.Home"));
}

}  // namespace
}  // namespace rmac::cli
