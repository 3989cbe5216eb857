#include "rmac/fieldbus/canopen/sdo.hpp"

#include <algorithm>
#include <array>

namespace rmac::fieldbus::canopen {
namespace {

struct AbortText {
  std::uint32_t code;
  const char* text;
};

constexpr std::array kAbortTexts{
    AbortText{sdo_abort::kToggle, "toggle bit not alternated"},
    AbortText{sdo_abort::kTimeout, "SDO protocol timed out"},
    AbortText{sdo_abort::kCommand, "command specifier not valid or unknown"},
    AbortText{sdo_abort::kBlockSize, "invalid block size"},
    AbortText{sdo_abort::kSequence, "invalid sequence number"},
    AbortText{sdo_abort::kCrc, "CRC error"},
    AbortText{sdo_abort::kMemory, "out of memory"},
    AbortText{0x06010000, "unsupported access to an object"},
    AbortText{0x06010001, "attempt to read a write-only object"},
    AbortText{0x06010002, "attempt to write a read-only object"},
    AbortText{sdo_abort::kNoObject, "object does not exist in the object dictionary"},
    AbortText{0x06040041, "object cannot be mapped to the PDO"},
    AbortText{0x06040042, "number and length of the objects to be mapped would exceed the PDO length"},
    AbortText{0x06040043, "general parameter incompatibility"},
    AbortText{0x06040047, "general internal incompatibility in the device"},
    AbortText{0x06060000, "access failed due to a hardware error"},
    AbortText{sdo_abort::kLength, "data type does not match, length of service parameter does not match"},
    AbortText{0x06070012, "data type does not match, length of service parameter too high"},
    AbortText{0x06070013, "data type does not match, length of service parameter too low"},
    AbortText{sdo_abort::kNoSubindex, "sub-index does not exist"},
    AbortText{0x06090030, "invalid value for parameter"},
    AbortText{0x06090031, "value of parameter written too high"},
    AbortText{0x06090032, "value of parameter written too low"},
    AbortText{0x06090036, "maximum value is less than minimum value"},
    AbortText{sdo_abort::kNoResource, "resource not available: SDO connection"},
    AbortText{sdo_abort::kGeneral, "general error"},
    AbortText{0x08000020, "data cannot be transferred or stored to the application"},
    AbortText{0x08000021, "data cannot be transferred or stored because of local control"},
    AbortText{sdo_abort::kPresentState, "data cannot be transferred or stored because of the present device state"},
    AbortText{0x08000023, "object dictionary dynamic generation fails or no object dictionary is present"},
    AbortText{0x08000024, "no data available"},
};

constexpr std::array<std::uint16_t, 256> make_crc_table() {
  constexpr std::uint16_t kPolynomial = 0x1021;
  std::array<std::uint16_t, 256> table{};
  for (unsigned i = 0; i < table.size(); ++i) {
    auto crc = static_cast<std::uint16_t>(i << 8);
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<std::uint16_t>((crc & 0x8000) != 0 ? crc << 1 ^ kPolynomial : crc << 1);
    }
    table[i] = crc;
  }
  return table;
}

}  // namespace

const char* sdo_abort_text(std::uint32_t code) noexcept {
  const auto found = std::find_if(kAbortTexts.begin(), kAbortTexts.end(),
                                  [code](const AbortText& entry) { return entry.code == code; });
  return found != kAbortTexts.end() ? found->text : "a code of the device's maker; see its manual";
}

std::uint16_t sdo_crc(std::span<const std::uint8_t> bytes, std::uint16_t so_far) noexcept {
  static constexpr auto kTable = make_crc_table();
  for (const std::uint8_t byte : bytes) {
    so_far = static_cast<std::uint16_t>(so_far << 8 ^ kTable[(so_far >> 8 ^ byte) & 0xFF]);
  }
  return so_far;
}

}  // namespace rmac::fieldbus::canopen
