#include "rmac/fieldbus/canopen/object_meaning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

// What a person reads of objects, and how a person writes them.

namespace rmac::fieldbus::canopen {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::string read(std::uint16_t index, const Bytes& bytes, std::uint8_t sub = 0) {
  const ObjectAddress object{index, sub};
  return value_text(object, meaning_of(object, nullptr), bytes);
}

/// CiA 402-2, 6060h, 6061h, 6041h and 603Fh, of each of the axes that a node may have.
TEST(ObjectMeaning, NamesWhatANumberStandsFor) {
  for (const unsigned axis : {0x0000U, 0x0800U, 0x1000U, 0x1800U}) {
    const auto of_axis = [axis](unsigned index) { return static_cast<std::uint16_t>(index + axis); };
    EXPECT_EQ(read(of_axis(0x6060), {8}), "8 (cyclic synchronous position)");
    EXPECT_EQ(read(of_axis(0x6061), {6}), "6 (homing)");
    EXPECT_EQ(read(of_axis(0x6061), {0xFE}), "-2") << "a maker's own mode has no name";
    EXPECT_EQ(read(of_axis(0x6041), {0x37, 0x06}), "0637h (operation enabled)");
    EXPECT_EQ(read(of_axis(0x603F), {0x10, 0x23}), "2310h (continuous over-current)");
    EXPECT_EQ(read(of_axis(0x605A), {6, 0}), "6") << "an object beside them";
    EXPECT_EQ(read(of_axis(0x6040), {0x0F, 0x00}), "000Fh");
  }
  EXPECT_EQ(read(0x605F, {8}), "8");
  EXPECT_EQ(read(0x6062, {8, 0, 0, 0}), "8 position units");
}

TEST(ObjectMeaning, WritesPatternsInTheWidthThatTheyHave) {
  EXPECT_EQ(read(0x1001, {0x05}), "05h");
  EXPECT_EQ(read(0x1000, {0x92, 0x01, 0x02, 0x00}), "00020192h");
  EXPECT_EQ(read(0x1018, {0xA3, 0x01, 0x00, 0x00}, 1), "000001A3h");
}

/// Units of CiA 301 and CiA 402-2, and none where the standards have none.
TEST(ObjectMeaning, SaysInWhichUnitAValueIs) {
  for (const auto& [index, unit] :
       std::vector<std::pair<std::uint16_t, std::string>>{{0x1006, "\u00b5s"},
                                                          {0x1007, "\u00b5s"},
                                                          {0x100C, "ms"},
                                                          {0x1015, "100 \u00b5s"},
                                                          {0x1017, "ms"},
                                                          {0x6062, "position units"},
                                                          {0x6063, "increments"},
                                                          {0x6064, "position units"},
                                                          {0x6065, "position units"},
                                                          {0x6066, "ms"},
                                                          {0x6067, "position units"},
                                                          {0x6068, "ms"},
                                                          {0x606B, "velocity units"},
                                                          {0x606C, "velocity units"},
                                                          {0x6071, "\u2030 of rated torque"},
                                                          {0x6072, "\u2030 of rated torque"},
                                                          {0x6073, "\u2030 of rated current"},
                                                          {0x6074, "\u2030 of rated torque"},
                                                          {0x6075, "mA"},
                                                          {0x6076, "mN\u00b7m"},
                                                          {0x6077, "\u2030 of rated torque"},
                                                          {0x6078, "\u2030 of rated current"},
                                                          {0x6079, "mV"},
                                                          {0x607A, "position units"},
                                                          {0x607C, "position units"},
                                                          {0x607F, "velocity units"},
                                                          {0x6080, "1/min"},
                                                          {0x6081, "velocity units"},
                                                          {0x6083, "acceleration units"},
                                                          {0x6084, "acceleration units"},
                                                          {0x6085, "acceleration units"},
                                                          {0x6087, "\u2030 of rated torque per s"},
                                                          {0x609A, "acceleration units"},
                                                          {0x60B0, "position units"},
                                                          {0x60B1, "velocity units"},
                                                          {0x60B2, "\u2030 of rated torque"},
                                                          {0x60BA, "position units"},
                                                          {0x60BB, "position units"},
                                                          {0x60BC, "position units"},
                                                          {0x60BD, "position units"},
                                                          {0x60F4, "position units"},
                                                          {0x60FF, "velocity units"},
                                                          {0x6086, ""},
                                                          {0x6098, ""},
                                                          {0x605A, ""}}) {
    EXPECT_EQ(meaning_of({index, 0}, nullptr).unit, unit) << std::hex << index;
  }
  for (const std::uint8_t sub : {std::uint8_t{1}, std::uint8_t{2}}) {
    EXPECT_EQ(meaning_of({0x607D, sub}, nullptr).unit, "position units");
    EXPECT_EQ(meaning_of({0x6099, sub}, nullptr).unit, "velocity units");
    for (const unsigned index : {0x608FU, 0x6091U, 0x6092U, 0x60C2U})
      EXPECT_EQ(meaning_of({static_cast<std::uint16_t>(index), sub}, nullptr).unit, "");
  }
}

TEST(ObjectMeaning, IsAPatternWhereItsBitsCount) {
  const std::vector<ObjectAddress> patterns{
      {0x1000, 0}, {0x1001, 0}, {0x1002, 0}, {0x1005, 0}, {0x1010, 1}, {0x1011, 1}, {0x1012, 0}, {0x1014, 0},
      {0x1016, 1}, {0x1018, 1}, {0x1018, 2}, {0x1018, 3}, {0x1018, 4}, {0x603F, 0}, {0x6040, 0}, {0x6041, 0},
      {0x607E, 0}, {0x60B8, 0}, {0x60B9, 0}, {0x60FD, 0}, {0x60FE, 1}, {0x6502, 0}};
  std::size_t found = 0;
  for (unsigned index = 0x1000; index < 0x6800; ++index) {
    for (std::uint8_t sub = 0; sub < 6; ++sub) {
      if (!meaning_of({static_cast<std::uint16_t>(index), sub}, nullptr).is_pattern) continue;
      ++found;
      EXPECT_TRUE(std::ranges::find(patterns, ObjectAddress{static_cast<std::uint16_t>(index), sub}) != patterns.end())
          << std::hex << index;
    }
  }
  EXPECT_EQ(found, patterns.size());
}

TEST(ObjectAddress, IsReadAsPeopleWriteIt) {
  for (const std::string text :
       {"6041", "6041:0", "6041:00", "0x6041", "0X6041:0", "6041h", "6041H:00", "6041h:0x0", "6041:0h"}) {
    const auto read = read_object_address(text);
    ASSERT_TRUE(read) << text;
    EXPECT_EQ(*read, (ObjectAddress{0x6041, 0})) << text;
  }
  EXPECT_EQ(*read_object_address("1018:4"), (ObjectAddress{0x1018, 4}));
  EXPECT_EQ(*read_object_address("ffff:ff"), (ObjectAddress{0xFFFF, 0xFF}));
  for (const std::string text :
       {"",      ":",     ":0",    "6041:", "60410", "10000", "6041:100", "6041:0:0", "6041.0", "6041 0",
        " 6041", "6041 ", "-6041", "+6041", "x",     "0x",    "h",        "60G1",     "6041:h", "0x0x6041"}) {
    const auto read = read_object_address(text);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().message,
              "\"" + text + "\" is no object; write index:sub in hexadecimal, for example 6041:00");
  }
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
