// Who may move the machine, who may stop it, and what happens when a client is gone.
#include <gtest/gtest.h>

#include <utility>

#include "bench.hpp"
#include "requests.hpp"

namespace rmac::gateway {
namespace {

using fakes::Client;
using fakes::FakeMachine;
using fakes::keep_queue_full;
using fakes::line_of;
using fakes::move_line;
using fakes::ServerBench;
using fakes::set_running;
using nlohmann::json;
using testing::_;
using testing::AtLeast;
using testing::HasSubstr;
using testing::Return;

TEST(Authority, IsHeldByOneClientAndNamesItToTheSecond) {
  ServerBench bench;
  Client first(bench.port());
  first.call("hello", R"({"client":"cam-tool"})");
  EXPECT_TRUE(first.call("authority.acquire").contains("result"));
  EXPECT_TRUE(first.call("authority.acquire").contains("result")) << "again is no error";
  Client second(bench.port());
  const json refused = second.call("authority.acquire")["error"];
  EXPECT_EQ(refused["code"], rpc_code::kAuthorityHeld);
  EXPECT_THAT(refused["message"].get<std::string>(), HasSubstr("cam-tool"));
  EXPECT_EQ(second.call("authority.renew")["error"]["code"], rpc_code::kAuthorityRequired);
  EXPECT_EQ(first.call("authority.release")["result"], true);
  EXPECT_TRUE(second.call("authority.acquire").contains("result"));
}

TEST(Authority, SecondClientMayNotJogButMayStop) {
  ServerBench bench;
  bench.on_gateway([](Server&, FakeMachine& machine) {
    // Authority that is lost with the bench may stop the machine once more.
    EXPECT_CALL(machine.cam_mock.positioning_mock, jog_joint(_, _)).Times(0);
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).Times(AtLeast(1)).WillRepeatedly(Return(Expected<>{}));
    EXPECT_CALL(machine.cam_mock.cycle_mock, hold()).Times(AtLeast(1)).WillRepeatedly(Return(Expected<>{}));
  });
  Client first(bench.port());
  EXPECT_TRUE(first.call("authority.acquire").contains("result"));
  Client second(bench.port());
  EXPECT_EQ(second.call("RMAC_CAM.JogJoint", R"({"JntNum":0,"Distance":1})")["error"]["code"],
            rpc_code::kAuthorityRequired);
  EXPECT_EQ(second.call("RMAC_CAM.StopNow")["result"], true);
  EXPECT_EQ(second.call("RMAC_CAM.FeedHold")["result"], true);
}

TEST(Authority, LossInMidCutStopsTheMachineDropsItsQueueAndTellsThat) {
  ServerBench bench;
  std::promise<void> stopped;
  bench.on_gateway([&](Server&, FakeMachine& machine) {
    ON_CALL(machine.cam_mock.queue_mock, moves_left()).WillByDefault(Return(3));
    // The watcher's own authority, taken at the end, is lost with the bench: that stop is of a machine at rest.
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now())
        .WillOnce([&]() -> Expected<> {
          machine.now.state = CycleState::Idle;
          machine.now.moving = false;
          stopped.set_value();
          return {};
        })
        .WillRepeatedly(Return(Expected<>{}));
  });
  Client watcher(bench.port());
  EXPECT_EQ(watcher.call("subscribe", R"({"topics":["events"]})")["result"], true);
  {
    Client holder(bench.port());
    holder.call("hello", R"({"client":"cam-tool"})");
    EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
    set_running(bench);
  }
  stopped.get_future().wait();
  EXPECT_THAT(watcher.pushed("events")["message"].get<std::string>(), HasSubstr("took motion authority"));
  const json event = watcher.pushed("events");
  EXPECT_EQ(event["kind"], "Authority");
  EXPECT_THAT(event["message"].get<std::string>(),
              testing::AllOf(HasSubstr("cam-tool"), HasSubstr("disconnected"), HasSubstr("stopped on its path"),
                             HasSubstr("3 queued moves are dropped")));
  EXPECT_EQ(watcher.call("authority.acquire")["result"]["dropped_moves"], 3);
  EXPECT_EQ(watcher.call("authority.acquire")["result"]["dropped_moves"], 0) << "told once";
}

TEST(Authority, LossStopsAMachineWhoseSampleDoesNotShowItsStartYet) {
  ServerBench bench;
  bench.on_gateway([](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.cycle_mock, start(_)).WillOnce([&]() -> Expected<> {
      ON_CALL(machine.cam_mock.cycle_mock, started()).WillByDefault(Return(true));
      return {};
    });
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).WillOnce(Return(Expected<>{}));
  });
  Client watcher(bench.port());
  EXPECT_EQ(watcher.call("subscribe", R"({"topics":["events"]})")["result"], true);
  {
    Client holder(bench.port());
    EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
    holder.send(line_of(2, "RMAC_CAM.CycleStart", "[1]"));
    holder.end_writing();
    EXPECT_EQ(holder.json_line()["result"], true);
    EXPECT_EQ(holder.line(), "");
  }
}

TEST(Authority, LossAtRestIsAnnounced) {
  ServerBench bench;
  Client watcher(bench.port());
  EXPECT_EQ(watcher.call("subscribe", R"({"topics":["events"]})")["result"], true);
  { EXPECT_TRUE(Client(bench.port()).call("authority.acquire").contains("result")); }
  watcher.pushed("events");
  EXPECT_THAT(watcher.pushed("events")["message"].get<std::string>(), HasSubstr("disconnected"));
}

TEST(Authority, LossPowersOffAtRestWhereConfiguredSo) {
  ServerOptions options;
  options.lease_lost = LeaseLostAction::StopAndPowerOff;
  ServerBench bench(options);
  bench.on_gateway([](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).WillOnce([&]() -> Expected<> {
      EXPECT_TRUE(machine.device_fake.device) << "power must stay on until the machine rests";
      machine.now.state = CycleState::Stopping;
      return {};
    });
  });
  Client holder(bench.port());
  EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
  set_running(bench);
  EXPECT_EQ(holder.call("authority.release")["result"], true);
  EXPECT_EQ(holder.call("Device.OpenDeviceDatabase")["result"], true);
  EXPECT_THAT(holder.call("authority.acquire")["error"]["message"].get<std::string>(),
              HasSubstr("switching the drives off"));
  bench.on_gateway([](Server& server, FakeMachine& machine) {
    machine.now.state = CycleState::Idle;
    machine.now.moving = false;
    server.tick();
  });
  EXPECT_TRUE(holder.call("Device.OpenDeviceDatabase").contains("error")) << "unloaded";
  EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
}

TEST(Overtaken, WhatStartsMotionDoesNotRunAfterAStopSentBehindIt) {
  for (const char* start : {"RMAC_CAM.CycleStart [1]", "RMAC_CAM.SetCycleStartStatus [true]", "RMAC_CAM.FeedResume []",
                            "RMAC_CAM.JogJoint [0,1]"}) {
    for (const char* stop : {"RMAC_CAM.StopNow []", "RMAC_CAM.CycleStop [1]", "RMAC_CAM.FeedHold []"}) {
      for (const bool batch : {false, true}) {
        SCOPED_TRACE(std::string(start) + ", " + stop + (batch ? " in a batch" : ""));
        ServerBench bench;
        bench.on_gateway([](Server&, FakeMachine& machine) {
          EXPECT_CALL(machine.cam_mock.cycle_mock, start(_)).Times(0);
          EXPECT_CALL(machine.cam_mock.cycle_mock, resume()).Times(0);
          EXPECT_CALL(machine.cam_mock.positioning_mock, jog_joint(_, _)).Times(0);
        });
        Client client(bench.port());
        EXPECT_TRUE(client.call("authority.acquire").contains("result"));
        const auto request = [](int id, const std::string& words) {
          const std::size_t space = words.find(' ');
          return line_of(id, words.substr(0, space), words.substr(space + 1));
        };
        const std::string first = request(10, start);
        const std::string second = request(11, stop);
        json refused;
        if (batch) {
          client.send("[" + first.substr(0, first.size() - 1) + "," + second.substr(0, second.size() - 1) + "]\n");
          refused = client.json_line()[0];
        } else {
          client.send(first + second);
          refused = client.answer(10);
        }
        EXPECT_THAT(refused["error"]["message"].get<std::string>(), HasSubstr("overtaken by a stop"));
      }
    }
  }
}

TEST(Overtaken, LettingAStopButtonGoOvertakesNothing) {
  ServerBench bench;
  bench.on_gateway([](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.cycle_mock, start(_)).WillOnce(Return(Expected<>{}));
  });
  Client client(bench.port());
  EXPECT_TRUE(client.call("authority.acquire").contains("result"));
  client.send(line_of(10, "RMAC_CAM.CycleStart", "[1]") + line_of(11, "RMAC_CAM.SetCycleStopStatus", "[false]"));
  EXPECT_EQ(client.answer(10)["result"], true);
}

TEST(Turn, AStopOfAnotherClientIsServedInsideALongBatch) {
  ServerBench bench;
  std::promise<void> sent;
  std::atomic<int> run = 0;
  std::atomic<int> run_at_stop = -1;
  bench.on_gateway([&](Server&, FakeMachine& machine) {
    ON_CALL(machine.cam_mock.path_mock, set_feedrate(_)).WillByDefault([&](double) -> Expected<> {
      if (run++ == 0) sent.get_future().wait();
      const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(6);  // longer than a turn
      while (std::chrono::steady_clock::now() < end) {
      }
      return {};
    });
    ON_CALL(machine.cam_mock.cycle_mock, stop_now()).WillByDefault([&]() -> Expected<> {
      run_at_stop = run.load();
      return {};
    });
  });
  Client client(bench.port());
  Client other(bench.port());
  EXPECT_TRUE(client.call("authority.acquire").contains("result"));
  EXPECT_EQ(other.call("RMAC_CAM.Ok")["result"], true);
  std::string batch = "[";
  for (int i = 0; i < 50; ++i) {
    const std::string line = line_of(100 + i, "RMAC_CAM.SetFeedrate", "[100]");
    batch += (i == 0 ? "" : ",") + line.substr(0, line.size() - 1);
  }
  client.send(batch + "]\n");
  other.send(line_of(7, "RMAC_CAM.StopNow"));
  sent.set_value();
  EXPECT_EQ(other.json_line()["result"], true);
  EXPECT_LT(run_at_stop, 50);
  EXPECT_EQ(client.json_line().size(), 50U) << "the batch goes on all the same";
}

TEST(QueueWait, StopOvertakesAMoveThatWaitsForRoom) {
  ServerOptions options;
  options.queue_wait = std::chrono::hours(1);
  ServerBench bench(options);
  bench.on_gateway([](Server&, FakeMachine& machine) {
    ON_CALL(machine.cam_mock.queue_mock, add(_, _)).WillByDefault(Return(failure(MinorCode::CommandQueueFull, "full")));
    ON_CALL(machine.cam_mock.cycle_mock, stop()).WillByDefault([&]() -> Expected<> {
      machine.now.state = CycleState::Stopping;
      return {};
    });
  });
  set_running(bench);
  Client client(bench.port());
  EXPECT_TRUE(client.call("authority.acquire").contains("result"));
  client.send(move_line(10) + move_line(11) + "{\"jsonrpc\":\"2.0\",\"id\":12,\"method\":\"RMAC_CAM.Ok\"}\n" +
              "{\"jsonrpc\":\"2.0\",\"id\":13,\"method\":\"RMAC_CAM.CycleStop\",\"params\":[1]}\n");
  EXPECT_EQ(client.json_line()["id"], 13) << "the stop is answered first";
  // Stopping makes no room, so the moves that waited are refused at once, in order.
  for (const int id : {10, 11}) {
    const json refused = client.json_line();
    EXPECT_EQ(refused["id"], id);
    EXPECT_EQ(refused["error"]["data"]["minorName"], "MACHINE_ERR_COMMAND_QUEUE_FULL");
  }
  EXPECT_EQ(client.json_line()["id"], 12);
}

TEST(QueueWait, StopInsideABatchOvertakesToo) {
  ServerOptions options;
  options.queue_wait = std::chrono::hours(1);
  ServerBench bench(options);
  std::promise<void> stopped;
  bench.on_gateway([&](Server&, FakeMachine& machine) {
    ON_CALL(machine.cam_mock.queue_mock, add(_, _)).WillByDefault(Return(failure(MinorCode::CommandQueueFull, "full")));
    // The lease that is lost with the client stops once more.
    ON_CALL(machine.cam_mock.cycle_mock, stop_now()).WillByDefault([&, told = false]() mutable -> Expected<> {
      machine.now.state = CycleState::Stopping;
      if (!std::exchange(told, true)) stopped.set_value();
      return {};
    });
  });
  set_running(bench);
  Client client(bench.port());
  EXPECT_TRUE(client.call("authority.acquire").contains("result"));
  std::string move = move_line(20);
  move.pop_back();
  client.send(move_line(19) + "[" + move + ",{\"jsonrpc\":\"2.0\",\"id\":21,\"method\":\"RMAC_CAM.StopNow\"}]\n");
  stopped.get_future().wait();
  EXPECT_EQ(client.json_line()["id"], 19);
  const json batch = client.json_line();
  EXPECT_TRUE(batch[0].contains("error"));
  EXPECT_EQ(batch[1]["result"], true);
}

TEST(QueueWait, MoveIsTakenWhenThereIsRoomAgain) {
  ServerOptions options;
  options.queue_wait = std::chrono::hours(1);
  ServerBench bench(options);
  bench.on_gateway([](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.queue_mock, add(_, _))
        .WillOnce(Return(failure(MinorCode::CommandQueueFull, "full")))
        .WillOnce(Return(failure(MinorCode::CommandQueueFull, "full")))
        .WillOnce(Return(Expected<>{}));
  });
  set_running(bench);
  Client client(bench.port());
  EXPECT_TRUE(client.call("authority.acquire").contains("result"));
  client.send(move_line(30));
  EXPECT_EQ(client.json_line()["result"], true);
  EXPECT_EQ(client.call("RMAC_CAM.Ok")["result"], true) << "waiting is no error of the machine";
}

TEST(QueueWait, OtherClientsAreServedMeanwhile) {
  ServerOptions options;
  options.queue_wait = std::chrono::hours(1);
  ServerBench bench(options);
  const std::future<void> tried = keep_queue_full(bench);
  set_running(bench);
  Client waiting(bench.port());
  EXPECT_TRUE(waiting.call("authority.acquire").contains("result"));
  waiting.send(move_line(1));
  tried.wait();
  EXPECT_EQ(Client(bench.port()).call("RMAC_CAM.GetState").contains("result"), true);
}

TEST(QueueWait, FullQueueIsRefusedAtOnceBeforeCycleStart) {
  ServerOptions options;
  options.queue_wait = std::chrono::hours(1);
  ServerBench bench(options);
  bench.on_gateway([](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.queue_mock, add(_, _)).WillOnce(Return(failure(MinorCode::CommandQueueFull, "full")));
  });
  Client client(bench.port());
  EXPECT_TRUE(client.call("authority.acquire").contains("result"));
  client.send(move_line(40));
  EXPECT_EQ(client.json_line()["error"]["code"], -32015);
  EXPECT_EQ(client.call("RMAC_CAM.StatusMinorCode")["result"], 15);
}

TEST(QueueWait, GivesUpAfterItsTime) {
  ServerOptions options;
  options.queue_wait = std::chrono::milliseconds(0);
  ServerBench bench(options);
  bench.on_gateway([](Server&, FakeMachine& machine) {
    ON_CALL(machine.cam_mock.queue_mock, add(_, _)).WillByDefault(Return(failure(MinorCode::CommandQueueFull, "full")));
  });
  set_running(bench);
  Client client(bench.port());
  EXPECT_TRUE(client.call("authority.acquire").contains("result"));
  client.send(move_line(50));
  EXPECT_EQ(client.json_line()["error"]["code"], -32015);
}

TEST(QueueWait, MovesBehindARefusedOneAreNotTakenInItsPlace) {
  ServerOptions options;
  options.queue_wait = std::chrono::milliseconds(0);
  ServerBench bench(options);
  bench.on_gateway([](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.queue_mock, add(_, _)).WillOnce(Return(failure(MinorCode::CommandQueueFull, "full")));
  });
  Client client(bench.port());
  EXPECT_TRUE(client.call("authority.acquire").contains("result"));
  std::string first = move_line(60);
  std::string second = move_line(61);
  first.pop_back();
  second.pop_back();
  client.send("[" + first + "," + second + "]\n");
  const json answers = client.json_line();
  EXPECT_EQ(answers[0]["error"]["code"], -32015);
  EXPECT_THAT(answers[1]["error"]["message"].get<std::string>(), HasSubstr("a move sent before it"));
}

}  // namespace
}  // namespace rmac::gateway
