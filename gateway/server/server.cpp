#include "gateway/server/server.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <functional>

#include "gateway/json/printable.hpp"
#include "gateway/server/connection.hpp"

namespace rmac::gateway {

Server::Server(asio::io_context& io, MachinePort& machine, MakeRecords make_records, ServerOptions options)
    : options_(std::move(options)),
      dispatcher_(machine),
      aside_(io, dispatcher_, [this] { pump(); }),
      lease_(dispatcher_, aside_, options_,
             [this](Event::Kind kind, std::string message) { announce(kind, std::move(message)); }),
      listeners_(io, [this](Listeners::Socket socket, const char* what,
                            std::string peer) { welcome(std::move(socket), what, std::move(peer)); }),
      context_{dispatcher_, aside_, lease_, operator_, *this, options_, std::move(make_records)} {}

Server::~Server() {
  close();
}

Expected<> Server::listen() {
  const auto tcp = options_.tcp ? listeners_.listen_on_tcp(options_.address, options_.port) : Expected<>{};
  if (!tcp || options_.unix_socket.empty()) return tcp;
  return listeners_.listen_on_unix(options_.unix_socket);
}

void Server::welcome(Listeners::Socket socket, const char* what, std::string peer) {
  std::vector<Guest> guests;
  guests.reserve(connections_.size());
  for (const auto& [id, connection] : connections_) guests.push_back(connection->guest());
  Admission admission = admit(guests, peer, options_);
  if (admission.gives_way) {
    const auto leaves = connections_.at(*admission.gives_way);
    spdlog::warn("{} gives way to another client: it has {}", leaves->name(),
                 admission.only_stops ? "one of the places for stops" : "sent nothing");
    leaves->abort();
  }
  const std::uint64_t id = next_id_++;
  const std::string where = fmt::format("{} client {}", what, id);
  if (admission.only_stops) spdlog::warn("{} may do nothing but stop: {}", where, *admission.only_stops);
  auto connection =
      std::make_shared<Connection>(context_, std::move(socket), Connection::Visitor{id, where, std::move(peer)});
  connections_.emplace(id, connection);
  connection->start(std::move(admission.only_stops));
}

void Server::close() {
  listeners_.close();
  const auto open = std::move(connections_);
  connections_.clear();
  for (const auto& [id, connection] : open) {
    lease_.drop(id);
    connection->abort();
  }
  aside_.stop();
}

void Server::dismiss() {
  listeners_.stop();
  const auto open = connections_;  // those with nothing left to send leave the map at once
  for (const auto& [id, connection] : open) connection->dismiss();
}

void Server::pump() {
  // Connections may leave the map while they are pumped, so the loop runs over a copy of their pointers. It begins
  // after the one whose slow request had the machine last: a client that sends many must let others in between.
  std::vector<std::shared_ptr<Connection>> open;
  open.reserve(connections_.size());
  for (const auto& [id, connection] : connections_) open.push_back(connection);
  const auto next =
      std::ranges::find_if(open, [this](const auto& entry) { return entry->id() > aside_.last_served(); });
  std::rotate(open.begin(), next, open.end());
  for (const auto& connection : open) connection->pump();
}

void Server::on_sample(const CycleSample& sample) {
  for (const auto& [id, connection] : connections_) connection->push_sample(sample);
}

void Server::on_event(const Event& event) {
  if (event.code != MinorCode::None) {
    dispatcher_.status().fail(event.code, event.message, event.t_s);
  } else if (event.kind == Event::Kind::Fault) {
    dispatcher_.status().fail(MinorCode::Other, event.message, event.t_s);
  }
  const std::string line = event_notification(event);
  for (const auto& [id, connection] : connections_) connection->push_event(line);
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

bool Server::may_dispatch() const noexcept {
  return !options_.throttle_machine ||
         std::ranges::none_of(connections_, [](const auto& entry) { return entry.second->behind(); });
}

void Server::tick() {
  const auto now = std::chrono::steady_clock::now();
  const auto open = connections_;  // those that are cut off leave the map
  for (const auto& [id, connection] : open) {
    connection->flush_topics();
    if (overstays(connection->guest(), now, options_)) {
      spdlog::info("{} is disconnected: it has no business here after {} ms", connection->name(),
                   options_.silence_limit.count());
      connection->abort();
    } else if (connection->stalled(now)) {
      spdlog::warn("{} was cut off: it has not read for {} ms", connection->name(), options_.stall_limit.count());
      connection->abort();
    }
  }
  bound_memory();
  pump();
  end_silent_lease();
  lease_.power_off_at_rest();
}

void Server::bound_memory() {
  std::vector<Guest> guests;
  std::size_t held = 0;
  for (const auto& [id, connection] : connections_) held += guests.emplace_back(connection->guest()).held_bytes;
  if (held <= options_.memory_limit_bytes) return;
  std::ranges::sort(guests, std::greater{}, &Guest::held_bytes);
  for (const Guest& greediest : guests) {
    if (held <= options_.memory_limit_bytes) return;
    held -= greediest.held_bytes;
    cut_off(greediest);
  }
}

void Server::cut_off(const Guest& greediest) {
  const std::shared_ptr<Connection> connection = connections_.at(greediest.id);  // leaving takes it out of the map
  const std::string why = fmt::format(
      "what it sent and does not read takes {} KiB, more than any other's; all clients together may take {} "
      "KiB",
      greediest.held_bytes >> 10U, options_.memory_limit_bytes >> 10U);
  if (greediest.unread_bytes < greediest.held_bytes / 2) {
    connection->refuse_and_leave({rpc_code::kRequestTooLarge, why + "; send smaller requests", MinorCode::Other});
  } else {
    spdlog::warn("{} was cut off: {}", connection->name(), why);
    connection->abort();
  }
}

void Server::end_silent_lease() {
  if (!lease_.overdue()) return;
  // A holder that waits for an answer is not silent: we are.
  const auto holder = std::ranges::find_if(
      connections_, [&](const auto& entry) { return lease_.held_by(entry.first) && entry.second->requests().empty(); });
  if (holder != connections_.end()) {
    lease_.lose(holder->first, holder->second->name(), "was silent for too long and lost");
  }
}

void Server::overtake(std::uint64_t who, const std::string& name, const Request& stop, std::uint64_t position) {
  const std::string what = fmt::format("{} of {}", stop.method->name, name);
  for (const auto& [id, connection] : connections_) {
    connection->requests().stopped(stop.effect(), what, id == who ? position : connection->arrived_bytes());
  }
}

std::optional<std::string> Server::fast_watcher_beside(std::uint64_t who) const {
  for (const auto& [id, other] : connections_) {
    if (id != who && other->guest().fast) return other->name();
  }
  return std::nullopt;
}

void Server::forget(std::uint64_t who) {
  connections_.erase(who);
}

}  // namespace rmac::gateway
