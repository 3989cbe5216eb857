#include "modbus/open_line.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace rmac::fieldbus::modbus {
namespace {

// What libmodbus 3.1.6 knows; at any other rate it opens the line at 9600 and says so on stderr alone.
constexpr std::array kBitRates{1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800, 500000, 921600};

struct FreeAddresses {
  void operator()(addrinfo* list) const noexcept { freeaddrinfo(list); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

/// The one address that a numeric address means; null where it is not numeric.
Addresses resolve(const TcpEndpoint& endpoint) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(endpoint.port);
  return getaddrinfo(endpoint.address.c_str(), port.c_str(), &hints, &found) == 0 ? Addresses(found) : nullptr;
}

/// libmodbus waits in select(), whose sets end at FD_SETSIZE; beyond it, it would write over its own stack.
bool selectable(int descriptor) noexcept {
  return descriptor < FD_SETSIZE;
}

/// Waits until a connection that is under way stands: 0 or an errno.
int finish_connecting(int descriptor, std::chrono::milliseconds deadline) noexcept {
  const auto until = Clock::now() + deadline;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    pollfd wanted{descriptor, POLLOUT, 0};
    const int ready = poll(&wanted, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (ready > 0) break;
    if (ready == 0) return ETIMEDOUT;
    if (errno != EINTR) return errno;
  }
  int error = 0;
  socklen_t size = sizeof(error);
  return getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

int open_tcp(modbus_t* context, const TcpEndpoint& endpoint, std::chrono::milliseconds deadline) {
  const Addresses address = resolve(endpoint);
  if (!address) return EADDRNOTAVAIL;
  const int descriptor = socket(address->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return errno;
  int error = selectable(descriptor) ? 0 : EMFILE;
  if (error == 0 && connect(descriptor, address->ai_addr, address->ai_addrlen) != 0) {
    error = errno == EINPROGRESS ? finish_connecting(descriptor, deadline) : errno;
  }
  if (error != 0) {
    close(descriptor);
    return error;
  }
  const int on = 1;
  static_cast<void>(setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on)));
  modbus_set_socket(context, descriptor);
  return 0;
}

int open_rtu(modbus_t* context) noexcept {
  if (modbus_connect(context) != 0) return errno != 0 ? errno : EIO;
  const int descriptor = modbus_get_socket(context);
  static_cast<void>(fcntl(descriptor, F_SETFD, FD_CLOEXEC));
  if (selectable(descriptor)) return 0;
  modbus_close(context);
  return EMFILE;
}

}  // namespace

std::string check(const Endpoint& endpoint) {
  if (const auto* tcp = std::get_if<TcpEndpoint>(&endpoint)) {
    if (!resolve(*tcp)) {
      return fmt::format("\"{}\" is no numeric IP address, for example 192.168.1.20; names are not looked up",
                         tcp->address);
    }
    return tcp->port != 0 ? std::string() : "port 0 cannot be connected to; Modbus has 502";
  }
  const auto& rtu = std::get<RtuEndpoint>(endpoint);
  if (rtu.device.empty()) return "no serial device is named";
  if (std::find(kBitRates.begin(), kBitRates.end(), rtu.bit_rate) == kBitRates.end()) {
    std::string rates;
    for (const int rate : kBitRates) rates += fmt::format("{}{}", rates.empty() ? "" : ", ", rate);
    return fmt::format("bit rate {}; there are {}", rtu.bit_rate, rates);
  }
  if (rtu.parity != 'N' && rtu.parity != 'E' && rtu.parity != 'O') {
    return fmt::format("parity '{}'; there are N (none), E (even) and O (odd)", rtu.parity);
  }
  if (rtu.stop_bits != 1 && rtu.stop_bits != 2) return fmt::format("{} stop bits; there are 1 and 2", rtu.stop_bits);
  return {};
}

Context make_context(const Endpoint& endpoint) {
  if (const auto* tcp = std::get_if<TcpEndpoint>(&endpoint)) {
    return Context(modbus_new_tcp_pi(tcp->address.c_str(), std::to_string(tcp->port).c_str()));
  }
  const auto& rtu = std::get<RtuEndpoint>(endpoint);
  return Context(modbus_new_rtu(rtu.device.c_str(), rtu.bit_rate, rtu.parity, 8, rtu.stop_bits));
}

int open_line(modbus_t* context, const Endpoint& endpoint, std::chrono::milliseconds deadline) noexcept {
  if (const auto* tcp = std::get_if<TcpEndpoint>(&endpoint)) return open_tcp(context, *tcp, deadline);
  return open_rtu(context);
}

void close_line(modbus_t* context, const Endpoint& endpoint) noexcept {
  const int descriptor = modbus_get_socket(context);
  if (descriptor < 0) return;
  if (std::holds_alternative<RtuEndpoint>(endpoint)) static_cast<void>(tcflush(descriptor, TCIOFLUSH));
  modbus_close(context);
  modbus_set_socket(context, -1);
}

}  // namespace rmac::fieldbus::modbus
