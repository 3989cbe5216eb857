// Who stands at the machine, beside who feeds its queue.
#include <gtest/gtest.h>

#include "bench.hpp"
#include "requests.hpp"

namespace rmac::gateway {
namespace {

using fakes::Client;
using fakes::FakeMachine;
using fakes::ServerBench;
using nlohmann::json;
using testing::_;
using testing::AllOf;
using testing::HasSubstr;
using testing::Return;

struct ProgramAndPanel {
  ProgramAndPanel() : program(bench.port()), panel(bench.port()) {
    program.call("hello", R"({"client":"cam-tool"})");
    panel.call("hello", R"({"client":"panel"})");
    EXPECT_TRUE(program.call("authority.acquire").contains("result"));
    EXPECT_EQ(program.call("subscribe", R"({"topics":["events"]})")["result"], true);
  }
  ServerBench bench;
  Client program, panel;
};

TEST(OperatorPost, IsOneClientsAtATimeAndNamesItToTheSecond) {
  ProgramAndPanel both;
  EXPECT_TRUE(both.panel.call("operator.acquire").contains("result"));
  EXPECT_TRUE(both.panel.call("operator.acquire").contains("result")) << "again is no error";
  const json refused = both.program.call("operator.acquire")["error"];
  EXPECT_EQ(refused["code"], rpc_code::kOperatorThere);
  EXPECT_THAT(refused["message"].get<std::string>(), AllOf(HasSubstr("panel"), HasSubstr("operator.release")));
  EXPECT_EQ(both.program.call("operator.release")["error"]["code"], rpc_code::kAuthorityRequired);
  EXPECT_EQ(both.panel.call("operator.release")["result"], true);
  EXPECT_TRUE(both.program.call("operator.acquire").contains("result"));
}

TEST(OperatorPost, GoesToTheNextWhenItsConnectionEnds) {
  ProgramAndPanel both;
  EXPECT_TRUE(both.panel.call("operator.acquire").contains("result"));
  EXPECT_THAT(both.program.pushed("events")["message"].get<std::string>(), HasSubstr("is the operator"));
  both.panel.close();
  EXPECT_THAT(both.program.pushed("events")["message"].get<std::string>(),
              HasSubstr("disconnected with the operator's place; what it held stays held"));
  EXPECT_TRUE(both.program.call("operator.acquire").contains("result"));
}

TEST(OperatorPost, TellsTheProgramsClientWhoChangedWhat) {
  ProgramAndPanel both;
  both.bench.on_gateway([](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.operating_mock, set_feed_override(30, _)).WillOnce(Return(Expected<>{}));
    EXPECT_CALL(machine.operating_mock, resume(_)).WillOnce(Return(failure(MinorCode::Other, "nothing is held")));
  });
  EXPECT_TRUE(both.panel.call("operator.acquire").contains("result"));
  EXPECT_EQ(both.program.pushed("events")["kind"], "Authority");
  EXPECT_TRUE(both.panel.call("RMAC_CAM.FeedResume").contains("error")) << "nobody is told of it";
  EXPECT_TRUE(both.panel.call("RMAC_CAM.SetFeedOverride", "[30]").contains("result"));
  const json event = both.program.pushed("events");
  EXPECT_EQ(event["kind"], "Operator");
  EXPECT_THAT(event["message"].get<std::string>(),
              AllOf(testing::StartsWith("panel ("), HasSubstr("sets the feed override to 30 %")));
}

// Red when what an operator does beside the program disturbs its lease.
TEST(OperatorPost, LeavesTheLeaseAndTheQueueAlone) {
  ProgramAndPanel both;
  both.bench.on_gateway([](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).Times(0);
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop()).Times(0);
  });
  EXPECT_TRUE(both.panel.call("operator.acquire").contains("result"));
  EXPECT_EQ(both.panel.call("operator.release")["result"], true);
  both.panel.end_writing();
  EXPECT_EQ(both.panel.line(), "");
  EXPECT_EQ(both.program.call("authority.renew")["result"], true);
  both.bench.on_gateway(
      [](Server&, FakeMachine& machine) { testing::Mock::VerifyAndClearExpectations(&machine.cam_mock.cycle_mock); });
}

TEST(OperatorPost, IsOvertakenByAStopLikeAnybody) {
  ProgramAndPanel both;
  both.bench.on_gateway([](Server&, FakeMachine& machine) { EXPECT_CALL(machine.operating_mock, resume(_)).Times(0); });
  EXPECT_TRUE(both.panel.call("operator.acquire").contains("result"));
  both.panel.send("[" +
                  fakes::line_of(10, "RMAC_CAM.FeedResume", "[]")
                      .substr(0, fakes::line_of(10, "RMAC_CAM.FeedResume", "[]").size() - 1) +
                  R"(,{"jsonrpc":"2.0","id":11,"method":"RMAC_CAM.StopNow"}])" + "\n");
  EXPECT_THAT(both.panel.json_line()[0]["error"]["message"].get<std::string>(), HasSubstr("overtaken by a stop"));
}

}  // namespace
}  // namespace rmac::gateway
