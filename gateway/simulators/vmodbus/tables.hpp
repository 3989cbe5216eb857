#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "rmac/fieldbus/modbus/register_map.hpp"

namespace rmac::vmodbus {

using fieldbus::modbus::Place;
using fieldbus::modbus::Table;
using Bytes = std::vector<std::uint8_t>;

/// Why a slave refuses (Modbus Application Protocol V1.1b3, 7).
enum class Exception : std::uint8_t { IllegalFunction = 1, IllegalAddress = 2, IllegalValue = 3, DeviceBusy = 6 };

/// The four tables of a slave: what stands at the addresses that it has.
class Tables {
 public:
  explicit Tables(std::size_t most_per_read) : most_per_read_(most_per_read) {}

  /// These addresses exist from now on.
  void add(Table table, std::uint16_t address, std::size_t count = 1);
  void add(const Place& place) { add(place.table, place.address, place.count()); }
  [[nodiscard]] std::uint16_t get(Table table, std::uint16_t address) const;
  void set(Table table, std::uint16_t address, std::uint16_t value);

  /// The number at a place, its mask taken off, as the raw bits that it has; and back, other bits left as they are.
  [[nodiscard]] std::uint32_t raw(const Place& place) const;
  void set_raw(const Place& place, std::uint32_t raw);

  struct Write {
    Table table;
    std::uint16_t address;
    std::uint16_t value;
  };
  /// Answers a request (function and data), having carried it out; `writes` gets what it wrote.
  [[nodiscard]] Bytes answer(std::span<const std::uint8_t> request, std::vector<Write>& writes);

 private:
  [[nodiscard]] bool has(Table table, std::size_t address, std::size_t count) const;
  [[nodiscard]] Bytes read(std::uint8_t function, Table table, std::uint16_t address, std::uint16_t count) const;
  [[nodiscard]] std::optional<Exception> write_many(std::span<const std::uint8_t> request, Table table,
                                                    std::vector<Write>& writes);

  std::size_t most_per_read_;
  std::map<std::pair<Table, std::uint16_t>, std::uint16_t> values_;
};

[[nodiscard]] Bytes exception_answer(std::uint8_t function, Exception exception);

}  // namespace rmac::vmodbus
