#include "modbus/pdu.hpp"

#include <modbus/modbus.h>

#include <algorithm>

namespace rmac::fieldbus::modbus {
namespace {

constexpr std::uint8_t kException = 0x80;
constexpr std::size_t kFixed = 6;  ///< slave, function, address, count or value

std::uint8_t function_of(const Request& request) noexcept {
  if (request.writes) {
    if (request.table == Table::Coils) {
      return request.count == 1 ? MODBUS_FC_WRITE_SINGLE_COIL : MODBUS_FC_WRITE_MULTIPLE_COILS;
    }
    return request.count == 1 ? MODBUS_FC_WRITE_SINGLE_REGISTER : MODBUS_FC_WRITE_MULTIPLE_REGISTERS;
  }
  switch (request.table) {
    case Table::Coils:
      return MODBUS_FC_READ_COILS;
    case Table::DiscreteInputs:
      return MODBUS_FC_READ_DISCRETE_INPUTS;
    case Table::InputRegisters:
      return MODBUS_FC_READ_INPUT_REGISTERS;
    case Table::HoldingRegisters:
      break;
  }
  return MODBUS_FC_READ_HOLDING_REGISTERS;
}

std::size_t data_bytes(const Request& request) noexcept {
  return of_bits(request.table) ? (request.count + 7) / 8 : 2 * request.count;
}

void append(std::vector<std::uint8_t>& bytes, std::size_t word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(word));
}

void append_values(std::vector<std::uint8_t>& bytes, const Request& request, std::span<const std::uint16_t> values) {
  if (!of_bits(request.table)) {
    for (const std::uint16_t value : values) append(bytes, value);
    return;
  }
  const std::size_t begin = bytes.size();
  bytes.resize(begin + data_bytes(request), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] == 0) continue;
    std::uint8_t& byte = bytes[begin + i / 8];
    byte = static_cast<std::uint8_t>(byte | 1U << i % 8);
  }
}

}  // namespace

std::size_t most_values(const Request& request) noexcept {
  if (of_bits(request.table)) return request.writes ? MODBUS_MAX_WRITE_BITS : MODBUS_MAX_READ_BITS;
  return request.writes ? MODBUS_MAX_WRITE_REGISTERS : MODBUS_MAX_READ_REGISTERS;
}

std::vector<std::uint8_t> encode(const Request& request, std::span<const std::uint16_t> values) {
  std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(request.slave), function_of(request)};
  append(bytes, request.address);
  if (request.writes && request.count == 1) {
    constexpr std::uint16_t kOn = 0xFF00;
    append(bytes, !of_bits(request.table) ? values[0] : values[0] != 0 ? kOn : 0);
    return bytes;
  }
  append(bytes, request.count);
  if (request.writes) {
    bytes.push_back(static_cast<std::uint8_t>(data_bytes(request)));
    append_values(bytes, request, values);
  }
  return bytes;
}

Decoded decode(const Request& request, std::span<const std::uint8_t> question, std::span<const std::uint8_t> answer,
               std::span<std::uint16_t> values) noexcept {
  if (answer.size() < 3 || answer[0] != question[0]) return {};
  if (answer[1] == (question[1] | kException)) {
    return answer.size() == 3 ? Decoded{Verdict::Exception, answer[2]} : Decoded{};
  }
  if (answer[1] != question[1]) return {};
  if (request.writes) {
    // Confirmed by address and value, or address and count, as they were sent.
    const bool echo = answer.size() == kFixed && std::equal(answer.begin(), answer.end(), question.begin());
    return {echo ? Verdict::Fits : Verdict::Wrong, 0};
  }
  const std::span<const std::uint8_t> data = answer.subspan(3);
  if (answer[2] != data.size() || data.size() != data_bytes(request) || values.size() != request.count) return {};
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = of_bits(request.table) ? static_cast<std::uint16_t>(data[i / 8] >> i % 8 & 1)
                                       : static_cast<std::uint16_t>(data[2 * i] << 8U | data[2 * i + 1]);
  }
  return {Verdict::Fits, 0};
}

const char* exception_text(int code) noexcept {
  switch (code) {
    case MODBUS_EXCEPTION_ILLEGAL_FUNCTION:
      return "it does not know the function";
    case MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS:
      return "it has no such address";
    case MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE:
      return "it does not take the value";
    case MODBUS_EXCEPTION_SLAVE_OR_SERVER_FAILURE:
      return "it failed in carrying it out";
    case MODBUS_EXCEPTION_ACKNOWLEDGE:
      return "it has begun and needs longer";
    case MODBUS_EXCEPTION_SLAVE_OR_SERVER_BUSY:
      return "it is busy";
    case MODBUS_EXCEPTION_MEMORY_PARITY:
      return "its memory has a parity error";
    case MODBUS_EXCEPTION_GATEWAY_PATH:
      return "the gateway has no path to it";
    case MODBUS_EXCEPTION_GATEWAY_TARGET:
      return "the gateway got no answer from it";
    default:
      return "for a reason of its own";
  }
}

}  // namespace rmac::fieldbus::modbus
