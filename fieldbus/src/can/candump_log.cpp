#include "rmac/fieldbus/can/candump_log.hpp"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/error.h>

#include <algorithm>
#include <charconv>

namespace rmac::fieldbus {
namespace {

using Kind = LoggedFrame::Kind;

/// The next word of a line, which is taken from it.
std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t begin = line.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return line = {};
  line.remove_prefix(begin);
  const std::size_t end = std::min(line.find_first_of(kBlank), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

template <typename Number>
bool read_number(std::string_view text, int base, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

/// "1436509052.249713"; 0 for what is no number of seconds, for candump writes dates, too.
std::chrono::nanoseconds read_stamp(std::string_view text) {
  constexpr std::int64_t kMostSeconds = 9'000'000'000;
  constexpr std::size_t kDigits = 9;
  const std::size_t point = std::min(text.find('.'), text.size());
  std::int64_t seconds = 0;
  std::uint32_t fraction = 0;
  std::string digits(text.substr(std::min(point + 1, text.size())));
  digits.resize(kDigits, '0');
  if (!read_number(text.substr(0, point), 10, seconds) || !read_number(digits, 10, fraction)) return {};
  if (seconds < 0 || seconds > kMostSeconds) return {};
  return std::chrono::seconds(seconds) + std::chrono::nanoseconds(fraction);
}

/// The time in front of a line, which is taken from it; 0: it has none.
std::chrono::nanoseconds take_stamp(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(" \t");
  if (begin == std::string_view::npos || line[begin] != '(') return {};
  const std::size_t end = line.find(')', begin);
  if (end == std::string_view::npos) return {};
  const std::string_view time = line.substr(begin + 1, end - begin - 1);
  line.remove_prefix(end + 1);
  return read_stamp(time);
}

/// Three digits are an 11-bit identifier, eight a longer one or the classes of an error.
bool read_id(std::string_view digits, LoggedFrame& logged) {
  constexpr std::size_t kShort = 3, kLong = 8;
  if (!read_number(digits, 16, logged.id)) return false;
  if (digits.size() == kShort) {
    logged.frame.id = static_cast<std::uint16_t>(logged.id);
    return logged.id <= CAN_SFF_MASK;
  }
  logged.kind = (logged.id & CAN_ERR_FLAG) != 0 ? Kind::Error : Kind::Extended;
  logged.id &= CAN_EFF_MASK;
  return digits.size() == kLong;
}

/// Pairs of digits, with or without points between.
bool read_data(std::string_view digits, CanFrame& frame) {
  while (!digits.empty()) {
    if (digits.front() == '.' && frame.size > 0) digits.remove_prefix(1);
    if (digits.size() < 2 || frame.size == frame.data.size()) return false;
    if (!read_number(digits.substr(0, 2), 16, frame.data.at(frame.size))) return false;
    ++frame.size;
    digits.remove_prefix(2);
  }
  return true;
}

/// "181#AABB", "181#R", "181##1AABB".
bool read_compact(std::string_view word, LoggedFrame& logged) {
  const std::size_t hash = word.find('#');
  if (!read_id(word.substr(0, hash), logged)) return false;
  std::string_view data = word.substr(hash + 1);
  if (data.starts_with('#')) {
    logged.kind = Kind::Fd;
    return true;
  }
  if (data.starts_with('R') || data.starts_with('r')) {
    if (logged.kind == Kind::Data) logged.kind = Kind::Remote;
    return true;
  }
  // Behind eight bytes there may be the length as it was sent.
  if (const std::size_t mark = data.find('_'); mark != std::string_view::npos) data = data.substr(0, mark);
  return read_data(data, logged.frame);
}

/// "181   [2]  AA BB", "181   [0]  remote request".
bool read_spaced(std::string_view id, std::string_view line, LoggedFrame& logged) {
  constexpr std::size_t kFdLength = 4;  // "[08]": so it writes the length of CAN FD frames alone
  const std::string_view length = next_word(line);
  std::size_t bytes = 0;
  if (!read_id(id, logged) || length.size() < 3 || length.front() != '[' || length.back() != ']' ||
      !read_number(length.substr(1, length.size() - 2), 10, bytes)) {
    return false;
  }
  if (length.size() == kFdLength) {
    logged.kind = Kind::Fd;
    return true;
  }
  if (std::string_view rest = line; next_word(rest) == "remote") {
    if (logged.kind == Kind::Data) logged.kind = Kind::Remote;
    return true;
  }
  std::string data;
  for (std::size_t i = 0; i < bytes; ++i) data += next_word(line);
  return read_data(data, logged.frame) && logged.frame.size == bytes;
}

}  // namespace

std::optional<LoggedFrame> read_log_line(std::string_view line) {
  LoggedFrame logged;
  const std::chrono::nanoseconds stamp = take_stamp(line);
  logged.interface = next_word(line);
  const std::string_view word = next_word(line);
  const bool compact = word.find('#') != std::string_view::npos;
  if (!(compact ? read_compact(word, logged) : read_spaced(word, line, logged))) return {};
  logged.frame.stamp = stamp;
  return logged;
}

std::string log_line_head(const LoggedFrame& logged) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(logged.frame.stamp);
  const auto us = std::chrono::floor<std::chrono::microseconds>(logged.frame.stamp - seconds);
  return fmt::format("({}.{:06}) {}", seconds.count(), us.count(), logged.interface);
}

std::string to_log_line(const LoggedFrame& logged) {
  const CanFrame& frame = logged.frame;
  std::string line = fmt::format("{} {:03X}#", log_line_head(logged), frame.id);
  for (std::size_t i = 0; i < frame.size; ++i) line += fmt::format("{:02X}", frame.data.at(i));
  return line;
}

std::string foreign_frame_text(const LoggedFrame& logged) {
  switch (logged.kind) {
    case Kind::Data:
      break;
    case Kind::Remote:
      return fmt::format("remote frame {:03X}h", logged.id);
    case Kind::Extended:
      return fmt::format("29-bit identifier {:08X}h, which CANopen does not use", logged.id);
    case Kind::Fd:
      return fmt::format("CAN FD frame {:X}h, which CANopen does not use", logged.id);
    case Kind::Error:
      std::string text;
      for (const auto& [bit, name] : {std::pair<std::uint32_t, const char*>{CAN_ERR_TX_TIMEOUT, "sending timed out"},
                                      {CAN_ERR_LOSTARB, "lost arbitration"},
                                      {CAN_ERR_CRTL, "controller"},
                                      {CAN_ERR_PROT, "protocol violation"},
                                      {CAN_ERR_TRX, "transceiver"},
                                      {CAN_ERR_ACK, "no acknowledgement"},
                                      {CAN_ERR_BUSOFF, "bus-off"},
                                      {CAN_ERR_BUSERROR, "bus error"},
                                      {CAN_ERR_RESTARTED, "controller restarted"}}) {
        if ((logged.id & bit) != 0) text += fmt::format("{}{}", text.empty() ? ": " : ", ", name);
      }
      return "error frame" + text;
  }
  return {};
}

}  // namespace rmac::fieldbus
