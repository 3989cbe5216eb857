#include "gateway/tools/tool_shape.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace rmac::gateway {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr double kLength_mm = 80;

json ball_mill() {
  return {{"DC", 6},
          {"RE", 3},
          {"APMX", 10},
          {"LCF", 12},
          {"OAL", 57},
          {"ZEFP", 2},
          {"FHA", 30},
          {"BMC", "HM"},
          {"Modes", {{{"Frequency", 900}, {"DampingRatio", 0.03}, {"Stiffness", 8000}}}},
          {"Shank",
           {{{"Cone", {{"Radius", 2.9}, {"TopRadius", 3}, {"Height", 5}}}},
            {{"Cylinder", {{"Radius", 3}, {"Height", 40}}}}}},
          {"Holder",
           {{{"Cone", {{"Radius", 10}, {"TopRadius", 14}, {"Height", 30}}}},
            {{"Cylinder", {{"Radius", 25}, {"Height", 15}}}}}}};
}

std::string refusal(const json& shape) {
  const auto read = read_tool_shape(shape, kLength_mm);
  return read ? "taken" : read.error().message;
}

TEST(ToolShape, GivesBackWhatItRead) {
  const auto shape = read_tool_shape(ball_mill(), kLength_mm);
  ASSERT_TRUE(shape) << shape.error().message;
  EXPECT_EQ(to_json(*shape), ball_mill());
  EXPECT_DOUBLE_EQ(shape->holder_begins(kLength_mm), 35);
}

TEST(ToolShape, GoesOnAsThickAsItCutsUnlessAShankIsGiven) {
  json plain{{"DC", 8}, {"LCF", 20}, {"OAL", 80}};
  const auto shape = read_tool_shape(plain, kLength_mm);
  ASSERT_TRUE(shape) << shape.error().message;
  ASSERT_EQ(shape->shank.size(), 1u);
  EXPECT_EQ(shape->shank[0].bottom_radius, 4);
  EXPECT_EQ(shape->shank[0].height, 60);
  EXPECT_EQ(shape->apmx, 20);
}

TEST(ToolShape, IsRefusedWhereItsPartsDoNotFit) {
  const auto with = [](const char* key, const json& value) {
    json shape = ball_mill();
    shape[key] = value;
    return refusal(shape);
  };
  EXPECT_THAT(with("RE", 3.1), HasSubstr("/Shape/RE is 3.1; allowed is at most half of DC, 3"));
  EXPECT_THAT(with("APMX", 13), HasSubstr("/Shape/APMX is 13"));
  EXPECT_THAT(with("OAL", 11), HasSubstr("/Shape/LCF is 12"));
  EXPECT_THAT(with("LCF", 2), HasSubstr("/Shape/APMX"));
  EXPECT_THAT(with("Shank", {{{"Cylinder", {{"Radius", 3}, {"Height", 40}}}}}),
              HasSubstr("/Shape/Shank is 40 mm high"));
  EXPECT_THAT(with("Holder", json::array()), HasSubstr("they leave a gap"));
  EXPECT_THAT(with("Holder", {{{"Cylinder", {{"Radius", 3}, {"Height", 81}}}}}),
              HasSubstr("/Shape/Holder is 81 mm high"));
}

}  // namespace
}  // namespace rmac::gateway
