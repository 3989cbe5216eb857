#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rmac::fieldbus {

/// Where an entry of an object dictionary stands.
struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  [[nodiscard]] auto operator<=>(const ObjectAddress&) const noexcept = default;
};

/// "6040h:00", as the standards write it.
[[nodiscard]] std::string to_string(ObjectAddress address);

}  // namespace rmac::fieldbus

namespace rmac::fieldbus::eds {

/// Data types by their own index in the object dictionary (CiA 301, 7.4.7, table 44).
enum class DataType : std::uint16_t {
  Boolean = 0x01,
  Integer8 = 0x02,
  Integer16 = 0x03,
  Integer32 = 0x04,
  Unsigned8 = 0x05,
  Unsigned16 = 0x06,
  Unsigned32 = 0x07,
  Real32 = 0x08,
  VisibleString = 0x09,
  OctetString = 0x0A,
  UnicodeString = 0x0B,
  TimeOfDay = 0x0C,
  TimeDifference = 0x0D,
  Domain = 0x0F,
  Integer24 = 0x10,
  Real64 = 0x11,
  Integer40 = 0x12,
  Integer48 = 0x13,
  Integer56 = 0x14,
  Integer64 = 0x15,
  Unsigned24 = 0x16,
  Unsigned40 = 0x18,
  Unsigned48 = 0x19,
  Unsigned56 = 0x1A,
  Unsigned64 = 0x1B,
};

/// Bits of a value; 0 where the length is free (strings, domains) or the type is the maker's own.
[[nodiscard]] std::uint8_t bits_of(DataType type) noexcept;
/// Bytes that a value takes in an SDO; 0 where the length is free.
[[nodiscard]] inline std::size_t bytes_of(DataType type) noexcept {
  return (bits_of(type) + 7U) / 8U;
}
[[nodiscard]] bool is_signed(DataType type) noexcept;
[[nodiscard]] bool is_real(DataType type) noexcept;

/// Who may do what with an entry (CiA 306-1, AccessType). The process reads an output and writes an input, so only the
/// first may be set by an RPDO, and only the second told by a TPDO; `ReadWrite` alone allows both.
enum class Access : std::uint8_t { ReadOnly, WriteOnly, ReadWrite, ReadWriteInput, ReadWriteOutput, Constant };

[[nodiscard]] inline bool readable(Access access) noexcept {
  return access != Access::WriteOnly;
}
[[nodiscard]] inline bool writable(Access access) noexcept {
  return access != Access::ReadOnly && access != Access::Constant;
}
[[nodiscard]] inline bool settable_by_pdo(Access access) noexcept {
  return writable(access) && access != Access::ReadWriteInput;
}
[[nodiscard]] inline bool tellable_by_pdo(Access access) noexcept {
  return readable(access) && access != Access::ReadWriteOutput;
}

/// A value as SDO carries it, little-endian; some hold the id of whichever node it is for ("$NODEID+0x180").
struct Value {
  std::vector<std::uint8_t> bytes;
  bool plus_node_id = false;

  [[nodiscard]] std::vector<std::uint8_t> bytes_for(std::uint8_t node) const;
  /// As a whole number of `type`; the first eight bytes of what is none.
  [[nodiscard]] std::int64_t number_for(std::uint8_t node, DataType type) const noexcept;
};

/// One entry of an object dictionary, as a file describes it.
struct ObjectEntry {
  std::string name;
  DataType type = DataType::Unsigned32;
  Access access = Access::ReadWrite;
  bool mappable = false;
  std::optional<Value> least;
  std::optional<Value> most;
  std::optional<Value> initial;     ///< DefaultValue
  std::optional<Value> configured;  ///< ParameterValue, of a DCF
  std::size_t line = 0;             ///< of its section in the file
};

}  // namespace rmac::fieldbus::eds
