// What a topic's samples say, as clients read them.
#include "gateway/server/telemetry.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace rmac::gateway {
namespace {

using nlohmann::json;

json drives_of(const CycleSample& sample) {
  std::string text;
  append_drives(sample, text);
  return json::parse(text);
}

TEST(DrivesTopic, TellsOfBothMotorsOfAGantry) {
  CycleSample sample;
  sample.joint_count = sample.joint_count_with_held = 1;
  sample.actuator_count = 2;
  sample.statusword = {0x27, 0x08};
  sample.position = {12.5, 99};
  sample.ahead = {0.25, -0.25, 99};
  const json told = drives_of(sample);
  EXPECT_EQ(told["statusword"], json::parse("[39,8]"));
  EXPECT_EQ(told["state"], json::parse(R"(["operation enabled","fault"])"));
  EXPECT_EQ(told["ahead"], json::parse("[0.25,-0.25]"));
  EXPECT_EQ(told["position"], json::parse("[12.5]")) << "they move one joint";
}

TEST(DrivesTopic, TellsOfNoMoreDrivesThanThereAreWhereOneMovesSeveralJoints) {
  CycleSample sample;
  sample.joint_count = 1;
  sample.joint_count_with_held = 2;
  sample.actuator_count = 1;
  sample.statusword = {0x40};
  sample.position = {1, 2};
  const json told = drives_of(sample);
  EXPECT_EQ(told["state"], json::parse(R"(["switch on disabled"])"));
  EXPECT_EQ(told["position"], json::parse("[1,2]")) << "held joints count";
}

// Red when a state of a drive has another's text, or takes bits into account that say nothing of it.
TEST(DrivesTopic, NamesEachStateAsTheStandardDoesWhateverTheOtherBits) {
  // CiA 402-2, statuswords and states.
  const std::pair<std::uint16_t, const char*> states[] = {
      {0x00, "not ready to switch on"}, {0x40, "switch on disabled"},
      {0x21, "ready to switch on"},     {0x23, "switched on"},
      {0x27, "operation enabled"},      {0x07, "quick stop active"},
      {0x0F, "fault reaction active"},  {0x08, "fault"}};
  const auto named = [](unsigned word) {
    CycleSample sample;
    sample.actuator_count = 1;
    sample.statusword = {static_cast<std::uint16_t>(word)};
    return drives_of(sample)["state"][0].get<std::string>();
  };
  for (const auto& [word, text] : states) {
    for (const unsigned others : {0x0000U, 0x0010U, 0x0080U, 0x0290U, 0xFF90U}) {
      EXPECT_EQ(named(word | others), text) << std::hex << (word | others);
    }
  }
  for (const unsigned word : {0x00U, 0x40U, 0x0FU, 0x08U}) {  // bit 5 is of no account there
    EXPECT_EQ(named(word | 0x20U), named(word)) << std::hex << word;
  }
  EXPECT_EQ(named(0x01), "unknown");
}

}  // namespace
}  // namespace rmac::gateway
