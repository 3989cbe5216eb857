#include "gateway/server/listeners.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

struct ListenersBench {
  asio::io_context io;
  std::vector<std::string> came;
  Listeners listeners{io, [this](Listeners::Socket, const char* what, const std::string& peer) {
                        came.push_back(std::string(what) + " from " + peer);
                      }};
};

std::filesystem::path socket_path() {
  return std::filesystem::temp_directory_path() / ("rmac-listeners-" + std::to_string(::getpid()) + ".sock");
}

TEST(Listeners, TellThroughWhatAndFromWhereEachClientCame) {
  ListenersBench bench;
  ASSERT_TRUE(bench.listeners.listen_on_tcp("127.0.0.1", 0));
  ASSERT_TRUE(bench.listeners.listen_on_unix(socket_path()));
  asio::ip::tcp::socket network(bench.io);
  network.connect({asio::ip::address_v4::loopback(), bench.listeners.port()});
  while (bench.came.empty()) bench.io.run_one();
  asio::local::stream_protocol::socket local(bench.io);
  local.connect(asio::local::stream_protocol::endpoint(socket_path().string()));
  while (bench.came.size() < 2) bench.io.run_one();
  EXPECT_EQ(bench.came,
            (std::vector<std::string>{"TCP from 127.0.0.1", "UNIX socket from user " + std::to_string(::geteuid())}));
  bench.listeners.close();
}

TEST(Listeners, RefuseWhatIsNoAddressOrNoLoopback) {
  ListenersBench bench;
  EXPECT_EQ(bench.listeners.listen_on_tcp("here", 0).error().message, "here is not an IP address");
  EXPECT_THAT(bench.listeners.listen_on_tcp("0.0.0.0", 0).error().message, HasSubstr("not a loopback address"));
}

TEST(Listeners, LeaveASocketThatAnotherDaemonAnswersOn) {
  ListenersBench first, second;
  ASSERT_TRUE(first.listeners.listen_on_unix(socket_path()));
  EXPECT_EQ(second.listeners.listen_on_unix(socket_path()).error().message,
            "another daemon listens on " + socket_path().string());
  second.listeners.close();
  EXPECT_TRUE(std::filesystem::exists(socket_path())) << "it is the first one's";
  first.listeners.close();
  EXPECT_FALSE(std::filesystem::exists(socket_path()));
}

TEST(Listeners, ReplaceASocketThatNobodyAnswersOnAndRemoveTheirOwnOnce) {
  ListenersBench bench;
  {
    asio::local::stream_protocol::acceptor stale(bench.io,
                                                 asio::local::stream_protocol::endpoint(socket_path().string()));
  }
  ASSERT_TRUE(bench.listeners.listen_on_unix(socket_path()));
  bench.listeners.close();
  asio::local::stream_protocol::acceptor next(bench.io, asio::local::stream_protocol::endpoint(socket_path().string()));
  bench.listeners.close();
  EXPECT_TRUE(std::filesystem::exists(socket_path())) << "the file is another's by now";
  std::filesystem::remove(socket_path());
}

TEST(Listeners, LetNobodyInAfterTheyStopped) {
  ListenersBench bench;
  ASSERT_TRUE(bench.listeners.listen_on_tcp("127.0.0.1", 0));
  bench.listeners.stop();
  asio::ip::tcp::socket network(bench.io);
  asio::error_code problem;
  network.connect({asio::ip::address_v4::loopback(), bench.listeners.port()}, problem);
  EXPECT_TRUE(problem);
}

}  // namespace
}  // namespace rmac::gateway
