#include "gateway/simulators/vmodbus/line.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>

namespace rmac::vmodbus {
namespace {

constexpr std::size_t kTcpHead = 7;  // transaction, protocol, length, unit
constexpr std::size_t kLongestRtu = 256;
// Longer than the silence between frames at any bit rate in use, for a host that may be busy.
constexpr auto kSilence = std::chrono::milliseconds(30);

/// Length of a request in RTU by its first bytes: 0 when they do not tell yet, or its function is not known.
std::size_t rtu_length(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 2) return 0;
  const std::uint8_t function = bytes[1];
  if (function >= 1 && function <= 6) return 8;
  constexpr std::size_t kCountAt = 6;
  if ((function == 15 || function == 16) && bytes.size() > kCountAt) return kCountAt + 1 + bytes[kCountAt] + 2;
  return 0;
}

bool sound(std::span<const std::uint8_t> frame) {
  if (frame.size() < 4) return false;
  const std::uint16_t sum = check_sum(frame.first(frame.size() - 2));
  return frame[frame.size() - 2] == (sum & 0xFF) && frame[frame.size() - 1] == sum >> 8;
}

}  // namespace

std::uint16_t check_sum(std::span<const std::uint8_t> bytes) {
  constexpr std::uint16_t kPolynomial = 0xA001;
  std::uint16_t sum = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    sum = static_cast<std::uint16_t>(sum ^ byte);
    for (int bit = 0; bit < 8; ++bit) {
      const bool carry = (sum & 1) != 0;
      sum = static_cast<std::uint16_t>(sum >> 1 ^ (carry ? kPolynomial : 0));
    }
  }
  return sum;
}

Line::~Line() {
  close(descriptor_);
}

bool Line::receive() {
  std::array<std::uint8_t, 512> now{};
  const ssize_t size = read(descriptor_, now.data(), now.size());
  if (size < 0) return errno == EAGAIN || errno == EINTR;
  if (size == 0) return false;
  kept_.insert(kept_.end(), now.begin(), now.begin() + size);
  came_ = Clock::now();
  if (framing_ == Framing::Tcp) return take_tcp();
  take_rtu(false);
  return true;
}

bool Line::take_tcp() {
  while (kept_.size() >= kTcpHead) {
    const std::size_t protocol = static_cast<std::size_t>(kept_[2] << 8 | kept_[3]);
    const std::size_t length = static_cast<std::size_t>(kept_[4] << 8 | kept_[5]);
    constexpr std::size_t kLongest = 254;                                // unit and PDU
    if (protocol != 0 || length < 2 || length > kLongest) return false;  // nothing tells where the next frame begins
    const std::size_t whole = kTcpHead - 1 + length;
    if (kept_.size() < whole) return true;
    const Bytes frame(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(whole));
    kept_.erase(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(whole));
    handle(std::span(frame).first(4), frame[kTcpHead - 1], std::span(frame).subspan(kTcpHead));
  }
  return true;
}

/// A frame ends where its function says, and any other where silence follows.
void Line::take_rtu(bool silence) {
  while (!kept_.empty()) {
    std::size_t length = rtu_length(kept_);
    if (length == 0 || kept_.size() < length || !sound(std::span(kept_).first(length))) {
      if (!silence) {
        if (kept_.size() > kLongestRtu) kept_.clear();
        return;
      }
      length = kept_.size();
    }
    const Bytes frame(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(length));
    kept_.erase(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(length));
    if (sound(frame)) handle({}, frame[0], std::span(frame).subspan(1, frame.size() - 3));
  }
}

void Line::handle(std::span<const std::uint8_t> head, std::uint8_t slave, std::span<const std::uint8_t> request) {
  if (framing_ == Framing::Rtu && slave == 0) {  // to all, and nobody answers
    for (auto& [number, device] : devices_) {
      if (!device->manners.mute) static_cast<void>(device->answer(request));
    }
    return;
  }
  const auto found = devices_.find(slave);
  if (found != devices_.end()) answer(*found->second, head, slave, request);
}

Bytes Line::frame(std::span<const std::uint8_t> head, std::uint8_t slave, const Bytes& answer) const {
  Bytes bytes(head.begin(), head.end());
  if (framing_ == Framing::Tcp) {
    const std::size_t length = answer.size() + 1;
    bytes.push_back(static_cast<std::uint8_t>(length >> 8));
    bytes.push_back(static_cast<std::uint8_t>(length));
  }
  bytes.push_back(slave);
  bytes.insert(bytes.end(), answer.begin(), answer.end());
  if (framing_ == Framing::Rtu) {
    const std::uint16_t sum = check_sum(bytes);
    bytes.push_back(static_cast<std::uint8_t>(sum));
    bytes.push_back(static_cast<std::uint8_t>(sum >> 8));
  }
  return bytes;
}

void Line::answer(Device& device, std::span<const std::uint8_t> head, std::uint8_t slave,
                  std::span<const std::uint8_t> request) {
  const Bytes answered = device.answer(request);
  const Manners& manners = device.manners;
  if (manners.mute || answered.empty()) return;
  Bytes bytes = frame(head, manners.wrong_id ? static_cast<std::uint8_t>(slave % 247 + 1) : slave, answered);
  if (manners.noise) {
    for (std::uint8_t& byte : bytes) {
      noise_ = noise_ * 1664525U + 1013904223U;  // Numerical Recipes' generator: the same noise each time
      byte = static_cast<std::uint8_t>(noise_ >> 24);
    }
  }
  const auto seconds = [](double s) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
  };
  Clock::time_point due = Clock::now() + seconds(manners.late_s);
  if (!(manners.drip_s > 0)) {
    out_.push_back({due, std::move(bytes)});
    return;
  }
  for (const std::uint8_t byte : bytes) {
    out_.push_back({due, {byte}});
    due += seconds(manners.drip_s);
  }
}

bool Line::proceed() {
  const auto now = Clock::now();
  if (framing_ == Framing::Rtu && !kept_.empty() && now - came_ > kSilence) take_rtu(true);
  while (!out_.empty() && out_.front().due <= now) {
    const Bytes& bytes = out_.front().bytes;
    if (write(descriptor_, bytes.data(), bytes.size()) < 0 && errno != EAGAIN && errno != EINTR) return false;
    out_.pop_front();
  }
  return true;
}

}  // namespace rmac::vmodbus
