// What takes long does not keep others from stopping the machine. Told by order, not by time: the slow request ends
// only after the stop was answered.
#include <gmock/gmock.h>

#include <atomic>

#include "bench.hpp"
#include "requests.hpp"

namespace rmac::gateway {
namespace {

using fakes::Client;
using fakes::FakeMachine;
using fakes::line_of;
using fakes::ServerBench;
using nlohmann::json;
using testing::_;
using testing::Return;

/// A NURBS of some megabytes.
std::string large_move(int id) {
  constexpr int kPoints = 60'000;
  std::string knots = "0,0";
  std::string points = "[0,0,0]";
  for (int i = 1; i < kPoints; ++i) {
    knots += "," + std::to_string(std::min(i, kPoints - 1));
    points += "," + std::string("[") + std::to_string(i) + ".125,0.5,0.25]";
  }
  knots += "," + std::to_string(kPoints - 1);
  return line_of(id, "RMAC_CAM.MoveAlongNurbs",
                 R"({"MoveID":1,"Nurbs":{"degree":1,"knots":[)" + knots + R"(],"points":[)" + points + "]}}");
}

/// Something that lasts until the test lets it end.
struct Slow {
  std::promise<void> begun, end;
  void run() {
    begun.set_value();
    end.get_future().wait();
  }
};

TEST(SlowRequest, KeepsNobodyWaitingWhileItSearches) {
  Slow slow;
  ServerBench bench;
  bench.on_gateway([&](Server&, FakeMachine& machine) { machine.during_search = [&] { slow.run(); }; });
  Client searcher(bench.port());
  Client operator_(bench.port());
  searcher.send(line_of(1, "DeviceDriverManager.SearchDatabaseRecordSet", R"(["SELECT 1"])"));
  slow.begun.get_future().wait();
  EXPECT_TRUE(operator_.call("RMAC_CAM.GetState").contains("result"));
  EXPECT_TRUE(operator_.call("authority.acquire").contains("result"));
  EXPECT_EQ(operator_.call("Device.Load", R"(["Fake"])")["result"], true) << "slow requests of others, too";
  slow.end.set_value();
  EXPECT_EQ(searcher.json_line()["id"], 1);
}

TEST(SlowRequest, KeepsNobodyWaitingWhileModulesAreVerified) {
  for (const bool loads : {false, true}) {
    SCOPED_TRACE(loads ? "before they are loaded" : "alone");
    Slow slow;
    ServerBench bench;
    bench.on_gateway([&](Server&, FakeMachine& machine) {
      (loads ? machine.device_fake.during_preparation : machine.device_fake.during_verification) = [&] { slow.run(); };
    });
    Client holder(bench.port());
    Client panel(bench.port());
    EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
    holder.send(line_of(1, loads ? "Device.Load" : "Device.Verify", R"(["Fake"])"));
    slow.begun.get_future().wait();
    EXPECT_TRUE(panel.call("RMAC_CAM.GetState").contains("result"));
    EXPECT_EQ(panel.call("DeviceDriverManager.SearchDatabaseRecordSet", R"(["SELECT 1"])")["result"], 1);
    slow.end.set_value();
    EXPECT_TRUE(holder.answer(1).contains("result"));
  }
}

TEST(SlowRequest, LetsAnotherClientStopDuringASearch) {
  Slow slow;
  ServerBench bench;
  bench.on_gateway([&](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).WillOnce(Return(Expected<>{}));
    machine.during_search = [&] { slow.run(); };
  });
  Client searcher(bench.port());
  Client panel(bench.port());
  searcher.send(line_of(1, "DeviceDriverManager.SearchDatabaseRecordSet", R"(["SELECT 1"])") +
                line_of(2, "RMAC_CAM.Ok"));
  slow.begun.get_future().wait();
  EXPECT_EQ(panel.call("RMAC_CAM.StopNow")["result"], true);
  slow.end.set_value();
  EXPECT_EQ(searcher.json_line()["id"], 1) << "answers keep their order";
  EXPECT_EQ(searcher.json_line()["id"], 2);
}

TEST(SlowRequest, LetsAnotherClientStopWhileTheMechanismChanges) {
  Slow slow;
  ServerBench bench;
  bench.on_gateway([&](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).WillRepeatedly(Return(Expected<>{}));
    machine.device_fake.during_load = [&] { slow.run(); };
  });
  Client holder(bench.port());
  Client panel(bench.port());
  EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
  holder.send(line_of(10, "Device.Load", R"(["Fake"])"));
  slow.begun.get_future().wait();
  EXPECT_EQ(panel.call("RMAC_CAM.StopNow")["result"], true);
  EXPECT_TRUE(bench.on_gateway([](Server& server, FakeMachine&) { return server.mechanism_changes(); }));
  panel.send(line_of(20, "RMAC_CAM.GetState"));
  slow.end.set_value();
  EXPECT_EQ(holder.answer(10)["result"], true);
  EXPECT_EQ(panel.answer(20)["result"]["mechanism"], "Fake") << "what reads the mechanism waits for it";
  EXPECT_FALSE(bench.on_gateway([](Server& server, FakeMachine&) { return server.mechanism_changes(); }));
}

TEST(SlowRequest, IsRefusedWhenAStopCameWhileItWasPrepared) {
  Slow slow;
  ServerBench bench;
  bool loaded = false;
  bench.on_gateway([&](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).WillRepeatedly(Return(Expected<>{}));
    machine.device_fake.during_preparation = [&] { slow.run(); };
    machine.device_fake.during_load = [&] { loaded = true; };
  });
  Client holder(bench.port());
  Client panel(bench.port());
  EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
  holder.send(line_of(10, "Device.Load", R"(["Fake"])"));
  slow.begun.get_future().wait();
  EXPECT_FALSE(bench.on_gateway([](Server& server, FakeMachine&) { return server.mechanism_changes(); }))
      << "samples go on while modules are verified";
  EXPECT_EQ(panel.call("RMAC_CAM.StopNow")["result"], true);
  slow.end.set_value();
  EXPECT_THAT(holder.answer(10)["error"]["message"].get<std::string>(), testing::HasSubstr("overtaken by a stop"));
  EXPECT_FALSE(loaded);
}

TEST(SlowRequest, EndsWhereItsPreparationFails) {
  ServerBench bench;
  bool loaded = false;
  bench.on_gateway([&](Server&, FakeMachine& machine) {
    machine.device_fake.verification_refusal = "its module crashes";
    machine.device_fake.during_load = [&] { loaded = true; };
  });
  Client holder(bench.port());
  EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
  EXPECT_EQ(holder.call("Device.Load", R"(["Fake"])")["error"]["message"], "its module crashes");
  EXPECT_FALSE(loaded);
  bench.on_gateway([&](Server&, FakeMachine& machine) { machine.device_fake.verification_refusal.clear(); });
  EXPECT_EQ(holder.call("Device.Load", R"(["Fake"])")["result"], true);
}

TEST(SlowRequest, LetsOthersInBeforeTheSameClientsNext) {
  // The first client (both orders) sends many; what another one sent meanwhile comes before its second.
  for (const bool first_connected : {true, false}) {
    SCOPED_TRACE(first_connected ? "the busy client connected first" : "the busy client connected last");
    constexpr int kLoads = 5;
    Slow slow;
    std::atomic<int> loads = 0;
    std::atomic<int> before_the_other = 0;
    ServerBench bench;
    bench.on_gateway([&](Server&, FakeMachine& machine) {
      machine.device_fake.during_load = [&] {
        if (loads++ == 0) slow.run();
      };
      EXPECT_CALL(machine.cam_mock.cycle_mock, started()).WillRepeatedly([&] {
        before_the_other = loads.load();
        return false;
      });
    });
    Client one(bench.port());
    EXPECT_TRUE(one.call("hello", R"({"client":"one"})").contains("result"));
    Client two(bench.port());
    EXPECT_TRUE(two.call("hello", R"({"client":"two"})").contains("result"));
    Client& busy = first_connected ? one : two;
    Client& other = first_connected ? two : one;
    EXPECT_TRUE(busy.call("authority.acquire").contains("result"));
    std::string lines;
    for (int i = 1; i <= kLoads; ++i) {
      lines += line_of(i, "Device.Load", R"(["Fake"])");
    }
    busy.send(lines);
    slow.begun.get_future().wait();
    other.send(line_of(30, "RMAC_CAM.GetCycleStartStatus"));
    // A stop's answer tells that what was sent before it on its connection has been read.
    other.send(line_of(31, "RMAC_CAM.CycleStop", "[1]"));
    EXPECT_TRUE(other.answer(31).contains("result"));
    slow.end.set_value();
    EXPECT_EQ(other.answer(30)["result"], false);
    for (int i = 1; i <= kLoads; ++i) EXPECT_EQ(busy.json_line()["id"], i);
    EXPECT_EQ(before_the_other, 1);
  }
}

TEST(SlowRequest, LetsAnyoneStopWhileALargeMoveIsBuilt) {
  for (const bool own : {false, true}) {
    SCOPED_TRACE(own ? "the same client" : "another client");
    Slow slow;
    ServerBench bench;
    bench.on_gateway([&](Server&, FakeMachine& machine) {
      EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now())
          .Times(testing::AtLeast(1))
          .WillRepeatedly(Return(Expected<>{}));
      EXPECT_CALL(machine.cam_mock.queue_mock, add(1, _)).WillOnce([&](std::int64_t, const Geometry&) -> Expected<> {
        slow.run();
        return failure(MinorCode::Other, "its queue is gone");
      });
    });
    Client holder(bench.port());
    Client panel(bench.port());
    EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
    holder.send(large_move(10) + line_of(11, "RMAC_CAM.Ok"));
    slow.begun.get_future().wait();
    if (own) holder.send(line_of(12, "RMAC_CAM.StopNow"));
    EXPECT_EQ(own ? holder.answer(12)["result"] : panel.call("RMAC_CAM.StopNow")["result"], true);
    slow.end.set_value();
    EXPECT_EQ(holder.json_line()["id"], 10);
    EXPECT_EQ(holder.json_line()["id"], 11);
    EXPECT_EQ(holder.call("RMAC_CAM.StatusMinorCode")["result"], static_cast<int>(MinorCode::Other));
  }
}

TEST(SlowRequest, OfAClientThatLeavesIsFollowedByAStopThatDropsIt) {
  Slow slow;
  std::promise<void> stopped;
  ServerBench bench;
  bench.on_gateway([&](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.queue_mock, add(1, _)).WillOnce([&](std::int64_t, const Geometry&) -> Expected<> {
      slow.run();
      return {};
    });
    ON_CALL(machine.cam_mock.queue_mock, moves_left()).WillByDefault(Return(1));
    // The watcher's own lease, taken at the end, is lost with the bench.
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now())
        .WillOnce([&]() -> Expected<> {
          stopped.set_value();
          return {};
        })
        .WillRepeatedly(Return(Expected<>{}));
  });
  Client watcher(bench.port());
  {
    Client holder(bench.port());
    EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
    EXPECT_TRUE(holder.call("subscribe", R"({"topics":["events"]})").contains("result"));
    holder.send(large_move(10));
    slow.begun.get_future().wait();
  }
  // Closed with nothing unread, so the server sees an end of input and answers first; it loses the lease then.
  slow.end.set_value();
  stopped.get_future().wait();
  EXPECT_TRUE(watcher.call("authority.acquire").contains("result"));
}

TEST(SlowRequest, ALongLineKeepsItsPlaceAmongShortOnes) {
  ServerBench bench;
  Client client(bench.port());
  const std::string name(1 << 20, 'n');
  client.send(line_of(1, "RMAC_CAM.Ok") + line_of(2, "hello", R"({"client":")" + name + R"("})") +
              line_of(3, "RMAC_CAM.Ok") + "{\"jsonrpc\"" + std::string(1 << 17, ' ') + "\n" +
              line_of(5, "RMAC_CAM.Ok"));
  EXPECT_EQ(client.json_line()["id"], 1);
  EXPECT_EQ(client.json_line()["id"], 2);
  EXPECT_EQ(client.json_line()["id"], 3);
  EXPECT_EQ(client.json_line()["error"]["code"], rpc_code::kParseError);
  EXPECT_EQ(client.json_line()["id"], 5);
}

}  // namespace
}  // namespace rmac::gateway
