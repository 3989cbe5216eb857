#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rmac/fieldbus/modbus/client.hpp"

namespace rmac::fieldbus::modbus {

/// One question to one slave: read or write `count` values of a table.
struct Request {
  int slave = 0;
  bool writes = false;
  Table table = Table::HoldingRegisters;
  std::uint16_t address = 0;
  std::size_t count = 0;
};

/// How many values of this kind fit into a frame (V1.1b3, 6).
[[nodiscard]] std::size_t most_values(const Request& request) noexcept;

/// The question as it goes on the wire between header and checksum: slave, function, data. `values` are written; bits
/// as zero or not.
[[nodiscard]] std::vector<std::uint8_t> encode(const Request& request, std::span<const std::uint16_t> values);

enum class Verdict : std::uint8_t { Fits, Exception, Wrong };

struct Decoded {
  Verdict verdict = Verdict::Wrong;
  int exception_code = 0;
};

/// Whether `answer` (slave, function, data) is that to `question`, which `encode` made of `request`. Reads fill
/// `values`, of `request.count`; nothing is written into it unless the answer fits.
[[nodiscard]] Decoded decode(const Request& request, std::span<const std::uint8_t> question,
                             std::span<const std::uint8_t> answer, std::span<std::uint16_t> values) noexcept;

/// The exception codes of the protocol (V1.1b3, 7) in words.
[[nodiscard]] const char* exception_text(int code) noexcept;

}  // namespace rmac::fieldbus::modbus
