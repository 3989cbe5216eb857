#include "gateway/simulators/vmodbus/endpoints.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace rmac::vmodbus {
namespace {

tl::unexpected<Error> refuse(const std::string& what) {
  const int reason = errno;
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("{}: {}", what, std::generic_category().message(reason)));
}

void make_nonblocking(int descriptor) {
  fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) | O_NONBLOCK);
}

speed_t speed_of(int bit_rate) {
  switch (bit_rate) {
    case 1200:
      return B1200;
    case 2400:
      return B2400;
    case 4800:
      return B4800;
    case 9600:
      return B9600;
    case 19200:
      return B19200;
    case 38400:
      return B38400;
    case 57600:
      return B57600;
    case 115200:
      return B115200;
    default:
      return B0;
  }
}

}  // namespace

Endpoints::~Endpoints() {
  if (listener_ >= 0) close(listener_);
  for (const int end : other_ends_) close(end);
  for (const std::string& link : links_) unlink(link.c_str());
}

Expected<int> Endpoints::listen(const std::string& address, int port) {
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int on = 1;
  setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &at.sin_addr) != 1) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("\"{}\" is no IPv4 address", address));
  }
  socklen_t size = sizeof at;
  auto* const general = reinterpret_cast<sockaddr*>(&at);
  constexpr int kWaiting = 8;
  if (bind(listener_, general, size) != 0 || ::listen(listener_, kWaiting) != 0 ||
      getsockname(listener_, general, &size) != 0) {
    return refuse(fmt::format("port {} of {} cannot be listened on", port, address));
  }
  return ntohs(at.sin_port);
}

Expected<> Endpoints::open_pseudo_terminal(const std::string& path) {
  int ours = -1, theirs = -1;
  if (openpty(&ours, &theirs, nullptr, nullptr, nullptr) != 0) return refuse("no pseudo-terminal could be made");
  termios raw{};
  tcgetattr(theirs, &raw);
  cfmakeraw(&raw);
  tcsetattr(theirs, TCSANOW, &raw);
  make_nonblocking(ours);
  lines_.emplace_back(ours, Framing::Rtu, devices_);
  other_ends_.push_back(theirs);
  if (symlink(ttyname(theirs), path.c_str()) != 0) return refuse(path + " cannot be made a link to a pseudo-terminal");
  links_.push_back(path);
  return {};
}

Expected<> Endpoints::open_serial(const SerialSettings& settings) {
  const speed_t speed = speed_of(settings.bit_rate);
  if (speed == B0) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{} bit/s is none of the rates 1200 to 115200 that are in use", settings.bit_rate));
  }
  const int port = open(settings.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  termios how{};
  if (port < 0 || tcgetattr(port, &how) != 0) {
    const auto refused = refuse(settings.device + " cannot be opened as a serial port");
    if (port >= 0) close(port);
    return refused;
  }
  cfmakeraw(&how);
  how.c_cflag |= CLOCAL | CREAD;
  if (settings.parity != 'N') how.c_cflag |= PARENB;
  if (settings.parity == 'O') how.c_cflag |= PARODD;
  if (settings.stop_bits == 2) how.c_cflag |= CSTOPB;
  cfsetispeed(&how, speed);
  cfsetospeed(&how, speed);
  tcsetattr(port, TCSANOW, &how);
  lines_.emplace_back(port, Framing::Rtu, devices_);
  return {};
}

void Endpoints::accept_all() {
  for (;;) {
    const int connection = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (connection < 0) return;
    const int on = 1;
    setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);  // a drip is to be seen byte by byte
    lines_.emplace_back(connection, Framing::Tcp, devices_);
  }
}

void Endpoints::serve(std::chrono::milliseconds duration) {
  const auto until = Clock::now() + duration;
  do {
    std::vector<pollfd> waits;
    if (listener_ >= 0) waits.push_back({listener_, POLLIN, 0});
    for (const Line& line : lines_) waits.push_back({line.descriptor(), POLLIN, 0});
    poll(waits.data(), waits.size(), 1);
    std::size_t i = 0;
    if (listener_ >= 0 && waits[i++].revents != 0) accept_all();
    // Connections that were accepted just now stand behind those that were waited for.
    for (auto line = lines_.begin(); line != lines_.end();) {
      const bool came = i < waits.size() && waits[i++].revents != 0;
      const bool there = (!came || line->receive()) && line->proceed();
      line = there ? std::next(line) : lines_.erase(line);
    }
  } while (Clock::now() < until);
}

}  // namespace rmac::vmodbus
