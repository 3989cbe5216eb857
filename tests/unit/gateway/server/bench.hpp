#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <atomic>
#include <future>
#include <string>
#include <thread>

#include "gateway/server/server.hpp"
#include "unit/gateway/api/fakes.hpp"

namespace rmac::gateway::fakes {

/// A server on a free port with a fake machine; its io_context runs on a thread of its own, as the gateway's does.
class ServerBench {
 public:
  explicit ServerBench(ServerOptions options = {}) {
    options.port = 0;
    server_ = std::make_unique<Server>(
        io_, machine_, [this] { return std::make_unique<FakeRecords>(&machine_); }, options);
    const auto listening = server_->listen();
    if (!listening) ADD_FAILURE() << listening.error().message;
    tick();
    thread_ = std::thread([this] { io_.run(); });
  }
  [[nodiscard]] std::uint16_t port() const { return server_->port(); }

  /// Runs `function` on the gateway's thread and waits for it.
  template <typename Function>
  auto on_gateway(Function function) {
    using Result = decltype(function(*server_, machine_));
    std::packaged_task<Result()> task([&] { return function(*server_, machine_); });
    auto result = task.get_future();
    asio::post(io_, [&] { task(); });
    return result.get();
  }

  ~ServerBench() {
    on_gateway([this](Server& server, FakeMachine&) {
      timer_.cancel();
      server.close();
      ended_ = true;
    });
    thread_.join();
  }

 private:
  void tick() {
    timer_.expires_after(std::chrono::milliseconds(1));
    timer_.async_wait([this](asio::error_code problem) {
      if (problem || ended_) return;
      server_->tick();
      tick();
    });
  }

  asio::io_context io_;
  FakeMachine machine_;
  std::unique_ptr<Server> server_;
  asio::steady_timer timer_{io_};
  bool ended_ = false;
  std::thread thread_;
};

/// A blocking client. A read that waits for half a minute fails its test instead of hanging it.
class Client {
 public:
  explicit Client(std::uint16_t port, int receive_buffer_bytes = 0) : socket_(io_) {
    socket_.open(asio::ip::tcp::v4());
    if (receive_buffer_bytes != 0) {
      socket_.set_option(asio::socket_base::receive_buffer_size(receive_buffer_bytes));
    }
    socket_.connect({asio::ip::address_v4::loopback(), port});
    const timeval limit{30, 0};
    ::setsockopt(socket_.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    ::setsockopt(socket_.native_handle(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  }

  void send(const std::string& text) {
    asio::error_code ignored;
    asio::write(socket_, asio::buffer(text), ignored);
  }

  /// The next line, or "" when the server closed (or half a minute passed).
  std::string line() {
    for (;;) {
      if (const std::size_t end = input_.find('\n'); end != std::string::npos) {
        std::string result = input_.substr(0, end);
        input_.erase(0, end + 1);
        return result;
      }
      std::array<char, 65536> chunk{};
      const ssize_t bytes = ::recv(socket_.native_handle(), chunk.data(), chunk.size(), 0);
      if (bytes <= 0) {
        timed_out_ = bytes < 0 && errno == EAGAIN;
        EXPECT_FALSE(timed_out_) << "nothing came";
        return {};
      }
      input_.append(chunk.data(), static_cast<std::size_t>(bytes));
    }
  }
  nlohmann::json json_line() {
    const std::string text = line();
    return text.empty() ? nlohmann::json() : nlohmann::json::parse(text);
  }

  /// The answer to one request; pushed notifications on the way are kept.
  nlohmann::json call(const std::string& method, const std::string& params = "{}") {
    const int id = ++last_id_;
    send(R"({"jsonrpc":"2.0","id":)" + std::to_string(id) + R"(,"method":")" + method + R"(","params":)" + params +
         "}\n");
    return answer(id);
  }
  nlohmann::json answer(int id) {
    for (;;) {
      nlohmann::json message = json_line();
      if (message.is_null() || (message.is_object() && message.contains("id") && message["id"] == id)) return message;
      notifications.push_back(std::move(message));
    }
  }
  /// The next notification of a topic.
  nlohmann::json pushed(const std::string& topic) {
    for (;;) {
      for (auto note = notifications.begin(); note != notifications.end(); ++note) {
        if (!note->is_object() || note->value("method", "") != topic) continue;
        nlohmann::json params = (*note)["params"];
        notifications.erase(note);
        return params;
      }
      nlohmann::json message = json_line();
      if (message.is_null()) return message;
      notifications.push_back(std::move(message));
    }
  }
  void close() { socket_.close(); }
  void end_writing() { socket_.shutdown(asio::socket_base::shutdown_send); }
  [[nodiscard]] bool timed_out() const { return timed_out_; }

  std::vector<nlohmann::json> notifications;

 private:
  asio::io_context io_;
  asio::ip::tcp::socket socket_;
  std::string input_;
  int last_id_ = 0;
  bool timed_out_ = false;
};

}  // namespace rmac::gateway::fakes
