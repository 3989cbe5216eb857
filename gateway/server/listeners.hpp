#pragma once

#include <asio.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Where clients come in: a TCP port and a UNIX socket. Gateway thread.
class Listeners {
 public:
  using Socket = asio::generic::stream_protocol::socket;
  /// Told of each client, through what it came, and from where: a user, or an address.
  using Welcome = std::function<void(Socket socket, const char* what, std::string peer)>;

  Listeners(asio::io_context& io, Welcome welcome);

  /// Port 0: the system picks a free one.
  [[nodiscard]] Expected<> listen_on_tcp(const std::string& address, std::uint16_t port);
  [[nodiscard]] Expected<> listen_on_unix(const std::filesystem::path& path);
  /// The TCP port in use.
  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }

  /// No client comes in any more.
  void stop();
  /// Likewise, and removes the UNIX socket's file.
  void close();

 private:
  template <typename Acceptor>
  void accept(Acceptor& acceptor, const char* what);

  asio::io_context& io_;
  Welcome welcome_;
  asio::ip::tcp::acceptor tcp_;
  asio::local::stream_protocol::acceptor unix_;
  std::uint16_t port_ = 0;
  std::filesystem::path file_;  ///< of the UNIX socket, ours to remove; or empty
};

}  // namespace rmac::gateway
