#pragma once

#include <array>
#include <asio.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "gateway/requests/request_queue.hpp"
#include "gateway/requests/requester.hpp"
#include "gateway/server/admission.hpp"
#include "gateway/server/connection_context.hpp"
#include "gateway/server/line_reader.hpp"
#include "gateway/server/outbox.hpp"
#include "gateway/server/session.hpp"
#include "gateway/server/subscriptions.hpp"

namespace rmac::gateway {

/// The socket of one client, open until what both sides have to say is said: lines come in to its requests, answers and
/// pushed topics go out. Gateway thread.
class Connection final : public Requester, public std::enable_shared_from_this<Connection> {
 public:
  using Socket = asio::generic::stream_protocol::socket;

  /// Who came: `where` tells it from others that give no name, `peer` is the user or address it comes from.
  struct Visitor {
    std::uint64_t id = 0;
    std::string where, peer;
  };

  Connection(const ConnectionContext& context, Socket socket, Visitor visitor);

  /// `only_stops`: why it may do nothing but stop the machine, where it may not.
  void start(std::optional<std::string> only_stops);
  /// Closes at once; nothing more is written.
  void abort();
  /// Drops what it sent, tells it why, and closes once it has read that, or some seconds have passed.
  void refuse_and_leave(RpcError error);
  /// Closes once everything that was to be sent is sent, or some seconds have passed.
  void dismiss();

  void push_sample(const CycleSample& sample);
  void push_event(const std::string& line);
  /// Sends the batches that `push_sample` collected.
  void flush_topics();

  [[nodiscard]] std::string name() const { return session_.name(); }
  [[nodiscard]] Guest guest() const;
  /// Whether it has much to read.
  [[nodiscard]] bool behind() const noexcept;
  /// Behind for longer than the limit, without reading a byte.
  [[nodiscard]] bool stalled(std::chrono::steady_clock::time_point now) const noexcept;
  /// Bytes that the client has sent so far, read by us or not.
  [[nodiscard]] std::uint64_t arrived_bytes() const;
  /// What waits for its answer.
  [[nodiscard]] RequestQueue& requests() noexcept { return requests_; }

  // What its requests see of it.
  [[nodiscard]] SessionPort& session() override { return session_; }
  [[nodiscard]] std::uint64_t id() const noexcept override { return session_.id(); }
  void send(std::string line) override;
  [[nodiscard]] bool stays() const noexcept override { return phase_ == Phase::Open; }
  void has_stopped(const Request& stop, std::uint64_t position) override;
  void pump() override;
  [[nodiscard]] std::shared_ptr<void> hold() override { return shared_from_this(); }

 private:
  enum class Phase {
    Open,      ///< reads and writes
    Draining,  ///< the client ended its side: what it sent is answered, then closed
    Leaving,   ///< refused for good: the last answer is written, input is thrown away
    Closed
  };

  void read();
  void arrived(asio::error_code problem, std::size_t bytes);
  void take_input(std::size_t bytes);
  void take_line(const LineReader::Line& line);
  void end_of_input();
  void discard_input();
  void leave_within(std::chrono::seconds bound);
  void write();
  void finish_if_drained();

  const ConnectionContext& context_;
  Socket socket_;
  Subscriptions topics_;
  Session session_;
  RequestQueue requests_;
  LineReader lines_;
  Outbox outbox_;
  Phase phase_ = Phase::Open;
  std::array<char, 65536> buffer_{};
  bool reading_ = false;
  std::string peer_;
  std::chrono::steady_clock::time_point came_;
  bool spoke_ = false;  ///< its first line was JSON
  bool only_stops_ = false;
  std::uint64_t read_bytes_ = 0;  ///< of the input so far
  std::size_t discarded_ = 0;
  bool pump_posted_ = false;
  asio::steady_timer leaving_;
};

}  // namespace rmac::gateway
