#pragma once

#include <array>
#include <vector>

#include "rmac/fieldbus/modbus/client.hpp"
#include "rmac/fieldbus/modbus/register_map.hpp"

namespace rmac::fieldbus::modbus {

/// What one round of reads found: places that lie side by side are read together, as far as the device gives so many.
class Image {
 public:
  /// `places` with how many addresses each takes.
  struct Wanted {
    Table table;
    std::uint16_t address;
    std::size_t count;
  };
  Image(std::vector<Wanted> wanted, std::size_t most_per_read);

  /// Reads everything. Returns when the first question was sent: all values are at least as new as that.
  [[nodiscard]] Answer<Clock::time_point> read(Client& client, int slave);
  /// Ends a doubt with the first block. Nothing to read: there is none.
  [[nodiscard]] Answer<> resynchronise(Client& client, int slave) const;

  /// A place of the last round, masked; 0 where it was not read.
  [[nodiscard]] std::uint32_t raw(const Place& place) const noexcept;
  /// The same as a number with sign.
  [[nodiscard]] double number(const Place& place) const noexcept;
  [[nodiscard]] bool holds(const Condition& condition) const noexcept;
  /// The value of one address.
  [[nodiscard]] std::uint16_t at(Table table, std::size_t address) const noexcept;

  [[nodiscard]] std::size_t blocks() const noexcept { return blocks_.size(); }

 private:
  struct Block {
    Table table;
    std::size_t first;
    std::vector<std::uint16_t> values;
  };
  std::vector<Block> blocks_;
};

/// The words of a number at `place`, first address first. What does not fit is brought to the nearest that does.
struct Words {
  std::array<std::uint16_t, 2> words{};
  std::size_t count = 0;
  bool operator==(const Words&) const = default;
};
[[nodiscard]] Words to_words(const Place& place, double value) noexcept;

}  // namespace rmac::fieldbus::modbus
