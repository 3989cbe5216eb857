#include "gateway/server/listeners.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace rmac::gateway {

namespace {

template <typename... Arguments>
tl::unexpected<Error> cannot(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  return failure(MinorCode::Other, fmt::format(format, std::forward<Arguments>(arguments)...));
}

std::string peer_of(const asio::ip::tcp::socket& socket) {
  asio::error_code gone;
  return socket.remote_endpoint(gone).address().to_string();
}

std::string peer_of(asio::local::stream_protocol::socket& socket) {
  ucred who{};
  socklen_t size = sizeof(who);
  if (getsockopt(socket.native_handle(), SOL_SOCKET, SO_PEERCRED, &who, &size) != 0) return "somebody unknown";
  return fmt::format("user {}", who.uid);
}

}  // namespace

Listeners::Listeners(asio::io_context& io, Welcome welcome)
    : io_(io), welcome_(std::move(welcome)), tcp_(io), unix_(io) {}

Expected<> Listeners::listen_on_tcp(const std::string& text, std::uint16_t port) {
  asio::error_code problem;
  const auto address = asio::ip::make_address(text, problem);
  if (problem) return cannot("{} is not an IP address", text);
  if (!address.is_loopback()) {
    return cannot("{} is not a loopback address: clients are not authenticated, so only this machine may connect",
                  text);
  }
  const asio::ip::tcp::endpoint endpoint(address, port);
  tcp_.open(endpoint.protocol(), problem);
  if (!problem) tcp_.set_option(asio::socket_base::reuse_address(true), problem);
  if (!problem) tcp_.bind(endpoint, problem);
  if (!problem) tcp_.listen(asio::socket_base::max_listen_connections, problem);
  if (problem) {
    return cannot("cannot listen on {}:{}: {}; is another rmacd running? choose another port with --port", text, port,
                  problem.message());
  }
  port_ = tcp_.local_endpoint().port();
  accept(tcp_, "TCP");
  return {};
}

Expected<> Listeners::listen_on_unix(const std::filesystem::path& path) {
  const asio::local::stream_protocol::endpoint endpoint(path.string());
  asio::error_code problem;
  // A socket file that nobody answers on is left over from a daemon that died; one that answers is in use.
  asio::local::stream_protocol::socket probe(io_);
  probe.connect(endpoint, problem);
  if (!problem) return cannot("another daemon listens on {}", path.string());
  std::error_code ignored;
  if (std::filesystem::is_socket(path, ignored)) std::filesystem::remove(path, ignored);
  problem = {};
  unix_.open(endpoint.protocol(), problem);
  if (!problem) unix_.bind(endpoint, problem);
  if (problem) return cannot("cannot listen on {}: {}", path.string(), problem.message());
  file_ = path;
  // Nobody can connect before it listens, and by then its permissions rule, whatever the umask.
  if (::chmod(path.c_str(), S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP) != 0) {
    return cannot("cannot give {} its permissions: {}", path.string(), std::strerror(errno));
  }
  unix_.listen(asio::socket_base::max_listen_connections, problem);
  if (problem) return cannot("cannot listen on {}: {}", path.string(), problem.message());
  accept(unix_, "UNIX socket");
  return {};
}

template <typename Acceptor>
void Listeners::accept(Acceptor& acceptor, const char* what) {
  acceptor.async_accept([this, &acceptor, what](asio::error_code problem, auto socket) {
    if (problem == asio::error::operation_aborted) return;
    if (!problem) {
      std::string peer = peer_of(socket);
      welcome_(std::move(socket), what, std::move(peer));
    } else {
      spdlog::warn("accepting a client failed: {}", problem.message());
    }
    accept(acceptor, what);
  });
}

void Listeners::stop() {
  asio::error_code ignored;
  tcp_.close(ignored);
  unix_.close(ignored);
}

void Listeners::close() {
  stop();
  if (file_.empty()) return;
  std::error_code gone;
  std::filesystem::remove(std::exchange(file_, {}), gone);
}

}  // namespace rmac::gateway
