// What a program does between its moves, on the wire.
#include <gtest/gtest.h>

#include "session.hpp"

namespace rmac::gateway {
namespace {

using fakes::Api;
using testing::_;
using testing::HasSubstr;
using testing::Return;

TEST(ProgramFlow, ReachesTheMachineAsItWasSent) {
  Api api;
  fakes::MockFlow& flow = api.machine.cam_mock.flow_mock;
  EXPECT_CALL(flow, dwell(7, 1.5)).WillOnce(Return(Expected<>{}));
  EXPECT_EQ(api.result("RMAC_CAM.Dwell", R"({"MoveID":7,"Time":1.5})"), true);
  EXPECT_CALL(flow, stop(8, false, "")).WillOnce(Return(Expected<>{}));
  EXPECT_EQ(api.result("RMAC_CAM.ProgramStop", R"({"MoveID":8})"), true);
  EXPECT_CALL(flow, stop(9, true, "look at it")).WillOnce(Return(Expected<>{}));
  EXPECT_EQ(api.result("RMAC_CAM.ProgramStop", R"([9, true, "look at it"])"), true);
  EXPECT_CALL(flow, await_input(10, "Clamped", false, 2)).WillOnce(Return(Expected<>{}));
  EXPECT_EQ(api.result("RMAC_CAM.AwaitInput", R"({"MoveID":10,"Name":"Clamped","On":false,"TimeOut":2})"), true);
}

TEST(ProgramFlow, RefusesWhatIsNoTimeBeforeTheMachineHearsOfIt) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.flow_mock, dwell(_, _)).Times(0);
  for (const char* time : {"-1", "3600.5", "1e300", "\"2\"", "null", "[2]"}) {
    const std::string refused =
        api.refusal("RMAC_CAM.Dwell", std::string(R"({"MoveID":1,"Time":)") + time + "}", rpc_code::kInvalidParams);
    EXPECT_THAT(refused, HasSubstr("\"Time\"")) << time;
  }
  EXPECT_THAT(api.refusal("RMAC_CAM.Dwell", R"({"Time":1})", rpc_code::kInvalidParams), HasSubstr("MoveID"));
  EXPECT_THAT(api.refusal("RMAC_CAM.Dwell", R"({"MoveID":1,"Seconds":1})", rpc_code::kInvalidParams),
              HasSubstr("Seconds"));
}

/// What reached the machine of one `InTurn`.
std::vector<sdk::CallInTurn> called(const std::string& calls) {
  Api api;
  std::vector<sdk::CallInTurn> found;
  EXPECT_CALL(api.machine.cam_mock.flow_mock, in_turn(5, _))
      .WillOnce(testing::DoAll(testing::SaveArg<1>(&found), Return(Expected<>{})));
  EXPECT_EQ(api.result("RMAC_CAM.InTurn", R"({"MoveID":5,"Calls":)" + calls + "}"), true);
  return found;
}

TEST(ProgramFlow, ReadsCallsAsTheyWouldBeSent) {
  const auto calls = called(R"([{"method":"RMAC_CAM.SetSpindleRPM","params":{"SpindleNumber":1,"RPM":-800}},
    {"method":"RMAC_CAM.TurnCoolantOn"},
    {"method":"RMAC_CAM.TurnCoolantOff","params":{}},
    {"method":"RMAC_CAM.SetOutput","params":["Laser",true]}])");
  ASSERT_EQ(calls.size(), 4U);
  EXPECT_EQ(std::get<sdk::SpindleCall>(calls[0]).spindle, 1);
  EXPECT_EQ(std::get<sdk::SpindleCall>(calls[0]).rpm, -800);
  EXPECT_EQ(std::get<sdk::OutputCall>(calls[1]).name, "Coolant");
  EXPECT_TRUE(std::get<sdk::OutputCall>(calls[1]).on);
  EXPECT_FALSE(std::get<sdk::OutputCall>(calls[2]).on);
  EXPECT_EQ(std::get<sdk::OutputCall>(calls[3]).name, "Laser");
  EXPECT_TRUE(std::get<sdk::OutputCall>(calls[3]).on);
}

TEST(ProgramFlow, RefusesCallsThatAreNoneByNameAndPlace) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.flow_mock, in_turn(_, _)).Times(0);
  const auto refused = [&](const std::string& calls) {
    return api.refusal("RMAC_CAM.InTurn", R"({"MoveID":5,"Calls":)" + calls + "}", rpc_code::kInvalidParams);
  };
  constexpr const char* kGood = R"({"method":"RMAC_CAM.TurnCoolantOn"})";
  for (const char* other : {"RMAC_CAM.CycleStart", "RMAC_CAM.MoveAlongLine", "RMAC_CAM.InTurn", "SetSpindleRPM", "",
                            "RMAC_CAM.StopNow", "Device.Unload"}) {
    EXPECT_THAT(refused(std::string("[") + kGood + R"(,{"method":")" + other + R"("}])"),
                testing::AllOf(HasSubstr("Calls[1]: " + std::string(other) + " is not called in turn"),
                               HasSubstr("RMAC_CAM.SetSpindleRPM, TurnCoolantOn")))
        << other;
  }
  EXPECT_THAT(refused("[]"), HasSubstr("0 Calls; there must be 1 to 64"));
  std::string many = "[";
  for (int i = 0; i < 65; ++i) many += std::string(i == 0 ? "" : ",") + kGood;
  EXPECT_THAT(refused(many + "]"), HasSubstr("65 Calls"));
  EXPECT_THAT(refused("7"), HasSubstr("\"Calls\""));
  EXPECT_THAT(refused("[7]"), HasSubstr("Calls[0]: 7 is no object"));
  EXPECT_THAT(refused("[{}]"), HasSubstr("Calls[0]: \"method\" is missing"));
  EXPECT_THAT(refused(R"([{"method":7}])"), HasSubstr("Calls[0]: \"method\" is missing, or no text"));
  EXPECT_THAT(refused(R"([{"method":"RMAC_CAM.TurnCoolantOn","id":3}])"), HasSubstr("no member \"id\""));
  EXPECT_THAT(refused(R"([{"method":"RMAC_CAM.TurnCoolantOn","params":{"x":1}}])"), HasSubstr("\"x\""));
  EXPECT_THAT(refused(R"([{"method":"RMAC_CAM.SetOutput","params":{"Name":"A"}}])"), HasSubstr("\"On\" is missing"));
  EXPECT_THAT(refused(R"([{"method":"RMAC_CAM.SetOutput","params":["A",1]}])"), HasSubstr("\"On\""));
  EXPECT_THAT(refused(R"([{"method":"RMAC_CAM.SetSpindleRPM","params":[4,100]}])"), HasSubstr("\"SpindleNumber\""));
  EXPECT_THAT(refused(R"([{"method":"RMAC_CAM.SetSpindleRPM","params":[0,1e300]}])"), HasSubstr("\"RPM\""));
}

TEST(ProgramFlow, TellsTheMachinesRefusalAsItsLastError) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.flow_mock, in_turn(5, _))
      .WillOnce(Return(failure(MinorCode::SpeedLimit, "InTurn: too fast")));
  const auto call = api.call("RMAC_CAM.InTurn", R"({"MoveID":5,"Calls":[{"method":"RMAC_CAM.TurnCoolantOn"}]})");
  EXPECT_EQ(call["error"]["message"], "InTurn: too fast");
  EXPECT_EQ(api.dispatcher.status().minor, static_cast<std::int64_t>(MinorCode::SpeedLimit));
}

TEST(ProgramFlow, SwitchesAnOutputByName) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.spindles_mock, set_output("Laser", true)).WillOnce(Return(Expected<>{}));
  EXPECT_EQ(api.result("RMAC_CAM.SetOutput", R"({"Name":"Laser","On":true})"), true);
  (void)api.refusal("RMAC_CAM.SetOutput", R"({"Name":3,"On":true})", rpc_code::kInvalidParams);
  (void)api.refusal("RMAC_CAM.SetOutput", R"({"Name":"Laser","On":"yes"})", rpc_code::kInvalidParams);
}

TEST(ProgramFlow, TellsAPersonOneShortLineAndNoMore) {
  Api api;
  fakes::MockFlow& flow = api.machine.cam_mock.flow_mock;
  EXPECT_CALL(flow, stop(1, false, "a?b")).WillOnce(Return(Expected<>{}));
  EXPECT_EQ(api.result("RMAC_CAM.ProgramStop", R"({"MoveID":1,"Message":"a\nb"})"), true)
      << "nothing of it reaches a terminal as a command";
  const auto call = api.call("RMAC_CAM.ProgramStop", R"({"MoveID":1,"Message":")" + std::string(201, 'x') + R"("})");
  EXPECT_THAT(call.dump(), HasSubstr("has 201 bytes; a person is told at most 200"));
}

TEST(ProgramFlow, HasItsSwitchForOptionalStopsAtTheOperatorsHandToo) {
  Api api;
  fakes::MockFlow& flow = api.machine.cam_mock.flow_mock;
  EXPECT_CALL(flow, set_optional_stops(true));
  (void)api.result("RMAC_CAM.SetOptionalStop", R"({"On":true})");
  EXPECT_CALL(flow, optional_stops()).WillOnce(Return(true));
  EXPECT_EQ(api.result("RMAC_CAM.GetOptionalStop"), true);
  api.session.authority = false;
  EXPECT_CALL(flow, set_optional_stops(false)).Times(0);
  (void)api.refusal("RMAC_CAM.SetOptionalStop", R"({"On":false})", rpc_code::kAuthorityRequired);
  testing::Mock::VerifyAndClearExpectations(&flow);
  (void)api.session.acquire_operator();
  EXPECT_CALL(flow, set_optional_stops(false));
  (void)api.result("RMAC_CAM.SetOptionalStop", R"({"On":false})");
  EXPECT_THAT(api.session.told, testing::Contains("switches optional stops off"));
}

}  // namespace
}  // namespace rmac::gateway
