#pragma once

#include <functional>
#include <map>
#include <mutex>

#include "unit/fieldbus/modbus/modbus_peer.hpp"

namespace rmac::fieldbus::modbus {

/// The four tables of a slave that keeps the protocol, for a `ModbusPeer` to answer with. Addresses that nobody wrote
/// read 0. Any thread.
class RegisterBank {
 public:
  /// Called for each value that the master wrote, after it was taken; may set others through the bank it is given.
  std::function<void(RegisterBank& bank, Table table, std::uint16_t address, std::uint16_t value)> on_write;
  std::size_t most_per_read = 125;

  void set(Table table, std::uint16_t address, std::uint16_t value) {
    const std::lock_guard lock(mutex_);
    values_[{table, address}] = value;
  }
  [[nodiscard]] std::uint16_t get(Table table, std::uint16_t address) {
    const std::lock_guard lock(mutex_);
    return values_[{table, address}];
  }

  /// Slave, function, data in; the same out.
  Bytes answer(const Bytes& request) {
    const std::uint8_t function = request[1];
    const auto address = static_cast<std::uint16_t>(request[2] << 8U | request[3]);
    const auto word = static_cast<std::uint16_t>(request[4] << 8U | request[5]);
    if (function <= 4) return read(request, address, word);
    const Table table = function == 5 || function == 15 ? Table::Coils : Table::HoldingRegisters;
    if (function == 5) put(table, address, word != 0 ? 1 : 0);
    if (function == 6) put(table, address, word);
    for (std::uint16_t i = 0; function >= 15 && i < word; ++i) {
      const std::size_t data = 7;
      const auto value = function == 15 ? request[data + i / 8U] >> i % 8U & 1
                                        : request[data + 2U * i] << 8U | request[data + 2U * i + 1U];
      put(table, static_cast<std::uint16_t>(address + i), static_cast<std::uint16_t>(value));
    }
    return {request.begin(), request.begin() + 6};
  }

 private:
  void put(Table table, std::uint16_t address, std::uint16_t value) {
    set(table, address, value);
    if (on_write) on_write(*this, table, address, value);
  }

  Bytes read(const Bytes& request, std::uint16_t address, std::uint16_t count) {
    constexpr std::uint8_t kException = 0x80;
    if (count > most_per_read) return {request[0], static_cast<std::uint8_t>(request[1] | kException), 3};
    const Table table = static_cast<Table>(request[1] == 3 ? 3 : request[1] == 4 ? 2 : request[1] - 1);
    Bytes answer{request[0], request[1], 0};
    if (of_bits(table)) answer.resize(3U + (count + 7U) / 8U, 0);
    for (std::uint16_t i = 0; i < count; ++i) {
      const std::uint16_t value = get(table, static_cast<std::uint16_t>(address + i));
      if (of_bits(table)) {
        answer[3U + i / 8U] = static_cast<std::uint8_t>(answer[3U + i / 8U] | (value != 0 ? 1U : 0U) << i % 8U);
      } else {
        answer.push_back(static_cast<std::uint8_t>(value >> 8U));
        answer.push_back(static_cast<std::uint8_t>(value));
      }
    }
    answer[2] = static_cast<std::uint8_t>(answer.size() - 3);
    return answer;
  }

  std::mutex mutex_;
  std::map<std::pair<Table, std::uint16_t>, std::uint16_t> values_;
};

}  // namespace rmac::fieldbus::modbus
