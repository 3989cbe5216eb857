#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rmac/fieldbus/modbus/client.hpp"

namespace rmac::fieldbus::modbus {

/// Where a number stands: one bit, one register, or two that make 32 bits. Addresses are those of the frame, from 0.
struct Place {
  Table table = Table::HoldingRegisters;
  std::uint16_t address = 0;
  std::uint8_t bits = 16;           ///< 16 or 32; of a table of bits 1
  bool is_signed = false;           ///< two's complement
  bool low_word_first = false;      ///< of 32 bits: the register with the lower address has the lower half
  std::uint32_t mask = 0xFFFFFFFF;  ///< bits that belong to it

  [[nodiscard]] std::size_t count() const noexcept { return bits == 32 ? 2 : 1; }
};

/// A number with a physical meaning: raw = value × `per_unit`.
struct Quantity {
  Place place;
  double per_unit = 1;
};

/// True while the masked number is one of `is`.
struct Condition {
  Place place;
  std::vector<std::uint32_t> is;
};

/// One value written to one address.
struct RegisterWrite {
  Table table = Table::HoldingRegisters;
  std::uint16_t address = 0;
  std::uint16_t value = 0;
};

/// How a spindle drive is commanded and watched. Written in order; each list may be several writes.
struct SpindleMap {
  std::string name;
  std::string manual;
  /// What speeds count: Hz of the output, or parts of the drive's largest output frequency.
  enum class Unit : std::uint8_t { Hertz, OfMaximum };

  std::size_t most_per_read = 1;  ///< registers, or bits, that the drive gives in one answer
  Quantity speed_command;
  Unit speed_command_unit = Unit::Hertz;
  std::optional<Place> speed_read_back;  ///< shows what the drive took as its speed command, in its scale
  Quantity speed;                        ///< actual, Hz; without sign unless the place is signed
  std::optional<Condition> running;
  std::optional<Condition> backward;  ///< turns backward
  std::optional<Condition> tripped;   ///< without it, a fault code other than 0 is a fault
  std::optional<Place> fault_code;
  std::map<std::uint32_t, std::string> fault_texts;
  std::vector<RegisterWrite> forward_run, backward_run, stop, reset_fault;
};

/// Bits of a device for inputs and outputs.
struct BitRange {
  Place place;            ///< of the first; registers carry 16 bits each, the lowest first
  std::size_t count = 0;  ///< bits
  std::size_t first = 0;  ///< bit of the I/O interface that the first one is
  bool inverted = false;

  [[nodiscard]] std::size_t addresses() const noexcept { return of_bits(place.table) ? count : (count + 15) / 16; }
};

struct IoMap {
  std::string name;
  std::string manual;
  std::size_t most_per_read = 1;
  std::vector<BitRange> inputs, outputs;
};

/// What no schema can say: entries that overlap, addresses beyond the last, values that do not fit, a fault that
/// nothing tells. The error names the entries.
[[nodiscard]] Expected<> check(const SpindleMap& map);
[[nodiscard]] Expected<> check(const IoMap& map);

}  // namespace rmac::fieldbus::modbus
