#include "gateway/simulators/vmodbus/tables.hpp"

namespace rmac::vmodbus {
namespace {

constexpr std::size_t kMostRegistersWritten = 123;
constexpr std::size_t kMostBitsWritten = 1968;

std::uint16_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

/// Which table a function reads or writes.
std::optional<Table> table_of(std::uint8_t function) {
  switch (function) {
    case 1:
    case 5:
    case 15:
      return Table::Coils;
    case 2:
      return Table::DiscreteInputs;
    case 3:
    case 6:
    case 16:
      return Table::HoldingRegisters;
    case 4:
      return Table::InputRegisters;
    default:
      return {};
  }
}

}  // namespace

Bytes exception_answer(std::uint8_t function, Exception exception) {
  constexpr std::uint8_t kRefused = 0x80;
  return {static_cast<std::uint8_t>(function | kRefused), static_cast<std::uint8_t>(exception)};
}

void Tables::add(Table table, std::uint16_t address, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) values_.try_emplace({table, static_cast<std::uint16_t>(address + i)}, 0);
}

std::uint16_t Tables::get(Table table, std::uint16_t address) const {
  const auto found = values_.find({table, address});
  return found == values_.end() ? std::uint16_t{0} : found->second;
}

void Tables::set(Table table, std::uint16_t address, std::uint16_t value) {
  values_[{table, address}] = value;
}

std::uint32_t Tables::raw(const Place& place) const {
  std::uint32_t value = get(place.table, place.address);
  if (place.bits == 32) {
    const std::uint32_t next = get(place.table, static_cast<std::uint16_t>(place.address + 1));
    value = place.low_word_first ? next << 16 | value : value << 16 | next;
  }
  return value & place.mask;
}

void Tables::set_raw(const Place& place, std::uint32_t raw) {
  Place whole = place;
  whole.mask = 0xFFFFFFFF;
  const std::uint32_t value = (this->raw(whole) & ~place.mask) | (raw & place.mask);
  const auto low = static_cast<std::uint16_t>(value);
  const auto high = static_cast<std::uint16_t>(value >> 16);
  if (place.bits != 32) {
    set(place.table, place.address, low);
    return;
  }
  set(place.table, place.address, place.low_word_first ? low : high);
  set(place.table, static_cast<std::uint16_t>(place.address + 1), place.low_word_first ? high : low);
}

bool Tables::has(Table table, std::size_t address, std::size_t count) const {
  for (std::size_t i = 0; i < count; ++i) {
    if (address + i > 0xFFFF || !values_.contains({table, static_cast<std::uint16_t>(address + i)})) return false;
  }
  return true;
}

Bytes Tables::read(std::uint8_t function, Table table, std::uint16_t address, std::uint16_t count) const {
  if (count == 0 || count > most_per_read_) return exception_answer(function, Exception::IllegalValue);
  if (!has(table, address, count)) return exception_answer(function, Exception::IllegalAddress);
  Bytes data;
  if (fieldbus::modbus::of_bits(table)) data.resize((count + 7U) / 8U);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t value = get(table, static_cast<std::uint16_t>(address + i));
    if (fieldbus::modbus::of_bits(table)) {
      if (value != 0) data[i / 8] = static_cast<std::uint8_t>(data[i / 8] | 1U << i % 8);
    } else {
      data.push_back(static_cast<std::uint8_t>(value >> 8));
      data.push_back(static_cast<std::uint8_t>(value));
    }
  }
  Bytes answer{function, static_cast<std::uint8_t>(data.size())};
  answer.insert(answer.end(), data.begin(), data.end());
  return answer;
}

std::optional<Exception> Tables::write_many(std::span<const std::uint8_t> request, Table table,
                                            std::vector<Write>& writes) {
  constexpr std::size_t kHead = 6;
  const bool bits = table == Table::Coils;
  const std::uint16_t address = word(request, 1);
  const std::uint16_t count = word(request, 3);
  const std::size_t bytes = bits ? (count + 7U) / 8U : 2U * count;
  const bool sound = count > 0 && count <= (bits ? kMostBitsWritten : kMostRegistersWritten) &&
                     request.size() == kHead + bytes && request[5] == bytes;
  if (!sound) return Exception::IllegalValue;
  if (!has(table, address, count)) return Exception::IllegalAddress;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t eight = bits ? request[kHead + i / 8] : 0;
    const auto value = bits ? static_cast<std::uint16_t>(eight >> i % 8 & 1U) : word(request, kHead + 2 * i);
    writes.push_back({table, static_cast<std::uint16_t>(address + i), value});
  }
  return {};
}

Bytes Tables::answer(std::span<const std::uint8_t> request, std::vector<Write>& writes) {
  if (request.empty()) return {};
  const std::uint8_t function = request[0];
  const auto table = table_of(function);
  if (!table) return exception_answer(function, Exception::IllegalFunction);
  constexpr std::size_t kShortest = 5;
  constexpr std::size_t kShortestOfMany = 6;
  const bool many = function >= 15;
  if (many ? request.size() < kShortestOfMany : request.size() != kShortest) {
    return exception_answer(function, Exception::IllegalValue);
  }
  const std::uint16_t address = word(request, 1);
  const std::uint16_t value = word(request, 3);
  if (function <= 4) return read(function, *table, address, value);
  if (many) {
    if (const auto refused = write_many(request, *table, writes)) return exception_answer(function, *refused);
  } else {
    constexpr std::uint16_t kOn = 0xFF00;
    if (function == 5 && value != kOn && value != 0) return exception_answer(function, Exception::IllegalValue);
    if (!has(*table, address, 1)) return exception_answer(function, Exception::IllegalAddress);
    writes.push_back({*table, address, function == 5 ? static_cast<std::uint16_t>(value != 0 ? 1 : 0) : value});
  }
  for (const Write& write : writes) set(write.table, write.address, write.value);
  return {request.begin(), request.begin() + kShortest};
}

}  // namespace rmac::vmodbus
