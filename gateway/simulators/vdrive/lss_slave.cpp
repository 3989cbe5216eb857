#include "gateway/simulators/vdrive/lss_slave.hpp"

#include <array>

namespace rmac::vdrive {

namespace {

// Command specifiers (CiA 305, 3.8)
enum : std::uint8_t {
  kSwitchAll = 0x04,
  kSetNode = 0x11,
  kSetBitRate = 0x13,
  kActivate = 0x15,
  kStore = 0x17,
  kSelect = 0x40,
  kSelected = 0x44,
  kAnyUnconfigured = 0x4C,
  kFound = 0x4F,
  kUnconfiguredIsHere = 0x50,
  kFastScan = 0x51,
  kAskIdentity = 0x5A,
  kAskNode = 0x5E
};
constexpr unsigned kParts = 4;
/// The standard's table of bit timings; 0 is reserved.
constexpr std::array<std::uint32_t, 9> kBitRates{1'000'000, 800'000, 500'000, 250'000, 125'000,
                                                 0,         50'000,  20'000,  10'000};

std::uint32_t number_at(const CanFrame& frame, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number |= std::uint32_t{frame.data[at + i]} << (8 * i);
  return number;
}

CanFrame answer(std::uint8_t command, std::uint32_t number = 0) {
  CanFrame frame{.id = LssSlave::kSlaveId, .size = 8};
  frame.data[0] = command;
  for (std::size_t i = 0; i < 4; ++i) frame.data[1 + i] = static_cast<std::uint8_t>(number >> (8 * i));
  return frame;
}

}  // namespace

void LssSlave::power_on() {
  active_ = pending_ = stored_;
  bit_rate_ = pending_rate_ = stored_rate_;
  configures_ = false;
  selected_ = scan_part_ = 0;
  silent_until_ = Time{0};
}

void LssSlave::select(unsigned part, std::uint32_t number, const Identity& identity) {
  if (part == 0) selected_ = 0;
  selected_ = part == selected_ && identity.at(part) == number ? selected_ + 1 : 0;
  if (selected_ == kParts) configures_ = true;
}

/// Fast scan: the master guesses the identity bit by bit, and whoever it can be says so.
bool LssSlave::scan(const CanFrame& frame, const Identity& identity) {
  constexpr std::uint8_t kBegin = 0x80, kMostBits = 31;
  const std::uint8_t bit = frame.data[5], part = frame.data[6], next = frame.data[7];
  if (configures_ || active_ != kUnconfigured) return false;
  if (bit == kBegin) {
    scan_part_ = 0;
    return true;
  }
  if (bit > kMostBits || part >= kParts || next >= kParts || part != scan_part_) return false;
  if ((identity.at(part) ^ number_at(frame, 1)) >> bit != 0) return false;
  if (bit == 0 && next < part) configures_ = true;
  scan_part_ = next;
  return true;
}

std::optional<CanFrame> LssSlave::receive(const CanFrame& frame, const Identity& identity, Time now) {
  if (frame.size != 8 || silent(now)) return {};
  const std::uint8_t command = frame.data[0];
  if (command == kSwitchAll) {
    configures_ = frame.data[1] == 1;
    selected_ = 0;
    return {};
  }
  if (command >= kSelect && command < kSelect + kParts) {
    const bool before = configures_;
    select(command - kSelect, number_at(frame, 1), identity);
    return configures_ && !before ? std::optional(answer(kSelected)) : std::nullopt;
  }
  if (command == kFastScan) return scan(frame, identity) ? std::optional(answer(kFound)) : std::nullopt;
  if (command == kAnyUnconfigured) {
    return active_ == kUnconfigured ? std::optional(answer(kUnconfiguredIsHere)) : std::nullopt;
  }
  if (!configures_) return {};
  if (command >= kAskIdentity && command < kAskIdentity + kParts) {
    return answer(command, identity.at(command - kAskIdentity));
  }
  constexpr std::uint32_t kNotThere = 1;  // error code: out of range, or not supported
  switch (command) {
    case kSetNode: {
      const std::uint8_t node = frame.data[1];
      if (node == 0 || (node > 127 && node != kUnconfigured)) return answer(command, kNotThere);
      pending_ = node;
      return answer(command);
    }
    case kSetBitRate: {
      const std::uint8_t table = frame.data[1], index = frame.data[2];
      if (table != 0 || index >= kBitRates.size() || kBitRates.at(index) == 0) return answer(command, kNotThere);
      pending_rate_ = kBitRates.at(index);
      return answer(command);
    }
    case kActivate: {
      const Time delay = std::chrono::milliseconds(frame.data[1] | frame.data[2] << 8);
      bit_rate_ = pending_rate_;
      // The delay before the change, in which it still could, and the one after it.
      silent_until_ = now + 2 * delay;
      return {};
    }
    case kStore:
      stored_ = pending_;
      stored_rate_ = pending_rate_;
      return answer(command);
    case kAskNode:
      return answer(command, active_);
    default:
      return {};
  }
}

}  // namespace rmac::vdrive
