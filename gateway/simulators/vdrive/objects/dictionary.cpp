#include "gateway/simulators/vdrive/objects/dictionary.hpp"

#include <algorithm>

namespace rmac::vdrive {
namespace {

using fieldbus::eds::bits_of;
using fieldbus::eds::bytes_of;
using fieldbus::eds::DataType;
using fieldbus::eds::DeviceDescription;
using fieldbus::eds::is_signed;
using fieldbus::eds::readable;
using fieldbus::eds::settable_by_pdo;
using fieldbus::eds::tellable_by_pdo;
using fieldbus::eds::writable;

// Abort codes (CiA 301, 7.2.4.3.17, table 22)
constexpr std::uint32_t kWriteOnly = 0x06010001;
constexpr std::uint32_t kReadOnly = 0x06010002;
constexpr std::uint32_t kNoObject = 0x06020000;
constexpr std::uint32_t kNotMappable = 0x06040041;
constexpr std::uint32_t kTooLong = 0x06070012;
constexpr std::uint32_t kTooShort = 0x06070013;
constexpr std::uint32_t kNoSubindex = 0x06090011;
constexpr std::uint32_t kTooHigh = 0x06090031;
constexpr std::uint32_t kTooLow = 0x06090032;

constexpr std::uint16_t kFirstCommunication = 0x1000;
constexpr std::uint16_t kLastCommunication = 0x1FFF;

std::int64_t number_of(const Bytes& bytes, DataType type) noexcept {
  std::uint64_t raw = 0;
  for (std::size_t i = 0; i < bytes.size() && i < 8; ++i) raw |= std::uint64_t{bytes[i]} << (8 * i);
  const unsigned bits = bits_of(type);
  const bool negative = is_signed(type) && bits < 64 && (raw >> (bits - 1) & 1U) != 0;
  return static_cast<std::int64_t>(negative ? raw | ~std::uint64_t{0} << bits : raw);
}

/// Bits of a dummy entry: a data type in the place of an object.
unsigned dummy_bits(std::uint16_t index) {
  constexpr std::uint16_t kLastDummy = 7;
  return index >= 1 && index <= kLastDummy ? bits_of(static_cast<DataType>(index)) : 0U;
}

}  // namespace

Dictionary::Dictionary(const DeviceDescription& sheet, std::uint8_t node, std::optional<std::uint32_t> serial_number) {
  for (const auto& [address, entry] : sheet.entries) {
    Slot slot{.type = entry.type,
              .access = entry.access,
              .mappable = entry.mappable,
              .least = {},
              .most = {},
              .initial = Bytes(bytes_of(entry.type)),
              .bytes = {}};
    if (entry.initial) slot.initial = entry.initial->bytes_for(node);
    if (entry.configured) slot.initial = entry.configured->bytes_for(node);
    if (serial_number && address == ObjectAddress{0x1018, 4}) {
      for (unsigned i = 0; i < slot.initial.size(); ++i) {
        slot.initial[i] = static_cast<std::uint8_t>(*serial_number >> (8 * i));
      }
    }
    if (entry.least) slot.least = entry.least->number_for(node, entry.type);
    if (entry.most) slot.most = entry.most->number_for(node, entry.type);
    slot.bytes = slot.initial;
    slots_.emplace(address, std::move(slot));
  }
}

std::uint32_t Dictionary::absent(ObjectAddress object) const {
  const auto first = slots_.lower_bound({object.index, 0});
  return first != slots_.end() && first->first.index == object.index ? kNoSubindex : kNoObject;
}

std::uint32_t Dictionary::read(ObjectAddress object, Bytes& bytes) {
  const auto found = slots_.find(object);
  if (found == slots_.end()) return absent(object);
  if (!readable(found->second.access)) return kWriteOnly;
  if (before_read) before_read(object);
  bytes = found->second.bytes;
  return 0;
}

std::uint32_t Dictionary::write(ObjectAddress object, const Bytes& bytes) {
  const auto found = slots_.find(object);
  if (found == slots_.end()) return absent(object);
  Slot& slot = found->second;
  if (!writable(slot.access)) return kReadOnly;
  const std::size_t size = bytes_of(slot.type);
  if (size != 0 && bytes.size() != size) return bytes.size() > size ? kTooLong : kTooShort;
  const std::int64_t value = number_of(bytes, slot.type);
  if (slot.most && value > *slot.most) return kTooHigh;
  if (slot.least && value < *slot.least) return kTooLow;
  if (before_write) {
    if (const std::uint32_t code = before_write(object, value); code != 0) return code;
  }
  slot.bytes = bytes;
  if (after_write) after_write(object);
  return 0;
}

std::int64_t Dictionary::number(std::uint16_t index, std::uint8_t sub) const noexcept {
  const auto found = slots_.find({index, sub});
  return found == slots_.end() ? 0 : number_of(found->second.bytes, found->second.type);
}

void Dictionary::set(ObjectAddress object, std::int64_t value) noexcept {
  const auto found = slots_.find(object);
  if (found == slots_.end()) return;
  Bytes& bytes = found->second.bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * std::min<std::size_t>(i, 7)));
  }
}

std::uint32_t Dictionary::check_mapping(std::uint32_t entry, bool setpoint) const {
  const ObjectAddress object{static_cast<std::uint16_t>(entry >> 16), static_cast<std::uint8_t>(entry >> 8)};
  const unsigned bits = entry & 0xFF;
  if (object.index < kFirstCommunication) {
    return setpoint && object.sub == 0 && bits % 8 == 0 && bits != 0 && dummy_bits(object.index) == bits ? 0
                                                                                                         : kNotMappable;
  }
  const auto found = slots_.find(object);
  if (found == slots_.end()) return absent(object);
  const Slot& slot = found->second;
  const bool direction = setpoint ? settable_by_pdo(slot.access) : tellable_by_pdo(slot.access);
  return slot.mappable && direction && bits_of(slot.type) == bits ? 0 : kNotMappable;
}

const Bytes* Dictionary::bytes(ObjectAddress object) const {
  const auto found = slots_.find(object);
  return found == slots_.end() ? nullptr : &found->second.bytes;
}

void Dictionary::take(ObjectAddress object, const std::uint8_t* bytes) {
  const auto found = slots_.find(object);
  if (found == slots_.end()) return;  // a dummy
  Bytes& into = found->second.bytes;
  std::copy_n(bytes, into.size(), into.begin());
  if (after_write) after_write(object);
}

void Dictionary::restore(bool communication_only) {
  for (auto& [address, slot] : slots_) {
    const bool communication = address.index >= kFirstCommunication && address.index <= kLastCommunication;
    if (communication_only && !communication) continue;
    const auto kept = stored_.find(address);
    slot.bytes = kept == stored_.end() ? slot.initial : kept->second;
  }
}

void Dictionary::store() {
  stored_.clear();
  // Commands are no parameters: a drive that was enabled when it stored must not come up so.
  for (const auto& [address, slot] : slots_) {
    if (writable(slot.access) && address.index != 0x6040 && address.index != 0x1003) stored_[address] = slot.bytes;
  }
}

}  // namespace rmac::vdrive
