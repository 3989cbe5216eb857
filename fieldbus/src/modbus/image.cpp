#include "modbus/image.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::fieldbus::modbus {

Image::Image(std::vector<Wanted> wanted, std::size_t most_per_read) {
  std::sort(wanted.begin(), wanted.end(), [](const Wanted& a, const Wanted& b) {
    return std::pair(a.table, a.address) < std::pair(b.table, b.address);
  });
  for (const Wanted& one : wanted) {
    const std::size_t end = one.address + one.count;
    if (!blocks_.empty()) {
      Block& last = blocks_.back();
      const std::size_t last_end = last.first + last.values.size();
      const bool touches = last.table == one.table && one.address <= last_end;
      if (touches && std::max(end, last_end) - last.first <= most_per_read) {
        last.values.resize(std::max(end, last_end) - last.first);
        continue;
      }
    }
    blocks_.push_back({one.table, one.address, std::vector<std::uint16_t>(one.count)});
  }
}

Answer<Clock::time_point> Image::read(Client& client, int slave) {
  auto first = Clock::time_point::max();
  for (Block& block : blocks_) {
    const auto asked = client.read(slave, block.table, static_cast<std::uint16_t>(block.first), block.values);
    if (!asked) return asked;
    first = std::min(first, *asked);
  }
  return first;
}

Answer<> Image::resynchronise(Client& client, int slave) const {
  if (blocks_.empty()) return {};
  std::size_t longest = 0;
  for (const Block& block : blocks_) {
    if (block.table == blocks_[0].table) longest = std::max(longest, block.values.size());
  }
  return client.resynchronise(slave, blocks_[0].table, static_cast<std::uint16_t>(blocks_[0].first), longest + 1);
}

std::uint16_t Image::at(Table table, std::size_t address) const noexcept {
  for (const Block& block : blocks_) {
    if (block.table == table && address >= block.first && address < block.first + block.values.size()) {
      return block.values[address - block.first];
    }
  }
  return 0;
}

std::uint32_t Image::raw(const Place& place) const noexcept {
  std::uint32_t value = at(place.table, place.address);
  if (place.bits == 32) {
    const std::uint32_t next = at(place.table, place.address + std::size_t{1});
    value = place.low_word_first ? next << 16U | value : value << 16U | next;
  }
  return value & place.mask;
}

double Image::number(const Place& place) const noexcept {
  const std::uint32_t value = raw(place);
  if (!place.is_signed) return value;
  return place.bits == 32 ? static_cast<std::int32_t>(value)
                          : static_cast<std::int16_t>(static_cast<std::uint16_t>(value));
}

bool Image::holds(const Condition& condition) const noexcept {
  return std::find(condition.is.begin(), condition.is.end(), raw(condition.place)) != condition.is.end();
}

Words to_words(const Place& place, double value) noexcept {
  if (of_bits(place.table)) return {{static_cast<std::uint16_t>(value != 0 ? 1 : 0), 0}, 1};
  const double steps = place.bits == 32 ? 4294967296.0 : 65536.0;
  const double least = place.is_signed ? -steps / 2 : 0;
  const double most = place.is_signed ? steps / 2 - 1 : steps - 1;
  const double rounded = std::isfinite(value) ? std::round(std::clamp(value, least, most)) : 0;
  const auto raw = static_cast<std::uint32_t>(static_cast<std::int64_t>(rounded));
  const auto low = static_cast<std::uint16_t>(raw);
  const auto high = static_cast<std::uint16_t>(raw >> 16U);
  if (place.bits != 32) return {{low, 0}, 1};
  return place.low_word_first ? Words{{low, high}, 2} : Words{{high, low}, 2};
}

}  // namespace rmac::fieldbus::modbus
