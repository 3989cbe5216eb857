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
  const json told = drives_of(sample);
  EXPECT_EQ(told["statusword"], json::parse("[39,8]"));
  EXPECT_EQ(told["state"], json::parse(R"(["operation enabled","fault"])"));
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

TEST(DrivesTopic, NamesEachStateAsTheStandardDoes) {
  CycleSample sample;
  sample.actuator_count = 4;
  sample.statusword = {0x07, 0x0F, 0x23, 0x01};
  EXPECT_EQ(drives_of(sample)["state"],
            json::parse(R"(["quick stop active","fault reaction active","switched on","unknown"])"));
}

}  // namespace
}  // namespace rmac::gateway
