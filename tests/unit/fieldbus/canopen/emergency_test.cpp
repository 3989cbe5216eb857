#include "rmac/fieldbus/canopen/emergency.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace {

using rmac::fieldbus::canopen::emergency_text;

/// Codes from one to another, both included (CiA 301, table 26, and CiA 402-2, annex).
struct Range {
  unsigned first, last;
  const char* text;
};

constexpr std::array kClasses{Range{0x1000, 0x10FF, "generic error"},
                              Range{0x2000, 0x2FFF, "current"},
                              Range{0x3000, 0x3FFF, "voltage"},
                              Range{0x4000, 0x4FFF, "temperature"},
                              Range{0x5000, 0x5FFF, "device hardware"},
                              Range{0x6000, 0x6FFF, "device software"},
                              Range{0x7000, 0x7FFF, "additional modules"},
                              Range{0x8000, 0x8FFF, "monitoring"},
                              Range{0x9000, 0x90FF, "external error"},
                              Range{0xF000, 0xF0FF, "additional functions"},
                              Range{0xFF00, 0xFFFF, "an error of the maker's own"}};

/// Within the classes.
constexpr std::array kGroups{Range{0x3110, 0x311F, "mains over-voltage"},
                             Range{0x3120, 0x312F, "mains under-voltage"},
                             Range{0x3130, 0x313F, "mains phase failure"},
                             Range{0x3210, 0x321F, "DC link over-voltage"},
                             Range{0x3220, 0x322F, "DC link under-voltage"},
                             Range{0x5110, 0x511F, "low-voltage supply"},
                             Range{0x5440, 0x544F, "contacts of the device"},
                             Range{0x5530, 0x553F, "non-volatile memory"},
                             Range{0x7300, 0x73FF, "position or speed sensor"},
                             Range{0x7500, 0x75FF, "communication inside the drive"},
                             Range{0x8000, 0x81FF, "monitoring of communication"},
                             Range{0x8200, 0x82FF, "protocol error"},
                             Range{0x8400, 0x84FF, "speed control"},
                             Range{0x8700, 0x87FF, "SYNC control"}};

/// Within the groups: one code each.
struct Single {
  unsigned code;
  const char* text;
};
constexpr std::array kSingles{Single{0x0000, "no error, or error reset"},
                              Single{0x2310, "continuous over-current"},
                              Single{0x2320, "short circuit or earth leakage at the output"},
                              Single{0x2330, "earth leakage"},
                              Single{0x2340, "short circuit"},
                              Single{0x4110, "ambient temperature too high"},
                              Single{0x4210, "device temperature too high"},
                              Single{0x4310, "drive temperature too high"},
                              Single{0x6010, "software reset by the watchdog"},
                              Single{0x6320, "parameter error"},
                              Single{0x7120, "motor error"},
                              Single{0x7121, "motor blocked"},
                              Single{0x7122, "motor error or commutation malfunction"},
                              Single{0x8110, "CAN overrun: frames lost"},
                              Single{0x8120, "CAN controller is error passive"},
                              Single{0x8130, "heartbeat of the master missing"},
                              Single{0x8140, "recovered from bus-off"},
                              Single{0x8150, "CAN identifier sent by two nodes"},
                              Single{0x8210, "PDO not processed: wrong length"},
                              Single{0x8220, "PDO longer than mapped"},
                              Single{0x8230, "destination object of a PDO not available"},
                              Single{0x8240, "SYNC of unexpected length"},
                              Single{0x8250, "setpoints missing: RPDO time-out"},
                              Single{0x8311, "torque too high"},
                              Single{0x8611, "following error"},
                              Single{0x8612, "reference limit"}};

const char* standard_text(unsigned code) {
  for (const Single& single : kSingles) {
    if (single.code == code) return single.text;
  }
  for (const Range& group : kGroups) {
    if (code >= group.first && code <= group.last) return group.text;
  }
  for (const Range& of_class : kClasses) {
    if (code >= of_class.first && code <= of_class.last) return of_class.text;
  }
  return "a code that the standards leave open";
}

// Red when a code, or a neighbour of one, is told in the words of another.
TEST(Emergency, TellsACodeElseItsGroupElseItsClass) {
  for (unsigned code = 0; code <= 0xFFFF; ++code) {
    ASSERT_STREQ(emergency_text(static_cast<std::uint16_t>(code)), standard_text(code)) << std::hex << code;
  }
}

}  // namespace
