#include "rmac/fieldbus/eds/typed_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "eds/value.hpp"
#include "rmac/fieldbus/eds/type_names.hpp"

namespace rmac::fieldbus::eds {
namespace {

bool printable(std::uint8_t c) noexcept {
  return c >= ' ' && c < 127;
}

std::string text_of(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty() && bytes.back() == 0) bytes = bytes.first(bytes.size() - 1);
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += printable(byte) ? std::string(1, static_cast<char>(byte)) : fmt::format("\\x{:02X}", byte);
  }
  return text;
}

std::string octets_of(std::span<const std::uint8_t> bytes) {
  return fmt::format("{:02X}", fmt::join(bytes, " "));
}

/// The most that `bits` hold.
std::uint64_t most_of(unsigned bits) noexcept {
  return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
}

/// What a person may write for a type, as it goes on behind "is no INTEGER8: ".
std::string allowed_text(DataType type) {
  const unsigned bits = bits_of(type);
  if (is_real(type)) return "a finite number with a point for its decimals is one";
  if (bits == 0) return "bytes as pairs of hexadecimal digits are one, for example 01 FF";
  const std::uint64_t most = most_of(is_signed(type) ? bits - 1 : bits);
  const std::string least = is_signed(type) ? fmt::format("-{}", most + 1) : "0";
  return fmt::format("whole numbers from {} to {} are one, hexadecimal ones as 0x1F", least, most);
}

/// As the reader of EDS files takes a number: that one holds a leading zero for octal, and knows no "1Fh".
std::string as_in_sheet(std::string_view text) {
  std::string number(text);
  const bool prefixed = number.starts_with("0x") || number.starts_with("0X");
  if (!prefixed && number.size() > 1 && (number.back() == 'h' || number.back() == 'H') && number.front() != '-') {
    return "0x" + number.substr(0, number.size() - 1);
  }
  if (prefixed) return number;
  const std::size_t sign = number.starts_with('-') ? 1 : 0;
  while (number.size() > sign + 1 && number[sign] == '0' && number[sign + 1] != 'x') number.erase(sign, 1);
  return number;
}

/// Whether a signed type holds it as it is written; hexadecimal digits may fill the width.
bool holds(const std::string& number, DataType type) {
  if (!is_signed(type) || number.starts_with("0x") || number.starts_with("0X")) return true;
  const auto whole = read_whole(number);
  return whole && (whole->negative || whole->magnitude <= most_of(bits_of(type) - 1U));
}

std::optional<Value> read_text(std::string_view text, DataType type) {
  if (is_real(type)) {
    auto value = read_value(text, type);
    if (!value) return {};
    const TypedValue number = value_of(value->bytes, type);
    return std::isfinite(std::get<double>(number)) ? value : std::nullopt;
  }
  if (type == DataType::VisibleString) return read_value(text, type);
  if (bits_of(type) == 0) return text.empty() ? std::nullopt : read_value(text, DataType::OctetString);
  if (text.find('$') != std::string_view::npos) return {};  // $NODEID belongs to files
  const std::string number = as_in_sheet(text);
  return holds(number, type) ? read_value(number, type) : std::nullopt;
}

}  // namespace

TypedValue value_of(std::span<const std::uint8_t> bytes, DataType type) {
  if (type == DataType::VisibleString) return text_of(bytes);
  if (bits_of(type) == 0 || bytes.size() != bytes_of(type)) return octets_of(bytes);
  const Value value{{bytes.begin(), bytes.end()}};
  const auto number = value.number_for(0, type);
  if (type == DataType::Boolean) return number != 0;
  if (type == DataType::Real32) return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(number)));
  if (type == DataType::Real64) return std::bit_cast<double>(number);
  if (is_signed(type)) return number;
  return static_cast<std::uint64_t>(number);
}

TypedValue value_of(std::span<const std::uint8_t> bytes) {
  switch (bytes.size()) {
    case 1:
      return value_of(bytes, DataType::Unsigned8);
    case 2:
      return value_of(bytes, DataType::Unsigned16);
    case 4:
      return value_of(bytes, DataType::Unsigned32);
    case 8:
      return value_of(bytes, DataType::Unsigned64);
    default:
      break;
  }
  const std::string text = text_of(bytes);
  const bool readable = !text.empty() && text.find("\\x") == std::string::npos;
  return readable ? text : octets_of(bytes);
}

std::string to_text(const TypedValue& value) {
  return std::visit([](const auto& held) { return fmt::format("{}", held); }, value);
}

Expected<std::vector<std::uint8_t>> bytes_of_text(std::string_view text, DataType type) {
  const auto value = read_text(text, type);
  if (value) return value->bytes;
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("\"{}\" is no {}: {}", text, type_name(type), allowed_text(type)));
}

}  // namespace rmac::fieldbus::eds
