#pragma once

#include <asio.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <unordered_map>

#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// Where the appliance listens. A non-empty `socket` (path of a UNIX socket) wins over host and port.
struct Endpoint {
  std::string socket;
  std::string host = "127.0.0.1";
  std::uint16_t port = 7402;
};

[[nodiscard]] std::string to_string(const Endpoint& endpoint);

/// One JSON-RPC connection, newline framed. Everything runs on the caller's thread, inside `call` and `wait`: answers
/// and notifications are handed out there and nowhere else.
class Connection {
 public:
  using Answer = Result<nlohmann::json>;
  using AnswerHandler = std::function<void(const Answer&)>;
  using NotificationHandler = std::function<void(const std::string& topic, const nlohmann::json& params)>;

  [[nodiscard]] static Result<std::unique_ptr<Connection>> open(const Endpoint& endpoint);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() = default;

  /// Queues a request; `handler` gets its answer. A lost connection answers every open request with a failure.
  void send(const std::string& method, const nlohmann::json& params, AnswerHandler handler);
  [[nodiscard]] Answer call(const std::string& method, const nlohmann::json& params = nlohmann::json::object());
  /// The same where the answer says no more than that it is done.
  [[nodiscard]] Result<> command(const std::string& method, const nlohmann::json& params = nlohmann::json::object());
  void on_notification(NotificationHandler handler) { notify_ = std::move(handler); }

  /// Calls `handler` for each line that a person enters at `terminal`, a descriptor that stays the caller's; none: for
  /// no line any more.
  void on_entered_line(std::optional<int> terminal, std::function<void(const std::string& line)> handler);

  /// Handles what arrives until `done` holds. Fails when the connection is lost or the person presses Ctrl-C.
  [[nodiscard]] Result<> wait(const std::function<bool()>& done);
  /// The same with a bound; whether `done` held by then.
  [[nodiscard]] Result<bool> wait(const std::function<bool()>& done, std::chrono::milliseconds bound);

  /// A person asked to end by Ctrl-C; `wait` says so once, then goes on when called again.
  [[nodiscard]] bool interrupted() const noexcept { return interrupted_; }

  /// What the appliance said of itself when greeted: name, version, limits.
  [[nodiscard]] const nlohmann::json& greeting() const noexcept { return greeting_; }

 private:
  using Socket = asio::generic::stream_protocol::socket;

  explicit Connection(Endpoint endpoint);
  void read();
  void write();
  void take(std::string_view line);
  void lose(const std::string& why);
  void read_terminal();

  Endpoint endpoint_;
  asio::io_context io_;
  Socket socket_{io_};
  asio::signal_set signals_{io_, SIGINT, SIGTERM};
  asio::steady_timer timer_{io_};
  asio::posix::stream_descriptor terminal_{io_};
  asio::streambuf entered_;
  std::function<void(const std::string&)> entered_line_;
  std::string input_;
  std::deque<std::string> output_;
  std::unordered_map<std::int64_t, AnswerHandler> open_;
  NotificationHandler notify_;
  nlohmann::json greeting_;
  std::int64_t next_id_ = 1;
  std::string lost_;
  bool interrupted_ = false;
  bool interruption_told_ = false;
};

}  // namespace rmac::cli
