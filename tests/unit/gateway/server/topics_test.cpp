// Subscriptions: what is pushed, how often, and to whom.
#include <gtest/gtest.h>

#include <cmath>

#include "animated_machine.hpp"
#include "bench.hpp"
#include "gateway/server/telemetry.hpp"

namespace rmac::gateway {
namespace {

using fakes::Client;
using fakes::FakeMachine;
using fakes::ServerBench;
using nlohmann::json;
using testing::HasSubstr;

CycleSample sample_at(std::int64_t cycle) {
  CycleSample sample;
  sample.cycle = cycle;
  sample.t_s = static_cast<double>(cycle) * 0.001;
  sample.joint_count = 2;
  sample.joint_count_with_held = 3;
  sample.moving = true;
  sample.move_id = 42;
  sample.s_mm = 1.0 / 3;
  sample.feed_set_mm_s = 33.3;
  sample.position_set = {0.1, 0.2, 0.3};
  sample.velocity_set = {1, 2, 3};
  sample.acceleration_set = {4, 5, 6};
  sample.position = {0.11, 0.22, 0.33};
  sample.following_error = {1.0 / 7, 2.0 / 7, 3.0 / 7};  // of setpoints some cycles before
  return sample;
}

void push_samples(ServerBench& bench, std::int64_t first, std::int64_t count) {
  bench.on_gateway([&](Server& server, FakeMachine&) {
    for (std::int64_t cycle = first; cycle < first + count; ++cycle) server.on_sample(sample_at(cycle));
    server.tick();
  });
}

TEST(Telemetry, JointsCarryASetpointRecordWithAllDigits) {
  std::string text;
  append_joints(sample_at(7), text);
  const json sample = json::parse(text);
  EXPECT_EQ(sample["cycle"], 7);
  EXPECT_EQ(sample["t_s"], 0.007);
  EXPECT_EQ(sample["move_id"], 42);
  EXPECT_EQ(sample["s_mm"], 1.0 / 3) << "every bit of the number";
  EXPECT_EQ(sample["feed_mm_s"], 33.3);
  EXPECT_EQ(sample["pose"], json::parse("[0,0,0,0,0,1]"));
  EXPECT_EQ(sample["q"], json::parse("[0.1,0.2]"));
  EXPECT_EQ(sample["qd"], json::parse("[1,2]"));
  EXPECT_EQ(sample["qdd"], json::parse("[4,5]"));
  EXPECT_EQ(sample["a"], json::parse("[0.11,0.22]"));
  EXPECT_EQ(sample["held"], json::parse("[0.33]"));
  EXPECT_EQ(sample["error"], json({1.0 / 7, 2.0 / 7})) << "not q - a: drives may answer late";
  EXPECT_EQ(sample["held_error"], json({3.0 / 7}));
}

// Nothing stands for what no drive tells.
TEST(Telemetry, JointsTellTheTruthApartFromWhatWasMeasuredWhereItIsKnown) {
  CycleSample sample = sample_at(7);
  const auto told = [&] {
    std::string text;
    append_joints(sample, text);
    return json::parse(text);
  };
  EXPECT_FALSE(told().contains("truth"));
  EXPECT_FALSE(told().contains("held_truth"));
  sample.truth = {0.4, 0.5, 0.6};
  EXPECT_EQ(told()["truth"], json::parse("[0.4,0.5]"));
  EXPECT_EQ(told()["held_truth"], json::parse("[0.6]"));
  EXPECT_EQ(told()["a"], json::parse("[0.11,0.22]"));
  sample.joint_count_with_held = sample.joint_count;
  EXPECT_FALSE(told().contains("held_truth"));
}

TEST(Telemetry, NumbersThatJsonHasNotBecomeNull) {
  CycleSample sample = sample_at(1);
  sample.position[0] = std::nan("");
  std::string text;
  append_joints(sample, text);
  EXPECT_TRUE(json::parse(text)["a"][0].is_null());
}

TEST(Topics, FullRateCarriesEveryCycleOnce) {
  ServerBench bench;
  Client client(bench.port());
  EXPECT_EQ(client.call("subscribe", R"({"topics":["joints"],"rate_hz":1000})")["result"], true);
  push_samples(bench, 1, 3000);
  std::int64_t expected = 1;
  while (expected <= 3000) {
    const json params = client.pushed("joints");
    ASSERT_FALSE(params.is_null());
    for (const json& sample : params["samples"]) EXPECT_EQ(sample["cycle"], expected++);
  }
}

TEST(Topics, WatchersGetEveryTenthCycle) {
  ServerBench bench;
  Client client(bench.port());
  EXPECT_EQ(client.call("subscribe", R"({"topics":["joints","drives"]})")["result"], true);
  push_samples(bench, 1, 100);
  EXPECT_EQ(client.pushed("joints")["samples"].size(), 10U);
  EXPECT_EQ(client.pushed("drives")["samples"].size(), 10U);
}

TEST(Topics, AnAnimationNeitherLowersARateNorEndsASubscription) {
  ServerBench bench;
  Client client(bench.port());
  EXPECT_EQ(client.call("subscribe", R"({"topics":["joints"],"rate_hz":1000})")["result"], true);
  EXPECT_TRUE(client.call("RMAC_CAM.SetAnimation", "[true]").contains("result"));
  push_samples(bench, 1, 100);
  EXPECT_EQ(client.pushed("joints")["samples"].size(), 100U);
  EXPECT_TRUE(client.call("RMAC_CAM.SetAnimation", "[false]").contains("result"));
  push_samples(bench, 101, 100);
  EXPECT_EQ(client.pushed("joints")["samples"].size(), 100U);
}

TEST(Topics, AnAnimationRaisesALowerRateUntilItEnds) {
  ServerBench bench;
  Client client(bench.port());
  EXPECT_EQ(client.call("subscribe", R"({"topics":["joints"],"rate_hz":10})")["result"], true);
  EXPECT_TRUE(client.call("RMAC_CAM.SetAnimation", "[true]").contains("result"));
  push_samples(bench, 1, 100);
  EXPECT_EQ(client.pushed("joints")["samples"].size(), 5U);
  EXPECT_TRUE(client.call("RMAC_CAM.SetAnimation", "[false]").contains("result"));
  push_samples(bench, 101, 100);
  EXPECT_EQ(client.pushed("joints")["samples"].size(), 1U);
}

TEST(Topics, AnAnimationTellsSixtyTimesASecondWhereTheLinksAreAndEndsWithIt) {
  ServerBench bench;
  bench.on_gateway([](Server&, FakeMachine& machine) {
    machine.shape_fake.now = fakes::slides_drawing();
    machine.device_fake.is_virtual = true;
  });
  Client client(bench.port());
  EXPECT_TRUE(client.call("RMAC_CAM.SetAnimation", "[true]").contains("result"));
  push_samples(bench, 1, 1000);
  const json params = client.pushed("animation");
  EXPECT_EQ(params["samples"].size(), 60U);
  EXPECT_EQ(params["machine"], "Slides");
  EXPECT_EQ(params["virtual"], true);
  EXPECT_EQ(params["samples"][0]["joints"], json::parse("[0.11, 0.22]"));
  EXPECT_EQ(client.pushed("joints")["samples"].size(), 50U) << "who looks at joints alone goes on to";
  EXPECT_TRUE(client.call("RMAC_CAM.SetAnimation", "[false]").contains("result"));
  client.notifications.clear();
  push_samples(bench, 1001, 1000);
  EXPECT_TRUE(client.call("RMAC_CAM.Ok").contains("result"));
  EXPECT_TRUE(client.notifications.empty()) << client.notifications[0];
}

TEST(Topics, AnAnimationLeavesPosesThatWereSubscribedToAsTheyWere) {
  ServerBench bench;
  bench.on_gateway([](Server&, FakeMachine& machine) { machine.shape_fake.now = fakes::slides_drawing(); });
  Client client(bench.port());
  EXPECT_EQ(client.call("subscribe", R"({"topics":["animation"],"rate_hz":10})")["result"], true);
  EXPECT_TRUE(client.call("RMAC_CAM.SetAnimation", "[true]").contains("result"));
  push_samples(bench, 1, 1000);
  EXPECT_EQ(client.pushed("animation")["samples"].size(), 60U);
  EXPECT_TRUE(client.call("RMAC_CAM.SetAnimation", "[false]").contains("result"));
  push_samples(bench, 1001, 1000);
  EXPECT_EQ(client.pushed("animation")["samples"].size(), 10U);
  EXPECT_EQ(client.call("unsubscribe", R"({"topics":["animation"]})")["result"], true);
  client.notifications.clear();
  push_samples(bench, 2001, 1000);
  EXPECT_TRUE(client.call("RMAC_CAM.Ok").contains("result"));
  EXPECT_TRUE(client.notifications.empty()) << client.notifications[0];
}

TEST(Topics, AWatcherOfPosesThatDoesNotReadIsCutOffAsAnyOther) {
  ServerOptions options;
  options.output_limit_bytes = 1 << 20;
  ServerBench bench(options);
  bench.on_gateway([](Server&, FakeMachine& machine) { machine.shape_fake.now = fakes::slides_drawing(); });
  Client client(bench.port(), 4096);
  EXPECT_EQ(client.call("subscribe", R"({"topics":["animation"],"rate_hz":1000})")["result"], true);
  const auto watched = [&] {
    return bench.on_gateway([](Server& server, FakeMachine&) { return server.connection_count(); });
  };
  for (std::int64_t cycle = 1; watched() == 1; cycle += 1000) {
    push_samples(bench, cycle, 1000);
    ASSERT_LT(cycle, 1'000'000) << "never cut off";
  }
}

TEST(Topics, OneClientAtATimeGetsTheFullRate) {
  ServerBench bench;
  Client first(bench.port());
  first.call("hello", R"({"client":"recorder"})");
  EXPECT_EQ(first.call("subscribe", R"({"topics":["joints"],"rate_hz":1000})")["result"], true);
  EXPECT_EQ(first.call("subscribe", R"({"topics":["drives"],"rate_hz":500})")["result"], true);
  Client second(bench.port());
  const json refused = second.call("subscribe", R"({"topics":["joints"],"rate_hz":101})")["error"];
  EXPECT_EQ(refused["code"], rpc_code::kRateTaken);
  EXPECT_THAT(refused["message"].get<std::string>(), HasSubstr("recorder"));
  EXPECT_EQ(second.call("subscribe", R"({"topics":["joints"],"rate_hz":100})")["result"], true);
  EXPECT_EQ(first.call("unsubscribe")["result"], true);
  EXPECT_EQ(second.call("subscribe", R"({"topics":["joints"],"rate_hz":1000})")["result"], true);
}

TEST(Topics, StateComesAtOnceWithoutAnyCycle) {
  ServerBench bench;
  Client client(bench.port());
  EXPECT_EQ(client.call("subscribe", R"({"topics":["state"],"rate_hz":10})")["result"], true);
  const json state = client.pushed("state");
  EXPECT_EQ(state["mechanism"], "Fake");
  EXPECT_EQ(state["state"], "Idle");
}

TEST(Topics, EventsComeAfterTheSamplesBeforeThem) {
  ServerBench bench;
  Client client(bench.port());
  EXPECT_EQ(client.call("subscribe", R"({"topics":["joints","events"],"rate_hz":1000})")["result"], true);
  bench.on_gateway([&](Server& server, FakeMachine&) {
    server.on_sample(sample_at(1));
    Event event;
    event.kind = Event::Kind::MoveDone;
    event.move_id = 42;
    event.message = "move 42 is done \xff";
    server.on_event(event);
  });
  EXPECT_EQ(client.json_line()["method"], "joints");
  const json event = client.json_line();
  EXPECT_EQ(event["method"], "events");
  EXPECT_EQ(event["params"]["kind"], "MoveDone");
  EXPECT_EQ(event["params"]["move_id"], 42);
}

TEST(Topics, FaultsSetTheMachinesStatus) {
  ServerBench bench;
  Client client(bench.port());
  bench.on_gateway([&](Server& server, FakeMachine&) { server.announce(Event::Kind::Fault, "following error"); });
  EXPECT_EQ(client.call("RMAC_CAM.Ok")["result"], false);
}

TEST(Topics, RefusesUnknownTopicsAndRates) {
  ServerBench bench;
  Client client(bench.port());
  EXPECT_THAT(client.call("subscribe", R"({"topics":["weather"]})")["error"]["message"].get<std::string>(),
              HasSubstr("\"weather\""));
  EXPECT_EQ(client.call("subscribe", R"({"topics":["state"],"rate_hz":0})")["error"]["code"], rpc_code::kInvalidParams);
}

TEST(Topics, VirtualTimeWaitsForAWatcherThatIsBehindAndGoesOnWhenItReads) {
  ServerOptions options;
  options.throttle_machine = true;
  options.high_water_bytes = 1 << 16;
  ServerBench bench(options);
  Client client(bench.port(), 4096);
  EXPECT_EQ(client.call("subscribe", R"({"topics":["joints"],"rate_hz":1000})")["result"], true);
  std::int64_t cycles = 0;
  const auto may_go_on = [&] {
    return bench.on_gateway([](Server& server, FakeMachine&) { return server.may_dispatch(); });
  };
  while (may_go_on()) {
    push_samples(bench, cycles + 1, 1000);
    cycles += 1000;
    ASSERT_LT(cycles, 1'000'000) << "virtual time never waits";
  }
  std::int64_t seen = 0;
  while (seen < cycles) {
    const json params = client.pushed("joints");
    ASSERT_FALSE(params.is_null()) << "cut off";
    for (const json& sample : params["samples"]) EXPECT_EQ(sample["cycle"], ++seen);
  }
  EXPECT_TRUE(may_go_on());
}

TEST(Topics, AStalledWatcherDoesNotHoldVirtualTimeForEver) {
  ServerOptions options;
  options.throttle_machine = true;
  options.high_water_bytes = 1 << 16;
  options.stall_limit = std::chrono::milliseconds(0);
  ServerBench bench(options);
  Client client(bench.port(), 4096);
  EXPECT_EQ(client.call("subscribe", R"({"topics":["joints"],"rate_hz":1000})")["result"], true);
  const auto watched = [&] {
    return bench.on_gateway([](Server& server, FakeMachine&) { return server.connection_count(); });
  };
  for (std::int64_t cycle = 1; watched() == 1; cycle += 1000) {
    push_samples(bench, cycle, 1000);
    ASSERT_LT(cycle, 1'000'000) << "never cut off";
  }
  EXPECT_TRUE(bench.on_gateway([](Server& server, FakeMachine&) { return server.may_dispatch(); }));
}

}  // namespace
}  // namespace rmac::gateway
