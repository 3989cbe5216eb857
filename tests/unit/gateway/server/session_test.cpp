#include "gateway/server/session.hpp"

#include <gmock/gmock.h>

#include "unit/gateway/api/fakes.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

struct OnePeer : Peers {
  void overtake(std::uint64_t, const std::string&, const Request&, std::uint64_t) override {}
  std::optional<std::string> fast_watcher_beside(std::uint64_t) const override { return fast; }
  void announce(Event::Kind kind, std::string message) override { told.emplace_back(kind, std::move(message)); }
  void bound_memory() override {}
  void forget(std::uint64_t) override {}
  std::optional<std::string> fast;
  std::vector<std::pair<Event::Kind, std::string>> told;
};

struct SessionBench {
  fakes::FakeMachine machine;
  Dispatcher dispatcher{machine};
  asio::io_context io;
  MachineAside aside{io, dispatcher, [] {}};
  ServerOptions options;
  LeaseKeeper lease{dispatcher, aside, options, [](Event::Kind, const std::string&) {}};
  OperatorPost post;
  OnePeer peers;
  ConnectionContext context{
      dispatcher, aside, lease, post, peers, options, [] { return std::make_unique<fakes::FakeRecords>(); }};
  Subscriptions subscriptions{1000, [](const CycleSample&) { return std::string("0"); },
                              [] { return Scene{.drawing = std::make_shared<const MachineDrawing>()}; }};
  Session session{context, 7, "TCP client 7", subscriptions};
};

TEST(Session, IsNamedByWhereItComesFromUntilItGivesAName) {
  SessionBench bench;
  EXPECT_EQ(bench.session.name(), "TCP client 7");
  bench.session.introduce("cam-tool", "2.1");
  EXPECT_EQ(bench.session.name(), "cam-tool 2.1 (TCP client 7)");
  bench.session.introduce("cam\ntool", "");
  EXPECT_EQ(bench.session.name(), "cam?tool (TCP client 7)");
}

TEST(Session, GreetsWithItsNumberAndTheLimitsInForce) {
  SessionBench bench;
  bench.options.queue_wait = std::chrono::milliseconds(1500);
  bench.options.line_limit_bytes = 99;
  const nlohmann::json greeting = bench.session.greeting();
  EXPECT_EQ(greeting["connection"], 7);
  EXPECT_EQ(greeting["limits"]["queue_wait_s"], 1.5);
  EXPECT_EQ(greeting["limits"]["line_bytes"], 99);
  EXPECT_EQ(greeting["limits"]["watch_rate_hz"], 100);
}

TEST(Session, IsTheOperatorUntilItLeavesAndSaysBothOnce) {
  SessionBench bench;
  EXPECT_FALSE(bench.session.release_operator());
  EXPECT_EQ(bench.session.acquire_operator(), "TCP client 7");
  EXPECT_TRUE(bench.session.acquire_operator()) << "again is no error";
  const OperatorRef held = bench.session.holds_as();
  ASSERT_TRUE(held);
  EXPECT_TRUE(held->present());
  bench.session.leave_posts("disconnected with");
  bench.session.leave_posts("disconnected with");
  EXPECT_FALSE(held->present()) << "what they hold knows that they have left";
  EXPECT_FALSE(bench.session.is_operator());
  EXPECT_EQ(bench.session.holds_as(), nullptr);
  ASSERT_EQ(bench.peers.told.size(), 2U);
  EXPECT_THAT(bench.peers.told[0].second, HasSubstr("TCP client 7 is the operator"));
  EXPECT_THAT(bench.peers.told[1].second, HasSubstr("TCP client 7 disconnected with the operator's place"));
}

TEST(Session, HoldsForNobodyWhereTheProgramMayResumeToo) {
  SessionBench bench;
  bench.options.operator_alone_resumes = false;
  ASSERT_TRUE(bench.session.acquire_operator());
  EXPECT_TRUE(bench.session.is_operator());
  EXPECT_EQ(bench.session.holds_as(), nullptr);
}

TEST(Session, HoldsTheLeaseByItsNumber) {
  SessionBench bench;
  EXPECT_FALSE(bench.session.renew_authority());
  EXPECT_TRUE(bench.session.acquire_authority());
  EXPECT_TRUE(bench.lease.held_by(7));
  EXPECT_TRUE(bench.session.has_authority());
  EXPECT_EQ(bench.session.authority_holder(), "TCP client 7");
  EXPECT_TRUE(bench.session.release_authority());
  EXPECT_FALSE(bench.session.has_authority());
  EXPECT_FALSE(bench.session.release_authority()) << "it holds nothing any more";
}

TEST(Session, IsRefusedARateThatAnotherHasAndStartsNothingThen) {
  SessionBench bench;
  bench.peers.fast = "recorder (TCP client 1)";
  const auto refused = bench.session.subscribe({"joints", "events"}, 101);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, rpc_code::kRateTaken);
  EXPECT_THAT(refused.error().message, HasSubstr("recorder (TCP client 1) receives more than 100 samples"));
  EXPECT_FALSE(bench.subscriptions.has_events());
  EXPECT_TRUE(bench.session.subscribe({"joints"}, 100)) << "the watchers' rate is for everybody";
  EXPECT_TRUE(bench.session.subscribe({"events"}, 1000)) << "events have no rate";
}

}  // namespace
}  // namespace rmac::gateway
