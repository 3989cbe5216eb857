#include "eds/compact_pdo.hpp"

#include <array>

namespace rmac::fieldbus::eds {
namespace {

constexpr std::uint8_t kMostMapped = 64;

/// By sub-index: the highest one, identifier, transmission type, inhibit time, reserved, event timer, SYNC start value.
constexpr std::array kCommunicationTypes{DataType::Unsigned8,  DataType::Unsigned32, DataType::Unsigned8,
                                         DataType::Unsigned16, DataType::Unsigned8,  DataType::Unsigned16,
                                         DataType::Unsigned8};

class Adder {
 public:
  Adder(const CompactPdos& pdos, std::map<ObjectAddress, ObjectEntry>& entries) : pdos_(pdos), entries_(entries) {}

  /// `first_id` is that of node 0's first PDO in the predefined connection set (CiA 301, 7.3.5), which has four.
  void add(std::uint16_t communication, unsigned count, std::uint32_t first_id) {
    unsigned left = count;
    for (unsigned i = 0; i < kMostPdos && left > 0; ++i) {
      if (written(communication + i)) --left;
    }
    for (unsigned i = 0; i < kMostPdos; ++i) {
      const bool is_written = written(communication + i);
      if (!is_written && left == 0) continue;
      if (!is_written) --left;
      constexpr unsigned kPredefined = 4;
      constexpr std::uint32_t kInvalid = 0x80000000;
      const auto index = static_cast<std::uint16_t>(communication + i);
      if (!has(index)) add_communication(index, i < kPredefined ? first_id + 0x100 * i : kInvalid, i < kPredefined);
      if (!has(index + kMapping)) add_mapping(static_cast<std::uint16_t>(index + kMapping));
    }
  }

 private:
  static constexpr unsigned kMapping = 0x200;  ///< from communication to mapping parameters

  [[nodiscard]] bool has(unsigned index) const {
    const auto first = entries_.lower_bound({static_cast<std::uint16_t>(index), 0});
    return first != entries_.end() && first->first.index == index;
  }
  [[nodiscard]] bool written(unsigned communication) const {
    return has(communication) || has(communication + kMapping);
  }
  ObjectEntry& put(std::uint16_t index, unsigned sub, DataType type, Access access) {
    ObjectEntry& entry = entries_[{index, static_cast<std::uint8_t>(sub)}];
    entry.type = type;
    entry.access = access;
    entry.line = pdos_.line;
    return entry;
  }
  void add_communication(std::uint16_t index, std::uint32_t id, bool plus_node_id) {
    std::uint8_t highest = 0;
    for (std::uint8_t sub = 1; sub < kCommunicationTypes.size(); ++sub) {
      if ((pdos_.subs >> (sub - 1U) & 1U) == 0) continue;
      highest = sub;
      ObjectEntry& entry = put(index, sub, kCommunicationTypes.at(sub), Access::ReadWrite);
      if (sub != 1) continue;
      entry.initial = Value{{static_cast<std::uint8_t>(id), static_cast<std::uint8_t>(id >> 8),
                             static_cast<std::uint8_t>(id >> 16), static_cast<std::uint8_t>(id >> 24)},
                            plus_node_id};
    }
    put(index, 0, kCommunicationTypes[0], Access::Constant).initial = Value{{highest}};
  }
  void add_mapping(std::uint16_t index) {
    put(index, 0, DataType::Unsigned8, Access::ReadWrite);
    for (unsigned sub = 1; sub <= kMostMapped; ++sub) put(index, sub, DataType::Unsigned32, Access::ReadWrite);
  }

  const CompactPdos& pdos_;
  std::map<ObjectAddress, ObjectEntry>& entries_;
};

}  // namespace

void add_compact_pdos(const CompactPdos& pdos, std::map<ObjectAddress, ObjectEntry>& entries) {
  Adder adder(pdos, entries);
  adder.add(0x1400, pdos.rpdos, 0x200);
  adder.add(0x1800, pdos.tpdos, 0x180);
}

}  // namespace rmac::fieldbus::eds
