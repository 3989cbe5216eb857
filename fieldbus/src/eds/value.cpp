#include "eds/value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>

#include "eds/ini.hpp"

namespace rmac::fieldbus {

std::string to_string(ObjectAddress address) {
  return fmt::format("{:04X}h:{:02X}", address.index, address.sub);
}

}  // namespace rmac::fieldbus

namespace rmac::fieldbus::eds {
namespace {

std::uint64_t raw_number(const std::vector<std::uint8_t>& bytes) noexcept {
  std::uint64_t raw = 0;
  for (std::size_t i = 0; i < bytes.size() && i < 8; ++i) raw |= std::uint64_t{bytes[i]} << (8 * i);
  return raw;
}

std::vector<std::uint8_t> little_endian(std::uint64_t raw, std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(raw >> (8 * i));
  return bytes;
}

/// In two's complement. Makers write negative numbers also as hexadecimal digits of the type's width: 0xFF is -1.
bool fits(const Whole& number, DataType type) noexcept {
  const unsigned bits = bits_of(type);
  const std::uint64_t most = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  if (!number.negative) return number.magnitude <= most;
  return is_signed(type) && number.magnitude <= std::uint64_t{1} << (bits - 1);
}

template <typename Real>
std::optional<Value> read_real(std::string_view text) {
  Real number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  if constexpr (sizeof(Real) == 4) return Value{little_endian(std::bit_cast<std::uint32_t>(number), 4)};
  return Value{little_endian(std::bit_cast<std::uint64_t>(static_cast<double>(number)), 8)};
}

/// "2A 01 FF", with or without spaces.
std::optional<Value> read_octets(std::string_view text) {
  Value value;
  std::string digits(text);
  std::erase(digits, ' ');
  if (digits.size() % 2 != 0) return {};
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    std::uint8_t byte = 0;
    const auto [end, error] = std::from_chars(&digits[i], &digits[i] + 2, byte, 16);
    if (error != std::errc() || end != &digits[i] + 2) return {};
    value.bytes.push_back(byte);
  }
  return value;
}

std::optional<Value> read_number(std::string_view text, DataType type) {
  constexpr std::string_view kNodeId = "$nodeid";
  Value value;
  Whole number;
  std::string words = lower_case(text);
  if (const std::size_t at = words.find(kNodeId); at != std::string::npos) {
    // "$NODEID+0x180", "0x180+$NODEID", or alone.
    value.plus_node_id = true;
    words.erase(at, kNodeId.size());
    std::erase(words, ' ');
    if (!words.empty() && words.front() == '+') words.erase(0, 1);
    if (!words.empty() && words.back() == '+') words.pop_back();
    if (words.empty()) words = "0";
  }
  const auto read = read_whole(words);
  if (!read || !fits(*read, type)) return {};
  number = *read;
  if (type == DataType::Boolean && number.magnitude > 1) return {};
  value.bytes = little_endian(number.negative ? 0 - number.magnitude : number.magnitude, bytes_of(type));
  return value;
}

}  // namespace

std::uint8_t bits_of(DataType type) noexcept {
  switch (type) {
    case DataType::Boolean:
      return 1;
    case DataType::Integer8:
    case DataType::Unsigned8:
      return 8;
    case DataType::Integer16:
    case DataType::Unsigned16:
      return 16;
    case DataType::Integer24:
    case DataType::Unsigned24:
      return 24;
    case DataType::Integer32:
    case DataType::Unsigned32:
    case DataType::Real32:
      return 32;
    case DataType::Integer40:
    case DataType::Unsigned40:
      return 40;
    case DataType::Integer48:
    case DataType::Unsigned48:
    case DataType::TimeOfDay:
    case DataType::TimeDifference:
      return 48;
    case DataType::Integer56:
    case DataType::Unsigned56:
      return 56;
    case DataType::Integer64:
    case DataType::Unsigned64:
    case DataType::Real64:
      return 64;
    default:
      return 0;
  }
}

bool is_signed(DataType type) noexcept {
  switch (type) {
    case DataType::Integer8:
    case DataType::Integer16:
    case DataType::Integer24:
    case DataType::Integer32:
    case DataType::Integer40:
    case DataType::Integer48:
    case DataType::Integer56:
    case DataType::Integer64:
      return true;
    default:
      return false;
  }
}

bool is_real(DataType type) noexcept {
  return type == DataType::Real32 || type == DataType::Real64;
}

std::vector<std::uint8_t> Value::bytes_for(std::uint8_t node) const {
  return plus_node_id ? little_endian(raw_number(bytes) + node, bytes.size()) : bytes;
}

std::int64_t Value::number_for(std::uint8_t node, DataType type) const noexcept {
  std::uint64_t raw = raw_number(bytes) + (plus_node_id ? node : 0U);
  const unsigned bits = bits_of(type);
  if (is_signed(type) && bits < 64 && (raw >> (bits - 1) & 1U) != 0) raw |= ~std::uint64_t{0} << bits;
  return static_cast<std::int64_t>(raw);
}

std::optional<Whole> read_whole(std::string_view text) noexcept {
  Whole number;
  if (text.starts_with('-')) {
    number.negative = true;
    text.remove_prefix(1);
  }
  int base = 10;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    base = 16;
    text.remove_prefix(2);
  } else if (text.size() > 1 && text.front() == '0') {
    base = 8;
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number.magnitude, base);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return {};
  return number;
}

std::optional<std::uint64_t> read_count(std::string_view text, std::uint64_t most) noexcept {
  const auto number = read_whole(text);
  if (!number || number->magnitude > most || (number->negative && number->magnitude != 0)) return {};
  return number->magnitude;
}

std::optional<Value> read_value(std::string_view text, DataType type) {
  const bool hexadecimal = text.starts_with("0x") || text.starts_with("0X");
  switch (type) {
    case DataType::VisibleString:
      return Value{{text.begin(), text.end()}};
    case DataType::OctetString:
      return read_octets(text);
    case DataType::Real32:
      if (!hexadecimal) return read_real<float>(text);
      break;
    case DataType::Real64:
      if (!hexadecimal) return read_real<double>(text);
      break;
    default:
      break;
  }
  if (bits_of(type) == 0) return Value{};
  return read_number(text, type);
}

}  // namespace rmac::fieldbus::eds
