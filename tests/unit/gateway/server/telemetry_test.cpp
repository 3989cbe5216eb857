#include "gateway/server/telemetry.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace rmac::gateway {
namespace {

using nlohmann::json;

// Red when a state of a drive has another's text, or takes bits into account that say nothing of it.
TEST(Telemetry, NamesEachStateOfADriveWhateverItsOtherBits) {
  // CiA 402-2, statuswords and states.
  const std::pair<std::uint16_t, const char*> states[] = {
      {0x00, "not ready to switch on"}, {0x40, "switch on disabled"},
      {0x21, "ready to switch on"},     {0x23, "switched on"},
      {0x27, "operation enabled"},      {0x07, "quick stop active"},
      {0x0F, "fault reaction active"},  {0x08, "fault"}};
  for (const auto& [word, text] : states) {
    for (const unsigned others : {0x0000U, 0x0010U, 0x0080U, 0x0290U, 0xFF90U}) {
      EXPECT_STREQ(drive_state(static_cast<std::uint16_t>(word | others)), text) << std::hex << (word | others);
    }
  }
  for (const unsigned word : {0x00U, 0x40U, 0x0FU, 0x08U}) {  // bit 5 is of no account there
    EXPECT_STREQ(drive_state(static_cast<std::uint16_t>(word | 0x20U)), drive_state(static_cast<std::uint16_t>(word)))
        << std::hex << word;
  }
  EXPECT_STREQ(drive_state(0x01), "unknown");
}

}  // namespace
}  // namespace rmac::gateway
