#pragma once

#include <asio.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "gateway/api/dispatch/dispatcher.hpp"
#include "gateway/requests/machine_aside.hpp"
#include "gateway/server/authority/operator_post.hpp"
#include "gateway/server/connection_context.hpp"
#include "gateway/server/lease_keeper.hpp"
#include "gateway/server/listeners.hpp"
#include "gateway/server/server_options.hpp"

namespace rmac::gateway {

class Connection;
struct Guest;

/// The sockets of the gateway: newline JSON-RPC over TCP and a UNIX socket. Everything runs on the thread of the
/// io_context, except what would keep it from the next stop for long: reading a long line, decoding and building a
/// large move, changing the mechanism, which run on one thread beside it, one piece at a time; and verifications and
/// searches of the database, on others.
class Server : private Peers {
 public:
  using MakeRecords = std::function<std::unique_ptr<RecordCursor>()>;

  Server(asio::io_context& io, MachinePort& machine, MakeRecords make_records, ServerOptions options);
  ~Server() override;
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] Expected<> listen();
  /// The TCP port in use.
  [[nodiscard]] std::uint16_t port() const noexcept { return listeners_.port(); }
  [[nodiscard]] std::size_t connection_count() const noexcept { return connections_.size(); }
  /// Stops listening and closes every connection. The lease is dropped without a stop: the machine's end is the
  /// caller's business.
  void close();
  /// The daemon ends: stops the machine as a lost lease does, and no client gets authority any more.
  void retire() { lease_.retire(); }
  /// Lets every client go once it has been sent what it was told so far.
  void dismiss();

  /// Listeners for the controller's reports.
  void on_sample(const CycleSample& sample);
  void on_event(const Event& event);
  void announce(Event::Kind kind, std::string message) override;
  /// False while a watcher is too far behind for virtual time to go on; the caller then leaves the controller's
  /// samples where they are.
  [[nodiscard]] bool may_dispatch() const noexcept;
  /// Whether the request that has the machine may change its mechanism: then the controller may not be dispatched, nor
  /// the mechanism be read.
  [[nodiscard]] bool mechanism_changes() const noexcept { return aside_.mechanism_changes(); }
  /// After each dispatch, every few milliseconds: sends batches, retries moves that wait for room.
  void tick();

 private:
  void welcome(Listeners::Socket socket, const char* what, std::string peer);
  void end_silent_lease();
  void cut_off(const Guest& greediest);
  /// Lets every connection carry out what waits there.
  void pump();

  void overtake(std::uint64_t who, const std::string& name, const Request& stop, std::uint64_t position) override;
  [[nodiscard]] std::optional<std::string> fast_watcher_beside(std::uint64_t who) const override;
  void bound_memory() override;
  void forget(std::uint64_t who) override;

  ServerOptions options_;
  Dispatcher dispatcher_;
  MachineAside aside_;
  LeaseKeeper lease_;
  OperatorPost operator_;
  Listeners listeners_;
  ConnectionContext context_;
  std::map<std::uint64_t, std::shared_ptr<Connection>> connections_;
  std::uint64_t next_id_ = 1;
};

}  // namespace rmac::gateway
