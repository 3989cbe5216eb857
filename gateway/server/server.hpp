#pragma once

#include <asio.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "gateway/api/dispatch/dispatcher.hpp"
#include "gateway/server/lease.hpp"

namespace rmac::gateway {

class Connection;

/// What losing the lease does to a machine that runs (IEC 60204-1, 9.2.2).
enum class LeaseLostAction {
  Stop,            ///< category 2: comes to rest on the path, power stays
  StopAndPowerOff  ///< category 1: comes to rest, then the mechanism is taken out, which disables its drives
};

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< loopback: clients are not authenticated
  std::uint16_t port = 7402;          ///< 0: the system picks a free one
  std::filesystem::path unix_socket;  ///< empty: none
  double cycle_hz = 1000;
  int queue_capacity = 10'000;    ///< told to clients
  bool throttle_machine = false;  ///< virtual time: wait for slow watchers instead of cutting them off
  LeaseLostAction lease_lost = LeaseLostAction::Stop;
  std::chrono::milliseconds lease_timeout{0};  ///< silence of its holder that ends the lease; 0: none
  std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;  ///< of the lease
  std::size_t line_limit_bytes = std::size_t{8} << 20;
  std::size_t pending_limit_bytes = std::size_t{32} << 20;  ///< of requests that wait, before reading pauses
  std::size_t output_limit_bytes = std::size_t{64} << 20;   ///< unread output, before the client is cut off
  std::size_t high_water_bytes = std::size_t{4} << 20;      ///< unread output, before virtual time waits
  std::chrono::milliseconds queue_wait{1000};               ///< for room in a full queue of moves
  std::chrono::milliseconds stall_limit{10'000};            ///< of a watcher that virtual time waits for
  std::size_t connection_limit = 64;
};

/// The sockets of the gateway: newline JSON-RPC over TCP and a UNIX socket. Everything runs on the thread of the
/// io_context, except what would keep it from the next stop for long: reading a long line, decoding and building a
/// large move, searching the database, changing the mechanism. That runs on one thread beside it, one piece at a time.
class Server {
 public:
  using MakeRecords = std::function<std::unique_ptr<RecordCursor>()>;

  Server(asio::io_context& io, MachinePort& machine, MakeRecords make_records, ServerOptions options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] Expected<> listen();
  /// The TCP port in use.
  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
  [[nodiscard]] std::size_t connection_count() const noexcept { return connections_.size(); }
  /// Stops listening and closes every connection. The lease is dropped without a stop: the machine's end is the
  /// caller's business.
  void close();
  /// The daemon ends: stops the machine as a lost lease does, and no client gets authority any more.
  void retire();
  /// Lets every client go once it has been sent what it was told so far.
  void dismiss();

  /// Listeners for the controller's reports.
  void on_sample(const CycleSample& sample);
  void on_event(const Event& event);
  /// False while a watcher is too far behind for virtual time to go on; the caller then leaves the controller's
  /// samples where they are.
  [[nodiscard]] bool may_dispatch() const noexcept;
  /// After each dispatch, every few milliseconds: sends batches, retries moves that wait for room.
  void tick();

  // For connections.
  [[nodiscard]] Dispatcher& dispatcher() noexcept { return dispatcher_; }
  [[nodiscard]] const ServerOptions& options() const noexcept { return options_; }
  [[nodiscard]] const Lease& lease() const noexcept { return lease_; }
  [[nodiscard]] std::unique_ptr<RecordCursor> make_records() const { return make_records_(); }
  /// Another connection that receives more than the watchers' rate, or nullptr.
  [[nodiscard]] const Connection* fast_watcher_beside(const Connection& connection) const;
  [[nodiscard]] tl::expected<nlohmann::json, RpcError> acquire_lease(const Connection& connection);
  /// A sign of life of a connection.
  void heard(const Connection& connection);
  /// Releases the lease of a connection that gave it back or went away, stops the machine and empties its queue: the
  /// next holder starts what they sent themselves, and nothing else.
  void lose_lease(const Connection& connection, const char* why);
  /// A stop took effect: what was sent before it on any connection and may start motion must not run after it. Of the
  /// stop's own connection that is what stands before `position` of its input.
  void overtake(const Connection& stopper, const Request& stop, std::uint64_t position);
  /// Work that needs nothing of the gateway, on the thread beside it; `done` runs back on the gateway thread.
  void run_aside(std::function<void()> work, std::function<void()> done);
  /// Carries a slow request out on the thread beside the gateway's. Until it is done the gateway carries out nothing
  /// but stops, so that the machine still has one user besides them. `done` tells whether the answer is final.
  void carry_out_aside(const Request& request, Connection& connection, std::function<bool(Answer)> done);
  /// Likewise what it needs before it has the machine; `done` is told where that failed. Samples go on meanwhile.
  void prepare_aside(const Request& request, Connection& connection, std::function<bool(std::optional<Answer>)> done);
  [[nodiscard]] bool machine_is_away() const noexcept { return machine_away_; }
  /// Whether the request that has the machine may change its mechanism: then the controller may not be dispatched, nor
  /// the mechanism be read.
  [[nodiscard]] bool mechanism_changes() const noexcept { return mechanism_changes_; }
  void announce(Event::Kind kind, std::string message);
  void forget(const Connection& connection);

 private:
  void take_machine_aside(const Connection& connection, std::function<void(MachineStatus&)> work,
                          std::function<bool()> done);
  template <typename Acceptor>
  void accept(Acceptor& acceptor, const char* what);
  [[nodiscard]] Expected<> listen_tcp();
  [[nodiscard]] Expected<> listen_unix();
  void welcome(asio::generic::stream_protocol::socket socket, const char* what);
  /// The lease ended, as `message` begins to tell: stops the machine, drops its queue.
  void stop_for_lease(std::string message);
  void power_off_at_rest();
  void end_silent_lease();
  /// Lets every connection carry out what waits there.
  void pump();

  asio::io_context& io_;
  Dispatcher dispatcher_;
  MakeRecords make_records_;
  ServerOptions options_;
  Lease lease_;
  asio::ip::tcp::acceptor tcp_;
  asio::local::stream_protocol::acceptor unix_;
  std::map<std::uint64_t, std::shared_ptr<Connection>> connections_;
  std::uint64_t next_id_ = 1;
  std::uint16_t port_ = 0;
  bool listens_on_unix_ = false;  ///< so the socket's file is ours to remove
  asio::thread_pool aside_{1};
  bool machine_away_ = false;  ///< a slow request has it
  bool mechanism_changes_ = false;
  std::uint64_t served_aside_ = 0;  ///< id of the connection whose slow request it is, or was last
  int dropped_moves_ = 0;           ///< when the lease ended last
  bool retired_ = false;
  bool power_off_pending_ = false;
  bool power_off_refused_ = false;  ///< and it was said
};

}  // namespace rmac::gateway
