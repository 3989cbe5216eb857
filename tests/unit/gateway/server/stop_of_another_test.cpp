// A stop of one client, and what another had sent before it.
#include <gtest/gtest.h>

#include "bench.hpp"
#include "requests.hpp"

namespace rmac::gateway {
namespace {

using fakes::Client;
using fakes::FakeMachine;
using fakes::line_of;
using fakes::move_line;
using fakes::ServerBench;
using fakes::set_running;
using nlohmann::json;
using testing::_;
using testing::HasSubstr;
using testing::Return;

/// A holder whose move waits for room while the machine runs, with other requests behind it; and someone at a panel.
class StopOfAnother : public testing::Test {
 protected:
  static ServerOptions patient() {
    ServerOptions options;
    options.queue_wait = std::chrono::hours(1);
    return options;
  }
  void SetUp() override {
    bench_.on_gateway([this](Server&, FakeMachine& machine) {
      ON_CALL(machine.cam_mock.queue_mock, add(_, _))
          .WillByDefault([this](std::int64_t, const Geometry&) -> Expected<> {
            if (room_) return {};
            if (!std::exchange(tried_once_, true)) tried_.set_value();
            return failure(MinorCode::CommandQueueFull, "full");
          });
      EXPECT_CALL(machine.cam_mock.cycle_mock, start(_)).Times(starts_);
      EXPECT_CALL(machine.cam_mock.positioning_mock, home()).Times(starts_);
      EXPECT_CALL(machine.cam_mock.positioning_mock, jog_joint(_, _)).Times(starts_);
      EXPECT_CALL(machine.cam_mock.path_mock, set_feedrate(_)).Times(1);
      // The spindle may be switched off, not on.
      EXPECT_CALL(machine.cam_mock.spindles_mock, set_rpm(0, 0)).Times(1);
      EXPECT_CALL(machine.cam_mock.spindles_mock, set_rpm(0, 500)).Times(starts_);
    });
    set_running(bench_);
    panel_.call("hello", R"({"client":"panel"})");
    EXPECT_TRUE(holder_.call("authority.acquire").contains("result"));
    const auto bare = [](std::string line) { return line.substr(0, line.size() - 1); };
    holder_.send(move_line(10) + "[" + bare(line_of(11, "RMAC_CAM.CycleStart", "[1]")) + "," +
                 bare(line_of(12, "RMAC_CAM.JogJoint", "[0,1]")) + "]\n" + line_of(13, "RMAC_CAM.Home") +
                 line_of(14, "RMAC_CAM.SetSpindleRPM", "[0,500]") + line_of(15, "RMAC_CAM.SetSpindleRPM", "[0,0]") +
                 line_of(16, "RMAC_CAM.SetFeedrate", "[100]") + move_line(17));
    tried_.get_future().wait();
  }
  void make_room() {
    bench_.on_gateway([this](Server&, FakeMachine&) { room_ = true; });
  }
  static void expect_overtaken(const json& answer) {
    EXPECT_THAT(answer["error"]["message"].get<std::string>(),
                testing::AllOf(HasSubstr("overtaken by a stop"), HasSubstr("panel")));
  }
  void expect_starts_refused() {
    const json batch = holder_.json_line();
    expect_overtaken(batch[0]);
    expect_overtaken(batch[1]);
    expect_overtaken(holder_.answer(13));
    expect_overtaken(holder_.answer(14));
    EXPECT_TRUE(holder_.answer(15).contains("result"));
    EXPECT_TRUE(holder_.answer(16).contains("result"));
  }

  int starts_ = 0;  ///< how often what starts something may be called
  bool room_ = false;
  bool tried_once_ = false;
  std::promise<void> tried_;
  ServerBench bench_{patient()};
  Client holder_{bench_.port()};
  Client panel_{bench_.port()};
};

TEST_F(StopOfAnother, RefusesMovesAndStartsThatWait) {
  EXPECT_EQ(panel_.call("RMAC_CAM.StopNow")["result"], true);
  expect_overtaken(holder_.answer(10));
  expect_starts_refused();
  expect_overtaken(holder_.answer(17));
}

TEST_F(StopOfAnother, ThatHoldsRefusesStartsAndLeavesMovesWaiting) {
  EXPECT_EQ(panel_.call("RMAC_CAM.FeedHold")["result"], true);
  make_room();
  EXPECT_EQ(holder_.answer(10)["result"], true);
  expect_starts_refused();
  EXPECT_EQ(holder_.answer(17)["result"], true);
}

class NoStopOfAnother : public StopOfAnother {
 protected:
  NoStopOfAnother() { starts_ = 1; }
};

TEST_F(NoStopOfAnother, IsWhatHasWrongParametersOrLetsAButtonGoOrReleasesNothing) {
  EXPECT_TRUE(panel_.call("RMAC_CAM.StopNow", R"({"now":1})").contains("error"));
  EXPECT_TRUE(panel_.call("RMAC_CAM.SetCycleStopStatus", "[false]").contains("result"));
  EXPECT_TRUE(panel_.call("authority.release").contains("error"));
  make_room();
  EXPECT_EQ(holder_.answer(10)["result"], true);
  EXPECT_EQ(holder_.json_line()[0]["result"], true);
  EXPECT_EQ(holder_.answer(17)["result"], true);
}

TEST(StopOfAnotherInTime, RefusesWhatHadArrivedAndWasNotReadYet) {
  ServerBench bench;
  Client holder(bench.port());
  Client panel(bench.port());
  EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
  EXPECT_EQ(panel.call("RMAC_CAM.Ok")["result"], true);
  bench.on_gateway([&](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).WillOnce([&]() -> Expected<> {
      holder.send(line_of(20, "RMAC_CAM.CycleStart", "[1]"));  // arrives before the stop is through
      return {};
    });
    EXPECT_CALL(machine.cam_mock.cycle_mock, start(sdk::CycleMode::Automatic)).Times(0);
    EXPECT_CALL(machine.cam_mock.cycle_mock, start(sdk::CycleMode::Manual)).WillOnce(Return(Expected<>{}));
  });
  EXPECT_EQ(panel.call("RMAC_CAM.StopNow")["result"], true);
  EXPECT_THAT(holder.answer(20)["error"]["message"].get<std::string>(), HasSubstr("overtaken by a stop"));
  EXPECT_EQ(holder.call("RMAC_CAM.CycleStart", "[0]")["result"], true) << "what is sent after the stop counts";
}

}  // namespace
}  // namespace rmac::gateway
