#include "unit/fieldbus/modbus/modbus_peer.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace rmac::fieldbus::modbus {
namespace {

constexpr std::size_t kTcpHeader = 6;  // transaction, protocol, length

/// Bytes of a request's function and data beyond slave and function, as far as the first four data bytes tell.
std::size_t rest_of_request(std::uint8_t function) {
  return function == 15 || function == 16 ? 5 : 4;
}

}  // namespace

std::uint16_t modbus_crc(const Bytes& bytes) {
  std::uint16_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>(crc ^ byte);
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<std::uint16_t>((crc & 1U) != 0 ? crc >> 1U ^ 0xA001U : crc >> 1U);
    }
  }
  return crc;
}

ModbusPeer::ModbusPeer(Wire wire) : wire_(wire), end_(eventfd(0, EFD_CLOEXEC)) {
  if (wire == Wire::Tcp) {
    listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    if (bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(listener_, 8) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      throw std::runtime_error("no port to listen on");
    }
    port_ = ntohs(address.sin_port);
  } else {
    listener_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    std::array<char, 64> name{};
    if (listener_ < 0 || grantpt(listener_) != 0 || unlockpt(listener_) != 0 ||
        ptsname_r(listener_, name.data(), name.size()) != 0) {
      throw std::runtime_error("no pseudo-terminal");
    }
    device_ = name.data();
    // Kept open, so that the terminal stays while the client closes and opens it.
    slave_side_ = open(device_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios raw{};
    tcgetattr(slave_side_, &raw);
    cfmakeraw(&raw);
    tcsetattr(slave_side_, TCSANOW, &raw);
  }
  thread_ = std::thread([this] { run(); });
}

ModbusPeer::~ModbusPeer() {
  vanish();
}

void ModbusPeer::vanish() {
  if (!thread_.joinable()) return;
  const std::uint64_t one = 1;
  static_cast<void>(!write(end_, &one, sizeof(one)));
  thread_.join();
  close(listener_);
  if (slave_side_ >= 0) close(slave_side_);
  close(end_);
}

Endpoint ModbusPeer::endpoint() const {
  if (wire_ == Wire::Tcp) return TcpEndpoint{"127.0.0.1", port_};
  return RtuEndpoint{device_, 115200, 'N', 1};
}

void ModbusPeer::behave(Manner manner, std::chrono::microseconds pause) {
  pause_us_ = pause.count();
  manner_ = manner;
}

void ModbusPeer::respond(Responder responder) {
  const std::lock_guard lock(mutex_);
  responder_ = std::move(responder);
}

std::vector<Bytes> ModbusPeer::take_requests() {
  const std::lock_guard lock(mutex_);
  return std::exchange(seen_, {});
}

bool ModbusPeer::wait_for(const std::function<bool(const Bytes&)>& wanted) {
  std::unique_lock lock(mutex_);
  std::size_t looked_at = 0;
  return came_.wait_for(lock, std::chrono::minutes(1), [&] {
    for (; looked_at < seen_.size(); ++looked_at) {
      if (wanted(seen_[looked_at])) return true;
    }
    return false;
  });
}

bool ModbusPeer::wait_readable(int descriptor) {
  std::array<pollfd, 2> wanted{{{descriptor, POLLIN, 0}, {end_, POLLIN, 0}}};
  while (poll(wanted.data(), wanted.size(), -1) < 0) {
  }
  return wanted[1].revents == 0;
}

/// A pause is this peer's manner, not a wait for something: it ends early only where the test does.
bool ModbusPeer::pause_for(std::chrono::microseconds pause) {
  pollfd wanted{end_, POLLIN, 0};
  const timespec length{pause.count() / 1'000'000, pause.count() % 1'000'000 * 1000};
  return ppoll(&wanted, 1, &length, nullptr) == 0;
}

void ModbusPeer::run() {
  if (wire_ == Wire::Rtu) return serve(listener_);
  while (wait_readable(listener_)) {
    const int connection = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (connection < 0) continue;
    serve(connection);
    if (manner_ == Manner::Resetting) {
      const linger at_once{1, 0};
      setsockopt(connection, SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
    }
    close(connection);
  }
}

bool ModbusPeer::read_exactly(int descriptor, std::uint8_t* to, std::size_t count) {
  for (std::size_t have = 0; have < count;) {
    if (!wait_readable(descriptor)) return false;
    const ssize_t got = ::read(descriptor, to + have, count - have);
    if (got <= 0) return false;
    have += static_cast<std::size_t>(got);
  }
  return true;
}

std::optional<Bytes> ModbusPeer::read_request(int descriptor, Bytes& header) {
  header.resize(wire_ == Wire::Tcp ? kTcpHeader : 0);
  Bytes request(2);
  if (wire_ == Wire::Tcp) {
    if (!read_exactly(descriptor, header.data(), kTcpHeader)) return {};
    request.resize(static_cast<std::size_t>(header[4] << 8U | header[5]));
    return read_exactly(descriptor, request.data(), request.size()) ? std::optional(request) : std::nullopt;
  }
  if (!read_exactly(descriptor, request.data(), 2)) return {};
  const std::size_t more = rest_of_request(request[1]);
  request.resize(2 + more);
  if (!read_exactly(descriptor, request.data() + 2, more)) return {};
  const std::size_t data = more == 5 ? request.back() : 0;
  const std::size_t so_far = request.size();
  request.resize(so_far + data + 2);
  if (!read_exactly(descriptor, request.data() + so_far, data + 2)) return {};
  request.resize(so_far + data);
  return request;
}

void ModbusPeer::serve(int descriptor) {
  Bytes header;
  while (const auto request = read_request(descriptor, header)) {
    {
      const std::lock_guard lock(mutex_);
      seen_.push_back(*request);
    }
    ++requests_;
    came_.notify_all();
    if (!answer(descriptor, header, *request)) return;
  }
}

Bytes ModbusPeer::default_answer(const Bytes& request) const {
  const std::uint8_t function = request[1];
  if (function >= 5) return {request.begin(), request.begin() + 6};
  const std::size_t count = static_cast<std::size_t>(request[4] << 8U | request[5]);
  Bytes answer{request[0], function};
  if (function <= 2) {
    answer.push_back(static_cast<std::uint8_t>((count + 7) / 8));
    answer.resize(answer.size() + (count + 7) / 8, 0xFF);
    return answer;
  }
  answer.push_back(static_cast<std::uint8_t>(2 * count));
  for (std::size_t i = 0; i < count; ++i) {
    answer.push_back(static_cast<std::uint8_t>(requests_ >> 8U));
    answer.push_back(static_cast<std::uint8_t>(requests_));
  }
  return answer;
}

std::uint32_t ModbusPeer::next_noise() {
  return (noise_ = noise_ * 1664525U + 1013904223U) >> 16U;
}

Bytes ModbusPeer::frame(const Bytes& header, const Bytes& pdu) {
  Bytes whole = header;
  whole.insert(whole.end(), pdu.begin(), pdu.end());
  if (wire_ == Wire::Tcp) {
    std::size_t counted = pdu.size();
    while (manner_ == Manner::WrongLength && counted == pdu.size()) counted = next_noise() % 512;
    whole[4] = static_cast<std::uint8_t>(counted >> 8U);
    whole[5] = static_cast<std::uint8_t>(counted);
  } else {
    const std::uint16_t crc = modbus_crc(pdu);
    whole.push_back(static_cast<std::uint8_t>(crc));
    whole.push_back(static_cast<std::uint8_t>(crc >> 8U));
  }
  return whole;
}

bool ModbusPeer::answer(int descriptor, const Bytes& header, const Bytes& request) {
  Bytes pdu;
  {
    const std::lock_guard lock(mutex_);
    const bool busy = manner_ == Manner::Busy;
    pdu = busy         ? Bytes{request[0], static_cast<std::uint8_t>(request[1] | 0x80U), 6}
          : responder_ ? responder_(request)
                       : default_answer(request);
  }
  const Manner manner = manner_;
  const std::chrono::microseconds pause(pause_us_);
  if (manner == Manner::Silent || pdu.empty()) return true;
  if (manner == Manner::Resetting) return wire_ == Wire::Rtu;
  if (manner == Manner::WrongId) ++pdu[0];
  Bytes whole = frame(header, pdu);
  if (manner == Manner::Garbage) {
    for (std::uint8_t& byte : whole) byte = static_cast<std::uint8_t>(next_noise() >> 8U);
  }
  if (manner == Manner::Late && !pause_for(pause)) return false;
  const std::size_t piece = manner == Manner::Dripping ? 1 : whole.size();
  for (std::size_t sent = 0; sent < whole.size(); sent += piece) {
    if (manner == Manner::Dripping && !pause_for(pause)) return false;
    const ssize_t written = wire_ == Wire::Tcp ? send(descriptor, whole.data() + sent, piece, MSG_NOSIGNAL)
                                               : ::write(descriptor, whole.data() + sent, piece);
    if (written != static_cast<ssize_t>(piece)) return wire_ == Wire::Rtu;
  }
  return true;
}

}  // namespace rmac::fieldbus::modbus
