// What goes over the socket when it is not as it should be, and when it is.
#include <gtest/gtest.h>

#include <random>

#include "bench.hpp"

namespace rmac::gateway {
namespace {

using fakes::Client;
using fakes::FakeMachine;
using fakes::ServerBench;
using nlohmann::json;
using testing::_;
using testing::HasSubstr;
using testing::Return;

constexpr const char* kMove = R"({"MoveID":1,"TargetFrame":{"p":[0,0,0],"axis":[0,0,1]}})";

TEST(ServerProtocol, GreetsWithVersionUnitsAndLimits) {
  ServerBench bench;
  Client client(bench.port());
  const json greeting = client.call("hello", R"({"client":"test","version":"1"})")["result"];
  EXPECT_EQ(greeting["server"], "rmacd");
  EXPECT_EQ(greeting["units"]["feed"], "mm/min");
  EXPECT_EQ(greeting["limits"]["line_bytes"], 8 << 20);
  EXPECT_EQ(greeting["limits"]["queue_capacity"], 10000);
}

TEST(ServerProtocol, ShowsNamesThatAreOneLineAndWhole) {
  ServerBench bench;
  Client holder(bench.port()), watcher(bench.port());
  std::string name = "ab\\n";
  for (int i = 0; i < 100; ++i) name += "é";  // of which an odd number of bytes would be cut
  holder.call("hello", R"({"client":")" + name + "\"}");
  holder.call("authority.acquire");
  watcher.call("subscribe", R"({"topics":["state"],"rate_hz":100})");
  EXPECT_THAT(watcher.json_line()["params"]["authority"].get<std::string>(), testing::StartsWith("ab?é"));
  EXPECT_EQ(watcher.call("RMAC_CAM.Ok")["result"], true);
}

TEST(ServerProtocol, TakesNothingFromWhoDoesNotBeginWithJson) {
  const std::string request = R"({"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.StopNow","params":{}})"
                              "\n";
  const std::string post = "POST / HTTP/1.1\r\nHost: 127.0.0.1:7402\r\nContent-Type: text/plain\r\n\r\n" + request;
  for (const std::string& sent : {post, "\r\n" + post, "hello\n" + request, "{\"jsonrpc\":\n" + request,
                                  "{} HTTP/1.1\n" + request, "42\n" + request, "\xEF\xBB\xBF" + request}) {
    SCOPED_TRACE(sent);
    ServerBench bench;
    bench.on_gateway(
        [](Server&, FakeMachine& machine) { EXPECT_CALL(machine.cam_mock.cycle_mock, stop_now()).Times(0); });
    Client client(bench.port());
    client.send(sent);
    const json error = client.json_line()["error"];
    EXPECT_EQ(error["code"], rpc_code::kParseError);
    EXPECT_THAT(error["message"].get<std::string>(), HasSubstr("the first line is not JSON"));
    EXPECT_EQ(client.line(), "") << "and it is closed";
  }
}

TEST(ServerProtocol, TakesABatchFirst) {
  ServerBench bench;
  Client client(bench.port());
  client.send(
      "  ["
      R"({"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.Ok","params":{}}])"
      "\n");
  EXPECT_EQ(client.json_line()[0]["result"], true);
}

TEST(ServerProtocol, AnswersMalformedJsonAndGoesOn) {
  ServerBench bench;
  Client client(bench.port());
  client.call("hello", R"({"client":"test"})");
  client.send("{\"jsonrpc\":\n");
  EXPECT_EQ(client.json_line()["error"]["code"], rpc_code::kParseError);
  client.send(R"({"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.SetFeedrate","params":[NaN]})"
              "\n");
  EXPECT_THAT(client.json_line()["error"]["message"].get<std::string>(), HasSubstr("NaN"));
  EXPECT_EQ(client.call("RMAC_CAM.Ok")["result"], true);
}

TEST(ServerProtocol, AnswersWrongTypesAndUnknownMethods) {
  ServerBench bench;
  Client client(bench.port());
  EXPECT_EQ(client.call("RMAC_CAM.Fly")["error"]["code"], rpc_code::kMethodNotFound);
  EXPECT_EQ(client.call("hello", R"({"client":5})")["error"]["code"], rpc_code::kInvalidParams);
}

TEST(ServerProtocol, AcceptsCarriageReturnsAndBlankLines) {
  ServerBench bench;
  Client client(bench.port());
  client.send("\r\n\n  \n{\"jsonrpc\":\"2.0\",\"id\":\"x\",\"method\":\"RMAC_CAM.Ok\"}\r\n");
  EXPECT_EQ(client.json_line(), json::parse(R"({"jsonrpc":"2.0","id":"x","result":true})"));
}

TEST(ServerProtocol, AnswersBatchesInOrderWithoutNotifications) {
  ServerBench bench;
  Client client(bench.port());
  client.send(R"([{"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.Ok"},{"jsonrpc":"2.0","method":"RMAC_CAM.Ok"},7,)"
              R"({"jsonrpc":"2.0","id":2,"method":"no"}])"
              "\n");
  const json answers = client.json_line();
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_EQ(answers[0]["result"], true);
  EXPECT_EQ(answers[1]["error"]["code"], rpc_code::kInvalidRequest);
  EXPECT_EQ(answers[1]["id"], nullptr);
  EXPECT_EQ(answers[2]["error"]["code"], rpc_code::kMethodNotFound);
}

TEST(ServerProtocol, RefusesAnEmptyBatchAndAHugeOne) {
  ServerBench bench;
  Client client(bench.port());
  client.send("[]\n");
  EXPECT_EQ(client.json_line()["error"]["code"], rpc_code::kInvalidRequest);
  std::string huge = "[0";
  for (int i = 0; i < 10000; ++i) huge += ",0";
  client.send(huge + "]\n");
  EXPECT_THAT(client.json_line()["error"]["message"].get<std::string>(), HasSubstr("10001"));
}

TEST(ServerProtocol, BoundsTheAnswersOfABatch) {
  ServerBench bench;
  Client client(bench.port());
  const std::size_t one = client.call("rpc.discover").dump().size();
  const std::size_t count = (std::size_t{8} << 20) / one + 10;
  std::string batch = "[";
  for (std::size_t i = 0; i < count; ++i) {
    batch += (i == 0 ? "" : ",") + std::string(R"({"jsonrpc":"2.0","id":1,"method":"rpc.discover"})");
  }
  client.send(batch + "]\n");
  const std::string line = client.line();
  EXPECT_LT(line.size(), (std::size_t{8} << 20) + 2 * one);
  const json answers = json::parse(line);
  ASSERT_EQ(answers.size(), count);
  EXPECT_TRUE(answers.front().contains("result"));
  EXPECT_THAT(answers.back()["error"]["message"].get<std::string>(), HasSubstr("exceed 8 MiB"));
}

TEST(ServerProtocol, RefusesWhatItWouldOtherwiseOverlook) {
  ServerBench bench;
  Client client(bench.port());
  client.send(R"({"jsonrpc":"2.0","id":18446744073709551616,"method":"RMAC_CAM.Ok"})"
              "\n");
  json answer = client.json_line();
  EXPECT_EQ(answer["error"]["code"], rpc_code::kInvalidRequest);
  EXPECT_TRUE(answer["id"].is_null());
  client.send(R"({"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.StopNow","method":"RMAC_CAM.Ok"})"
              "\n");
  answer = client.json_line();
  EXPECT_EQ(answer["error"]["code"], rpc_code::kInvalidRequest);
  EXPECT_TRUE(answer["id"].is_null());
  client.send(R"({"jsonrpc":"2.0","id":3,"method":"RMAC_CAM.Ok","param":[]})"
              "\n");
  answer = client.json_line();
  EXPECT_EQ(answer["error"]["code"], rpc_code::kInvalidRequest);
  EXPECT_EQ(answer["id"], 3);
}

TEST(ServerProtocol, GivesNoAnswerToNotifications) {
  ServerBench bench;
  Client client(bench.port());
  client.send("{\"jsonrpc\":\"2.0\",\"method\":\"RMAC_CAM.Ok\"}\n{\"jsonrpc\":\"2.0\",\"method\":\"no such\"}\n");
  EXPECT_EQ(client.call("RMAC_CAM.Ok")["id"], 1);
}

TEST(ServerProtocol, RefusesALineOverTheLimitSaysWhyAndCloses) {
  ServerBench bench;
  Client client(bench.port());
  // 100 MB without a newline: the error must arrive although the client has not stopped sending.
  std::thread sender([&] {
    const std::string piece(std::size_t{1} << 20, 'x');
    for (int i = 0; i < 100; ++i) client.send(piece);
    client.end_writing();
  });
  const json error = client.json_line()["error"];
  EXPECT_EQ(error["code"], rpc_code::kRequestTooLarge);
  EXPECT_THAT(error["message"].get<std::string>(), HasSubstr("8388608 bytes"));
  EXPECT_EQ(client.line(), "");
  sender.join();
  EXPECT_EQ(Client(bench.port()).call("RMAC_CAM.Ok")["result"], true);
}

TEST(ServerProtocol, TakesALongLineThatIsWithinTheLimit) {
  ServerBench bench;
  Client client(bench.port());
  const std::string name(4 << 20, 'n');
  const json answer = client.call("hello", R"({"client":")" + name + R"("})");
  EXPECT_TRUE(answer.contains("result"));
}

TEST(ServerProtocol, AnswersWhatWasSentBeforeTheClientEndedItsSide) {
  ServerBench bench;
  Client client(bench.port());
  client.send(R"({"jsonrpc":"2.0","id":5,"method":"RMAC_CAM.Ok"})");  // no newline
  client.end_writing();
  EXPECT_EQ(client.json_line()["id"], 5);
  EXPECT_EQ(client.line(), "");
}

TEST(ServerProtocol, SurvivesRandomBytes) {
  ServerBench bench;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> byte(0, 255);
    std::string noise;
    for (int i = 0; i < 5000; ++i) noise += static_cast<char>(byte(random));
    Client client(bench.port());
    client.call("hello", R"({"client":"test"})");
    client.send(noise + "\n");
    EXPECT_EQ(client.call("RMAC_CAM.Ok")["result"], true);
  }
}

TEST(ServerProtocol, SurvivesMutatedRequests) {
  ServerBench bench;
  bench.on_gateway([](Server&, FakeMachine& machine) {
    ON_CALL(machine.cam_mock.queue_mock, add(_, _)).WillByDefault(Return(Expected<>{}));
  });
  const std::string seedling =
      std::string(R"({"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.MoveToPathTarget","params":)") + kMove + "}";
  Client client(bench.port());
  EXPECT_TRUE(client.call("authority.acquire").contains("result"));
  std::mt19937 random(42);
  for (int round = 0; round < 2000; ++round) {
    std::string line = seedling;
    for (int change = 0; change < 3; ++change) {
      const std::size_t at = random() % line.size();
      const char replacement = "{}[]\",:0-e.x\x01\xff"[random() % 15];
      if (replacement != '\0') line[at] = replacement;
    }
    client.send(line + "\n");
  }
  client.notifications.clear();
  EXPECT_TRUE(client.call("rpc.discover").contains("result"));
}

TEST(ServerProtocol, CutsOffAClientThatDoesNotReadItsAnswers) {
  ServerOptions options;
  options.output_limit_bytes = 1 << 20;
  ServerBench bench(options);
  Client deaf(bench.port(), 4096);
  EXPECT_TRUE(deaf.call("authority.acquire").contains("result"));
  std::string requests;
  for (int i = 0; i < 200; ++i) requests += "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"rpc.discover\"}\n";
  deaf.send(requests);
  // The lease comes free when the server cuts it off; until then the answer names its holder.
  Client other(bench.port());
  while (other.call("authority.acquire").contains("error")) {
  }
  EXPECT_EQ(other.call("authority.renew")["result"], true);
}

TEST(Server, RefusesToListenForTheNetwork) {
  asio::io_context io;
  FakeMachine machine;
  ServerOptions options;
  options.address = "0.0.0.0";
  Server server(
      io, machine, [] { return std::make_unique<fakes::FakeRecords>(); }, options);
  const auto listening = server.listen();
  ASSERT_FALSE(listening);
  EXPECT_THAT(listening.error().message, HasSubstr("not authenticated"));
}

TEST(Server, SaysWhichPortIsTaken) {
  ServerBench bench;
  asio::io_context io;
  FakeMachine machine;
  ServerOptions options;
  options.port = bench.port();
  Server server(
      io, machine, [] { return std::make_unique<fakes::FakeRecords>(); }, options);
  const auto listening = server.listen();
  ASSERT_FALSE(listening);
  EXPECT_THAT(listening.error().message, HasSubstr(std::to_string(bench.port())));
}

TEST(Server, ListensOnAUnixSocketAndReplacesAStaleOne) {
  const auto path = std::filesystem::temp_directory_path() / ("rmac-test-" + std::to_string(::getpid()) + ".sock");
  for (int round = 0; round < 2; ++round) {
    ServerOptions options;
    options.unix_socket = path;
    ServerBench bench(options);
    asio::io_context io;
    asio::local::stream_protocol::socket socket(io);
    socket.connect(asio::local::stream_protocol::endpoint(path.string()));
    asio::write(socket, asio::buffer(std::string("{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"RMAC_CAM.Ok\"}\n")));
    std::string answer;
    asio::read_until(socket, asio::dynamic_buffer(answer), '\n');
    EXPECT_EQ(json::parse(answer)["result"], true);
    if (round == 0) {
      // Left behind by a daemon that died: a socket file that nobody answers on.
      bench.on_gateway([&](Server& server, FakeMachine&) { server.close(); });
      asio::local::stream_protocol::acceptor stale(io, asio::local::stream_protocol::endpoint(path.string()));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace rmac::gateway
