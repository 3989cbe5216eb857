#include "unit/fieldbus/canopen/lss/lss_peer.hpp"

#include <algorithm>

namespace rmac::fieldbus::test {
namespace {

constexpr std::uint16_t kMasterId = 0x7E5, kSlaveId = 0x7E4, kHeartbeat = 0x700;

std::uint32_t number_of(const CanFrame& frame) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number |= std::uint32_t{frame.data[1 + i]} << (8 * i);
  return number;
}

}  // namespace

void LssPeer::answer(Time at, std::uint8_t command, std::uint32_t number) {
  CanFrame frame{.id = kSlaveId, .size = 8};
  frame.data[0] = command;
  for (std::size_t i = 0; i < 4; ++i) frame.data[1 + i] = static_cast<std::uint8_t>(number >> (8 * i));
  answer_ = frame;
  answers_at_ = at + habits_.answers_after;
}

std::optional<CanFrame> LssPeer::take(Time now) {
  if (!answer_ || now < answers_at_) return {};
  const auto said = answer_;
  answer_.reset();
  return said;
}

void LssPeer::receive(const CanFrame& frame, Time now) {
  if (answer_ || frame.id != kMasterId || frame.size != 8) return;
  if (frame.data[0] != 0x04) return configures_ ? while_configuring(frame, now) : while_waiting(frame, now);
  if (habits_.ignores_switches) return;
  const bool goes_on = configures_ && frame.data[1] == 0 && active_ == kUnconfigured && pending_ != kUnconfigured;
  configures_ = frame.data[1] == 1;
  if (!configures_) selected_ = {};
  if (!goes_on) return;
  // It resets its communication by itself, and boots.
  active_ = pending_;
  if (!habits_.boots) return;
  answer_ = CanFrame{.id = static_cast<std::uint16_t>(kHeartbeat + active_), .size = 1};
  answers_at_ = now + habits_.answers_after;
}

bool LssPeer::fits(const CanFrame& frame) {
  const std::uint8_t bit = frame.data[5], part = frame.data[6], next = frame.data[7];
  const bool without_id = active_ == kUnconfigured && pending_ == kUnconfigured;
  if (bit == 0x80 && (without_id || habits_.always_answers_begin)) {
    scan_part_ = 0;
    return true;
  }
  if (!without_id || bit > 31 || part > 3 || next > 3 || part != scan_part_) return false;
  if ((identity_.at(part) ^ number_of(frame)) >> bit != 0) return false;
  scan_part_ = next;
  if (bit == 0 && next < part) configures_ = true;
  return true;
}

void LssPeer::while_waiting(const CanFrame& frame, Time now) {
  const std::uint8_t command = frame.data[0];
  if (command == 0x51 && fits(frame)) return answer(now, 0x4F);
  if (command < 0x40 || command > 0x43) return;
  selected_.at(command - 0x40U) = number_of(frame);
  if (command != 0x43 || selected_ != identity_) return;
  configures_ = true;
  answer(now, 0x44);
}

void LssPeer::while_configuring(const CanFrame& frame, Time now) {
  const std::uint8_t command = frame.data[0];
  switch (command) {
    case 0x51:
      return answer(now, 0x4F);
    case 0x11:
      pending_ = frame.data[1];
      return answer(now, command);
    case 0x17:
      ++stored_;
      return answer(now + habits_.stores_for, command);
    case 0x5A:
    case 0x5B:
    case 0x5C:
    case 0x5D:
      if (habits_.knows_inquiry) answer(now, command, identity_.at(command - 0x5AU));
      return;
    case 0x5E:
      return answer(now, command, active_);
    default:
      return;
  }
}

bool LssWire::send(const CanFrame& frame) noexcept {
  if (listen) listen(frame);
  for (auto& peer : peers_) {
    if (!cut) peer->receive(frame, now_);
  }
  return true;
}

bool LssWire::receive(CanFrame& frame) noexcept {
  for (auto& peer : peers_) {
    if (const auto said = peer->take(now_)) received_.push_back(*said);
  }
  if (received_.empty()) return false;
  frame = received_.front();
  received_.pop_front();
  return true;
}

void LssWire::wait(std::chrono::nanoseconds at_most) noexcept {
  now_ += std::max<std::chrono::nanoseconds>(at_most, std::chrono::microseconds(1));
}

}  // namespace rmac::fieldbus::test
