#include "rmac/fieldbus/canopen/emergency.hpp"

#include <array>

namespace rmac::fieldbus::canopen {
namespace {

/// `mask` says how much of a code counts: from the exact code down to its class.
struct Text {
  std::uint16_t code;
  std::uint16_t mask;
  const char* text;
};

constexpr std::array kTexts{
    Text{0x0000, 0xFFFF, "no error, or error reset"},
    Text{0x2310, 0xFFFF, "continuous over-current"},
    Text{0x2320, 0xFFFF, "short circuit or earth leakage at the output"},
    Text{0x2330, 0xFFFF, "earth leakage"},
    Text{0x2340, 0xFFFF, "short circuit"},
    Text{0x3110, 0xFFF0, "mains over-voltage"},
    Text{0x3120, 0xFFF0, "mains under-voltage"},
    Text{0x3130, 0xFFF0, "mains phase failure"},
    Text{0x3210, 0xFFF0, "DC link over-voltage"},
    Text{0x3220, 0xFFF0, "DC link under-voltage"},
    Text{0x4110, 0xFFFF, "ambient temperature too high"},
    Text{0x4210, 0xFFFF, "device temperature too high"},
    Text{0x4310, 0xFFFF, "drive temperature too high"},
    Text{0x5110, 0xFFF0, "low-voltage supply"},
    Text{0x5440, 0xFFF0, "contacts of the device"},
    Text{0x5530, 0xFFF0, "non-volatile memory"},
    Text{0x6010, 0xFFFF, "software reset by the watchdog"},
    Text{0x6320, 0xFFFF, "parameter error"},
    Text{0x7120, 0xFFFF, "motor error"},
    Text{0x7121, 0xFFFF, "motor blocked"},
    Text{0x7122, 0xFFFF, "motor error or commutation malfunction"},
    Text{0x7300, 0xFF00, "position or speed sensor"},
    Text{0x7500, 0xFF00, "communication inside the drive"},
    Text{0x8110, 0xFFFF, "CAN overrun: frames lost"},
    Text{0x8120, 0xFFFF, "CAN controller is error passive"},
    Text{0x8130, 0xFFFF, "heartbeat of the master missing"},
    Text{0x8140, 0xFFFF, "recovered from bus-off"},
    Text{0x8150, 0xFFFF, "CAN identifier sent by two nodes"},
    Text{0x8210, 0xFFFF, "PDO not processed: wrong length"},
    Text{0x8220, 0xFFFF, "PDO longer than mapped"},
    Text{0x8230, 0xFFFF, "destination object of a PDO not available"},
    Text{0x8240, 0xFFFF, "SYNC of unexpected length"},
    Text{0x8250, 0xFFFF, "setpoints missing: RPDO time-out"},
    Text{0x8311, 0xFFFF, "torque too high"},
    Text{0x8400, 0xFF00, "speed control"},
    Text{0x8611, 0xFFFF, "following error"},
    Text{0x8612, 0xFFFF, "reference limit"},
    Text{0x8700, 0xFF00, "SYNC control"},
    Text{0x8000, 0xFE00, "monitoring of communication"},
    Text{0x8200, 0xFF00, "protocol error"},
    Text{0x1000, 0xFF00, "generic error"},
    Text{0x2000, 0xF000, "current"},
    Text{0x3000, 0xF000, "voltage"},
    Text{0x4000, 0xF000, "temperature"},
    Text{0x5000, 0xF000, "device hardware"},
    Text{0x6000, 0xF000, "device software"},
    Text{0x7000, 0xF000, "additional modules"},
    Text{0x8000, 0xF000, "monitoring"},
    Text{0x9000, 0xFF00, "external error"},
    Text{0xF000, 0xFF00, "additional functions"},
    Text{0xFF00, 0xFF00, "an error of the maker's own"},
};

}  // namespace

const char* emergency_text(std::uint16_t code) noexcept {
  for (const Text& entry : kTexts) {
    if ((code & entry.mask) == entry.code) return entry.text;
  }
  return "a code that the standards leave open";
}

}  // namespace rmac::fieldbus::canopen
