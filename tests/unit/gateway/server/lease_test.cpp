// When the lease ends by itself, and what its end does to the queue and to the drives.
#include <gtest/gtest.h>

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
using testing::HasSubstr;
using testing::Return;

TEST(Lease, LossAtRestDropsTheQueueToo) {
  ServerBench bench;
  bench.on_gateway([](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.queue_mock, moves_left()).WillOnce(Return(2)).WillRepeatedly(Return(0));
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).WillOnce(Return(Expected<>{}));
  });
  Client client(bench.port());
  EXPECT_TRUE(client.call("authority.acquire").contains("result"));
  EXPECT_EQ(client.call("authority.release")["result"], true);
  EXPECT_EQ(client.call("authority.acquire")["result"]["dropped_moves"], 2);
}

TEST(Lease, PowerOffIsTriedAgainUntilItSucceedsAndSaysOnceWhyItDidNot) {
  ServerOptions options;
  options.lease_lost = LeaseLostAction::StopAndPowerOff;
  ServerBench bench(options);
  Client watcher(bench.port());
  EXPECT_EQ(watcher.call("subscribe", R"({"topics":["events"]})")["result"], true);
  Client holder(bench.port());
  EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
  set_running(bench);
  bench.on_gateway(
      [](Server&, FakeMachine& machine) { machine.device_fake.unload_refusal = "the queue is not empty"; });
  EXPECT_EQ(holder.call("authority.release")["result"], true);
  bench.on_gateway([](Server& server, FakeMachine& machine) {
    machine.now.state = CycleState::Idle;
    machine.now.moving = false;
    for (int tick = 0; tick < 3; ++tick) server.tick();
    EXPECT_TRUE(machine.device_fake.device);
    machine.device_fake.unload_refusal.clear();
    server.tick();
    EXPECT_FALSE(machine.device_fake.device);
  });
  std::vector<std::string> told;
  do {
    const json event = watcher.pushed("events");
    ASSERT_FALSE(event.is_null());
    told.push_back(event["message"]);
  } while (told.back().find("are switched off;") == std::string::npos);
  EXPECT_EQ(std::ranges::count(told, "the drives are not switched off yet: the queue is not empty"), 1);
  EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
}

TEST(Lease, IsTheDaemonsWhenItEnds) {
  ServerBench bench;
  Client holder(bench.port());
  EXPECT_EQ(holder.call("subscribe", R"({"topics":["events"]})")["result"], true);
  EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
  set_running(bench);
  bench.on_gateway([](Server& server, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).WillOnce(Return(Expected<>{}));
    EXPECT_CALL(machine.cam_mock.cycle_mock, start(_)).Times(0);
    server.retire();
  });
  EXPECT_EQ(holder.call("RMAC_CAM.CycleStart", "[1]")["error"]["code"], rpc_code::kAuthorityRequired);
  EXPECT_THAT(holder.call("authority.acquire")["error"]["message"].get<std::string>(), HasSubstr("ending"));
  bench.on_gateway([](Server& server, FakeMachine&) {
    server.on_event({Event::Kind::Stopped, 0, 0, "at rest", 0, {}});
    server.dismiss();
  });
  holder.pushed("events");
  holder.pushed("events");
  EXPECT_EQ(holder.pushed("events")["kind"], "Stopped") << "what was told before the end arrives";
  EXPECT_EQ(holder.line(), "");
}

/// A clock that stands until it is told to go on.
struct LeaseClock {
  std::chrono::steady_clock::time_point now{};
  ServerOptions options() {
    ServerOptions options;
    options.lease_timeout = std::chrono::seconds(5);
    options.now = [this] { return now; };
    return options;
  }
  /// Time passes, and the server notices.
  void pass(ServerBench& bench, std::chrono::milliseconds time) {
    bench.on_gateway([&](Server& server, FakeMachine&) {
      now += time;
      server.tick();
    });
  }
};

TEST(LeaseTimeout, EndsTheLeaseOfASilentHolderAndStopsTheMachine) {
  LeaseClock clock;
  ServerBench bench(clock.options());
  Client watcher(bench.port());
  EXPECT_EQ(watcher.call("subscribe", R"({"topics":["events"]})")["result"], true);
  Client holder(bench.port());
  EXPECT_EQ(holder.call("authority.acquire")["result"]["timeout_s"], 5);
  set_running(bench);
  bench.on_gateway([](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).WillOnce([&]() -> Expected<> {
      machine.now = {};
      return {};
    });
  });
  clock.pass(bench, std::chrono::milliseconds(5001));
  watcher.pushed("events");
  EXPECT_THAT(watcher.pushed("events")["message"].get<std::string>(),
              testing::AllOf(HasSubstr("silent"), HasSubstr("stopped on its path")));
  EXPECT_EQ(holder.call("RMAC_CAM.CycleStart", "[1]")["error"]["code"], rpc_code::kAuthorityRequired);
  EXPECT_TRUE(watcher.call("authority.acquire").contains("result"));
}

TEST(LeaseTimeout, AnyRequestOfTheHolderKeepsTheLease) {
  LeaseClock clock;
  ServerBench bench(clock.options());
  Client holder(bench.port());
  Client other(bench.port());
  EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
  for (const char* request : {"RMAC_CAM.Ok", "authority.renew", "no such method"}) {
    clock.pass(bench, std::chrono::milliseconds(4000));
    other.call("RMAC_CAM.Ok");
    holder.call(request);
  }
  clock.pass(bench, std::chrono::milliseconds(5000));
  EXPECT_EQ(holder.call("authority.renew")["result"], true);
}

TEST(LeaseTimeout, IsOffUnlessConfigured) {
  LeaseClock clock;
  ServerOptions options = clock.options();
  options.lease_timeout = std::chrono::milliseconds(0);
  ServerBench bench(options);
  Client holder(bench.port());
  EXPECT_EQ(holder.call("authority.acquire")["result"]["timeout_s"], 0);
  clock.pass(bench, std::chrono::hours(24));
  EXPECT_EQ(holder.call("authority.renew")["result"], true);
}

TEST(LeaseTimeout, SilenceBeginsWithTheAnswer) {
  LeaseClock clock;
  ServerBench bench(clock.options());
  bench.on_gateway([&](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.cycle_mock, resume()).WillOnce([&]() -> Expected<> {
      clock.now += std::chrono::hours(2);
      return {};
    });
  });
  Client holder(bench.port()), other(bench.port());
  EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
  EXPECT_EQ(holder.call("RMAC_CAM.FeedResume")["result"], true);
  clock.pass(bench, std::chrono::seconds(4));
  EXPECT_EQ(other.call("authority.acquire")["error"]["code"], rpc_code::kAuthorityHeld);
  clock.pass(bench, std::chrono::seconds(2));
  EXPECT_TRUE(other.call("authority.acquire").contains("result"));
}

TEST(LeaseTimeout, AHolderThatWaitsForRoomIsNotSilent) {
  LeaseClock clock;
  ServerOptions options = clock.options();
  options.queue_wait = std::chrono::hours(1);
  ServerBench bench(options);
  const std::future<void> tried = keep_queue_full(bench);
  set_running(bench);
  Client holder(bench.port());
  EXPECT_TRUE(holder.call("authority.acquire").contains("result"));
  holder.send(move_line(1));
  tried.wait();
  clock.pass(bench, std::chrono::hours(2));
  EXPECT_EQ(Client(bench.port()).call("authority.acquire")["error"]["code"], rpc_code::kAuthorityHeld);
}

}  // namespace
}  // namespace rmac::gateway
