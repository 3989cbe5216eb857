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
