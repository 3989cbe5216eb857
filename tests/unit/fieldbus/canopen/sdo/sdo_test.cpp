#include "rmac/fieldbus/canopen/sdo.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace {

using namespace rmac::fieldbus::canopen;

/// CiA 301, 7.2.4.3.17, table 22.
struct Abort {
  std::uint32_t code;
  const char* text;
};
constexpr std::array kTable22{
    Abort{0x05030000, "toggle bit not alternated"},
    Abort{0x05040000, "SDO protocol timed out"},
    Abort{0x05040001, "command specifier not valid or unknown"},
    Abort{0x05040002, "invalid block size"},
    Abort{0x05040003, "invalid sequence number"},
    Abort{0x05040004, "CRC error"},
    Abort{0x05040005, "out of memory"},
    Abort{0x06010000, "unsupported access to an object"},
    Abort{0x06010001, "attempt to read a write-only object"},
    Abort{0x06010002, "attempt to write a read-only object"},
    Abort{0x06020000, "object does not exist in the object dictionary"},
    Abort{0x06040041, "object cannot be mapped to the PDO"},
    Abort{0x06040042, "number and length of the objects to be mapped would exceed the PDO length"},
    Abort{0x06040043, "general parameter incompatibility"},
    Abort{0x06040047, "general internal incompatibility in the device"},
    Abort{0x06060000, "access failed due to a hardware error"},
    Abort{0x06070010, "data type does not match, length of service parameter does not match"},
    Abort{0x06070012, "data type does not match, length of service parameter too high"},
    Abort{0x06070013, "data type does not match, length of service parameter too low"},
    Abort{0x06090011, "sub-index does not exist"},
    Abort{0x06090030, "invalid value for parameter"},
    Abort{0x06090031, "value of parameter written too high"},
    Abort{0x06090032, "value of parameter written too low"},
    Abort{0x06090036, "maximum value is less than minimum value"},
    Abort{0x060A0023, "resource not available: SDO connection"},
    Abort{0x08000000, "general error"},
    Abort{0x08000020, "data cannot be transferred or stored to the application"},
    Abort{0x08000021, "data cannot be transferred or stored because of local control"},
    Abort{0x08000022, "data cannot be transferred or stored because of the present device state"},
    Abort{0x08000023, "object dictionary dynamic generation fails or no object dictionary is present"},
    Abort{0x08000024, "no data available"}};

// Red when a person reads of another reason than the drive gave.
TEST(SdoAbort, IsToldInTheStandardsWords) {
  for (const Abort& abort : kTable22) EXPECT_STREQ(sdo_abort_text(abort.code), abort.text) << std::hex << abort.code;
}

TEST(SdoAbort, OfNoStandardIsNamedAsTheMakers) {
  const std::string makers = "a code of the device's maker; see its manual";
  for (const std::uint32_t code : {0x00000000U, 0x05030001U, 0x06040040U, 0x08000025U, 0x0F00FFC0U, 0xFFFFFFFFU}) {
    EXPECT_EQ(sdo_abort_text(code), makers) << std::hex << code;
  }
}

}  // namespace
