// Who may be connected, and who makes room: nobody can keep others from stopping the machine by connecting.
#include "gateway/server/admission.hpp"

#include <gmock/gmock.h>

#include <random>
#include <vector>

#include "bench.hpp"
#include "requests.hpp"

namespace rmac::gateway {
namespace {

using fakes::Client;
using fakes::FakeMachine;
using fakes::line_of;
using fakes::ServerBench;
using testing::HasSubstr;
using testing::Return;

ServerOptions places(std::size_t limit, std::size_t share, std::size_t stops) {
  ServerOptions options;
  options.connection_limit = limit;
  options.peer_share = share;
  options.stop_places = stops;
  return options;
}

TEST(Admission, GivesAWholePlaceWhileThereIsOne) {
  const std::vector<Guest> guests{{1, "a", true}, {2, "a", false}};
  const Admission third = admit(guests, "a", places(3, 3, 1));
  EXPECT_FALSE(third.only_stops);
  EXPECT_FALSE(third.gives_way);
}

TEST(Admission, HasTheFirstThatSaidNothingGiveWay) {
  const std::vector<Guest> guests{{1, "a", true}, {2, "b", false}, {3, "a", false}};
  EXPECT_EQ(admit(guests, "a", places(3, 3, 1)).gives_way, 2U);
  EXPECT_EQ(admit(guests, "a", places(3, 2, 1)).gives_way, 3U) << "of its own peer, where that has its share";
  EXPECT_FALSE(admit(guests, "a", places(3, 2, 1)).only_stops);
}

TEST(Admission, LeavesAPlaceForStopsWhereAllOthersAreInUse) {
  std::vector<Guest> guests{{1, "a", true}, {2, "a", true}};
  EXPECT_THAT(admit(guests, "b", places(2, 2, 2)).only_stops.value_or(""), HasSubstr("2 clients are connected"));
  EXPECT_THAT(admit(guests, "a", places(3, 2, 2)).only_stops.value_or(""), HasSubstr("2 clients of a"));
  EXPECT_FALSE(admit(guests, "b", places(3, 2, 2)).only_stops) << "the share is one peer's";
  guests.push_back({3, "a", false, true});
  EXPECT_FALSE(admit(guests, "b", places(2, 2, 2)).gives_way);
  guests.push_back({4, "a", true, true});
  EXPECT_EQ(admit(guests, "b", places(2, 2, 2)).gives_way, 3U);
}

/// Whoever comes, in whatever order: there are never more than there are places, nobody who works is sent away, and
/// nobody stays outside.
TEST(Admission, KeepsItsBoundsForAnyCrowd) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    std::mt19937 random(seed);
    const auto pick = [&](unsigned most) { return std::uniform_int_distribution<unsigned>(0, most)(random); };
    const ServerOptions options = places(2 + pick(6), 1 + pick(6), 1 + pick(3));
    std::vector<Guest> guests;
    for (std::uint64_t id = 1; id <= 200; ++id) {
      const std::string peer(1, static_cast<char>('a' + pick(2)));
      const Admission admission = admit(guests, peer, options);
      if (admission.gives_way) {
        const auto leaves = std::ranges::find(guests, *admission.gives_way, &Guest::id);
        ASSERT_NE(leaves, guests.end());
        ASSERT_TRUE(leaves->only_stops || !leaves->spoke);
        guests.erase(leaves);
      }
      guests.push_back({id, peer, pick(1) == 0, admission.only_stops.has_value()});
      const auto whole = std::ranges::count(guests, false, &Guest::only_stops);
      ASSERT_LE(static_cast<std::size_t>(whole), options.connection_limit);
      ASSERT_LE(guests.size() - static_cast<std::size_t>(whole), options.stop_places);
      if (pick(3) == 0) guests.erase(guests.begin() + pick(static_cast<unsigned>(guests.size()) - 1));
    }
  }
}

// Red when 64 clients that said nothing kept everybody out, `rmac stop` too.
TEST(Crowd, OfSilentClientsKeepsNobodyOut) {
  ServerBench bench;
  std::vector<std::unique_ptr<Client>> silent;
  for (int i = 0; i < 80; ++i) silent.push_back(std::make_unique<Client>(bench.port()));
  Client operator_(bench.port());
  EXPECT_TRUE(operator_.call("authority.acquire").contains("result"));
  EXPECT_LE(bench.on_gateway([](Server& server, FakeMachine&) { return server.connection_count(); }), 64U);
}

TEST(Crowd, OfBusyClientsKeepsNobodyFromStopping) {
  ServerBench bench(places(2, 2, 1));
  bench.on_gateway([](Server&, FakeMachine& machine) {
    EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).WillRepeatedly(Return(Expected<>{}));
  });
  Client one(bench.port()), two(bench.port());
  EXPECT_EQ(one.call("RMAC_CAM.Ok")["result"], true);
  EXPECT_EQ(two.call("RMAC_CAM.Ok")["result"], true);
  for (int i = 0; i < 3; ++i) {
    Client panel(bench.port());
    EXPECT_TRUE(panel.call("hello", R"({"client":"rmac"})").contains("result"));
    EXPECT_THAT(panel.call("RMAC_CAM.Ok")["error"]["message"].get<std::string>(),
                testing::AllOf(HasSubstr("2 clients"), HasSubstr("can be stopped")));
    EXPECT_EQ(panel.call("RMAC_CAM.StopNow")["result"], true);
  }
  EXPECT_EQ(one.call("RMAC_CAM.Ok")["result"], true) << "who works stays";
}

// Red when sixty clients with a line of 7 MB each, without its end, took all the memory that there was.
TEST(Crowd, LosesWhoTakesMostMemoryFirst) {
  ServerOptions options;
  options.memory_limit_bytes = 256U << 10U;
  ServerBench bench(options);
  Client modest(bench.port()), greedy(bench.port());
  modest.send(std::string(1U << 10U, ' ') + R"({"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.Ok")");
  greedy.send(line_of(1, "RMAC_CAM.Ok") + std::string(1U << 20U, 'x'));
  EXPECT_EQ(greedy.json_line()["result"], true);
  EXPECT_THAT(greedy.json_line()["error"]["message"].get<std::string>(), HasSubstr("more than any other's"));
  EXPECT_EQ(greedy.line(), "") << "closed";
  modest.send("}\n");
  EXPECT_EQ(modest.json_line()["result"], true);
}

TEST(Crowd, LosesWhoSaysNothingForTooLong) {
  ServerOptions options;
  options.silence_limit = std::chrono::milliseconds(1);
  ServerBench bench(options);
  Client silent(bench.port());
  EXPECT_EQ(silent.line(), "") << "closed";
}

}  // namespace
}  // namespace rmac::gateway
