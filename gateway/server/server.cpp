#include "gateway/server/server.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <algorithm>

#include "gateway/json/printable.hpp"
#include "gateway/server/connection.hpp"

namespace rmac::gateway {

namespace {

/// The server itself as holder of the lease, while it switches the drives off: no client may start anything then.
constexpr Lease::Holder kServerItself = ~Lease::Holder{0};

template <typename... Arguments>
tl::unexpected<Error> cannot(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  return failure(MinorCode::Other, fmt::format(format, std::forward<Arguments>(arguments)...));
}

}  // namespace

Server::Server(asio::io_context& io, MachinePort& machine, MakeRecords make_records, ServerOptions options)
    : io_(io),
      dispatcher_(machine),
      make_records_(std::move(make_records)),
      options_(std::move(options)),
      tcp_(io),
      unix_(io) {}

Server::~Server() {
  close();
}

Expected<> Server::listen() {
  return listen_tcp().and_then(
      [this]() -> Expected<> { return options_.unix_socket.empty() ? Expected<>{} : listen_unix(); });
}

Expected<> Server::listen_tcp() {
  asio::error_code problem;
  const auto address = asio::ip::make_address(options_.address, problem);
  if (problem) return cannot("{} is not an IP address", options_.address);
  if (!address.is_loopback()) {
    return cannot("{} is not a loopback address: clients are not authenticated, so only this machine may connect",
                  options_.address);
  }
  const asio::ip::tcp::endpoint endpoint(address, options_.port);
  tcp_.open(endpoint.protocol(), problem);
  if (!problem) tcp_.set_option(asio::socket_base::reuse_address(true), problem);
  if (!problem) tcp_.bind(endpoint, problem);
  if (!problem) tcp_.listen(asio::socket_base::max_listen_connections, problem);
  if (problem) {
    return cannot("cannot listen on {}:{}: {}; is another rmacd running? choose another port with --port",
                  options_.address, options_.port, problem.message());
  }
  port_ = tcp_.local_endpoint().port();
  accept(tcp_, "TCP");
  return {};
}

Expected<> Server::listen_unix() {
  const asio::local::stream_protocol::endpoint endpoint(options_.unix_socket.string());
  asio::error_code problem;
  // A socket file that nobody answers on is left over from a daemon that died; one that answers is in use.
  asio::local::stream_protocol::socket probe(io_);
  probe.connect(endpoint, problem);
  if (!problem) return cannot("another daemon listens on {}", options_.unix_socket.string());
  std::error_code ignored;
  if (std::filesystem::is_socket(options_.unix_socket, ignored)) std::filesystem::remove(options_.unix_socket, ignored);
  problem = {};
  unix_.open(endpoint.protocol(), problem);
  if (!problem) unix_.bind(endpoint, problem);
  if (!problem) unix_.listen(asio::socket_base::max_listen_connections, problem);
  if (problem) return cannot("cannot listen on {}: {}", options_.unix_socket.string(), problem.message());
  listens_on_unix_ = true;
  ::chmod(options_.unix_socket.c_str(), S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP);
  accept(unix_, "UNIX socket");
  return {};
}

template <typename Acceptor>
void Server::accept(Acceptor& acceptor, const char* what) {
  acceptor.async_accept([this, &acceptor, what](asio::error_code problem, auto socket) {
    if (problem == asio::error::operation_aborted) return;
    if (!problem) {
      welcome(std::move(socket), what);
    } else {
      spdlog::warn("accepting a client failed: {}", problem.message());
    }
    accept(acceptor, what);
  });
}

void Server::welcome(asio::generic::stream_protocol::socket socket, const char* what) {
  if (connections_.size() >= options_.connection_limit) {
    const std::string why = fmt::format("{} clients are connected, which is the limit", connections_.size());
    spdlog::warn("a client was turned away: {}", why);
    const std::string line =
        text_of(to_response(nullptr, tl::unexpected<RpcError>(
                                         RpcError{rpc_code::kInvalidRequest, why, MinorCode::UnsupportedOperation}))) +
        '\n';
    asio::error_code ignored;
    socket.write_some(asio::buffer(line), ignored);  // a new socket's buffer has room for one line
    return;
  }
  const std::uint64_t id = next_id_++;
  auto connection = std::make_shared<Connection>(*this, std::move(socket), id, fmt::format("{} client {}", what, id));
  connections_.emplace(id, connection);
  connection->start();
}

void Server::close() {
  asio::error_code ignored;
  tcp_.close(ignored);
  unix_.close(ignored);
  if (listens_on_unix_) {
    std::error_code gone;
    std::filesystem::remove(options_.unix_socket, gone);
  }
  const auto open = std::move(connections_);
  connections_.clear();
  for (const auto& [id, connection] : open) {
    lease_.release(id);
    connection->abort();
  }
  aside_.stop();
  aside_.join();
}

void Server::run_aside(std::function<void()> work, std::function<void()> done) {
  asio::post(aside_, [this, work = std::move(work), done = std::move(done)]() mutable {
    work();
    work = nullptr;
    asio::post(io_, std::move(done));
  });
}

void Server::pump() {
  // Connections may leave the map while they are pumped, so the loop runs over a copy of their pointers. It begins
  // after the one whose slow request had the machine last: a client that sends many must let others in between.
  std::vector<std::shared_ptr<Connection>> open;
  open.reserve(connections_.size());
  for (const auto& [id, connection] : connections_) open.push_back(connection);
  const auto next = std::ranges::find_if(open, [this](const auto& entry) { return entry->id() > served_aside_; });
  std::ranges::rotate(open, next);
  for (const auto& connection : open) connection->pump();
}

void Server::take_machine_aside(const Connection& connection, std::function<void(MachineStatus&)> work,
                                std::function<bool()> done) {
  served_aside_ = connection.id();
  machine_away_ = true;
  auto status = std::make_shared<MachineStatus>();
  run_aside([work = std::move(work), status] { work(*status); },
            [this, status, done = std::move(done)] {
              machine_away_ = mechanism_changes_ = false;
              if (status->major != 0) dispatcher_.status().fail(static_cast<MinorCode>(status->minor));
              // A move that must wait for room is tried again at the next tick, not at once.
              if (done()) pump();
            });
}

void Server::prepare_aside(const Request& request, Connection& connection,
                           std::function<bool(std::optional<Answer>)> done) {
  auto failed = std::make_shared<std::optional<Answer>>();
  take_machine_aside(
      connection,
      [this, &request, &connection, failed](MachineStatus& status) {
        *failed = dispatcher_.prepare(request, connection, status);
      },
      [failed, done = std::move(done)] { return done(std::move(*failed)); });
}

void Server::carry_out_aside(const Request& request, Connection& connection, std::function<bool(Answer)> done) {
  mechanism_changes_ = request.method->slow && request.effect() == Effect::Starts;
  auto answer = std::make_shared<Answer>();
  take_machine_aside(
      connection,
      [this, &request, &connection, answer](MachineStatus& status) {
        *answer = dispatcher_.carry_out(request, connection, status);
      },
      [answer, done = std::move(done)] { return done(std::move(*answer)); });
}

void Server::on_sample(const CycleSample& sample) {
  for (const auto& [id, connection] : connections_) connection->push_sample(sample);
}

void Server::on_event(const Event& event) {
  if (event.code != MinorCode::None) {
    dispatcher_.status().fail(event.code);
  } else if (event.kind == Event::Kind::Fault) {
    dispatcher_.status().fail(MinorCode::Other);
  }
  const std::string line = event_notification(event);
  for (const auto& [id, connection] : connections_) connection->push_event(line);
}

bool Server::may_dispatch() const noexcept {
  return !options_.throttle_machine ||
         std::ranges::none_of(connections_, [](const auto& entry) { return entry.second->behind(); });
}

void Server::tick() {
  const auto now = std::chrono::steady_clock::now();
  const auto open = connections_;  // those that are cut off leave the map
  for (const auto& [id, connection] : open) {
    connection->flush_topics();
    if (!connection->stalled(now)) continue;
    spdlog::warn("{} was cut off: it has not read for {} ms", connection->name(), options_.stall_limit.count());
    connection->abort();
  }
  pump();
  end_silent_lease();
  power_off_at_rest();
}

const Connection* Server::fast_watcher_beside(const Connection& connection) const {
  for (const auto& [id, other] : connections_) {
    if (id != connection.id() && other->watches_fast()) return other.get();
  }
  return nullptr;
}

tl::expected<nlohmann::json, RpcError> Server::acquire_lease(const Connection& connection) {
  const bool had = lease_.held_by(connection.id());
  return lease_.acquire(connection.id(), connection.name()).map([&]() -> nlohmann::json {
    lease_.heard(options_.now());
    const int dropped = had ? 0 : std::exchange(dropped_moves_, 0);
    if (!had) announce(Event::Kind::Authority, connection.name() + " took motion authority");
    return {{"timeout_s", std::chrono::duration<double>(options_.lease_timeout).count()}, {"dropped_moves", dropped}};
  });
}

void Server::heard(const Connection& connection) {
  if (lease_.held_by(connection.id())) lease_.heard(options_.now());
}

void Server::end_silent_lease() {
  if (options_.lease_timeout.count() == 0 || lease_.silence(options_.now()) <= options_.lease_timeout) return;
  // A holder that waits for an answer is not silent: we are.
  const auto holder = std::ranges::find_if(
      connections_, [&](const auto& entry) { return lease_.held_by(entry.first) && !entry.second->waits(); });
  if (holder != connections_.end()) lose_lease(*holder->second, "was silent for too long and lost");
}

void Server::overtake(const Connection& stopper, const Request& stop, std::uint64_t position) {
  const std::string what = fmt::format("{} of {}", stop.method->name, stopper.name());
  for (const auto& [id, connection] : connections_) {
    connection->stopped(stop.effect(), what, id == stopper.id() ? position : connection->arrived_bytes());
  }
}

void Server::lose_lease(const Connection& connection, const char* why) {
  if (lease_.release(connection.id())) stop_for_lease(fmt::format("{} {} motion authority", connection.name(), why));
}

void Server::retire() {
  retired_ = true;
  lease_ = {};
  stop_for_lease("rmacd ends and takes motion authority");
  lease_ = {};
  static_cast<void>(lease_.acquire(kServerItself, "rmacd, which is ending,"));
}

void Server::dismiss() {
  asio::error_code ignored;
  tcp_.close(ignored);
  unix_.close(ignored);
  const auto open = connections_;  // those with nothing left to send leave the map at once
  for (const auto& [id, connection] : open) connection->dismiss();
}

void Server::stop_for_lease(std::string message) {
  MachinePort& machine = dispatcher_.machine();
  // The sample may be a cycle old: a start that came along with the goodbye is not in it, but the cam knows.
  const CycleSample sample = machine.sample();
  const bool runs = sample.state == CycleState::Running || sample.state == CycleState::Holding || sample.moving ||
                    machine.cam().cycle().started();
  dropped_moves_ = machine.cam().queue().moves_left();
  const bool power_off = runs && options_.lease_lost == LeaseLostAction::StopAndPowerOff;
  // A move that is being built now must find that its queue is gone, too.
  const Expected<> stopped =
      runs || dropped_moves_ > 0 || machine_away_ ? machine.cam().cycle().stop_now() : machine.cam().cycle().stop();
  if (!stopped) {
    message += "; stopping failed: " + stopped.error().message;
    dispatcher_.status().fail(stopped.error().code);
  } else if (runs) {
    message += "; the machine is stopped on its path";
  }
  if (dropped_moves_ > 0) message += fmt::format("; {} queued moves are dropped", dropped_moves_);
  if (power_off) {
    message += ", then its drives are switched off";
    power_off_pending_ = true;
    static_cast<void>(lease_.acquire(kServerItself, "rmacd, which is switching the drives off after a lost lease,"));
  }
  spdlog::info("{}", message);
  announce(Event::Kind::Authority, std::move(message));
}

void Server::power_off_at_rest() {
  if (!power_off_pending_ || machine_away_) return;
  MachinePort& machine = dispatcher_.machine();
  const CycleSample sample = machine.sample();
  if (sample.moving || sample.state == CycleState::Running || sample.state == CycleState::Stopping) return;
  // Tried again at every tick: the controller may still be emptying its queue.
  if (machine.mechanism() != nullptr) {
    if (const auto unloaded = machine.device().unload(); !unloaded) {
      if (!power_off_refused_)
        announce(Event::Kind::Fault, "the drives are not switched off yet: " + unloaded.error().message);
      power_off_refused_ = true;
      return;
    }
  }
  power_off_refused_ = false;
  power_off_pending_ = false;
  if (!retired_) lease_.release(kServerItself);
  spdlog::info("the drives are switched off after a lost lease");
  announce(Event::Kind::Authority, "the drives are switched off; motion authority is free");
}

void Server::announce(Event::Kind kind, std::string message) {
  Event event;
  event.kind = kind;
  const CycleSample now = dispatcher_.machine().sample();
  event.t_s = now.t_s;
  event.cycle = now.cycle;
  event.message = std::move(message);
  on_event(event);
}

void Server::forget(const Connection& connection) {
  connections_.erase(connection.id());
}

}  // namespace rmac::gateway
