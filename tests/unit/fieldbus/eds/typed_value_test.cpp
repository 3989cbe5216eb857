#include "rmac/fieldbus/eds/typed_value.hpp"

#include <gmock/gmock.h>

#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "rmac/fieldbus/eds/type_names.hpp"

namespace {

using namespace rmac::fieldbus::eds;
using testing::HasSubstr;

constexpr std::array kWhole{DataType::Integer8,   DataType::Integer16,  DataType::Integer24,  DataType::Integer32,
                            DataType::Integer40,  DataType::Integer48,  DataType::Integer56,  DataType::Integer64,
                            DataType::Unsigned8,  DataType::Unsigned16, DataType::Unsigned24, DataType::Unsigned32,
                            DataType::Unsigned40, DataType::Unsigned48, DataType::Unsigned56, DataType::Unsigned64};

std::string refusal(std::string_view text, DataType type) {
  const auto bytes = bytes_of_text(text, type);
  return bytes ? "it is taken" : bytes.error().message;
}

std::string round_trip(std::string_view text, DataType type) {
  const auto bytes = bytes_of_text(text, type);
  return bytes ? to_text(value_of(*bytes, type)) : bytes.error().message;
}

/// What is read back of whatever bytes is written as the same bytes.
TEST(TypedValue, WhatIsToldCanBeWritten) {
  std::mt19937_64 random(7);
  for (const DataType type : kWhole) {
    for (int i = 0; i < 200; ++i) {
      std::vector<std::uint8_t> bytes(bytes_of(type));
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(i == 0 ? 0xFF : i == 1 ? 0 : random());
      if (i == 2) bytes.back() = 0x80;
      const std::string text = to_text(value_of(bytes, type));
      const auto written = bytes_of_text(text, type);
      ASSERT_TRUE(written.has_value()) << type_name(type) << " " << text << ": " << written.error().message;
      EXPECT_EQ(*written, bytes) << type_name(type) << " " << text;
    }
  }
}

TEST(TypedValue, HoldsWhatFitsAndNothingBeyond) {
  EXPECT_EQ(round_trip("-128", DataType::Integer8), "-128");
  EXPECT_THAT(refusal("-129", DataType::Integer8), HasSubstr("from -128 to 127"));
  EXPECT_THAT(refusal("128", DataType::Integer8), HasSubstr("no INTEGER8"));
  EXPECT_EQ(round_trip("65535", DataType::Unsigned16), "65535");
  EXPECT_THAT(refusal("65536", DataType::Unsigned16), HasSubstr("from 0 to 65535"));
  EXPECT_THAT(refusal("-1", DataType::Unsigned32), HasSubstr("from 0 to 4294967295"));
  EXPECT_EQ(round_trip("18446744073709551615", DataType::Unsigned64), "18446744073709551615");
  EXPECT_THAT(refusal("18446744073709551616", DataType::Unsigned64), HasSubstr("no UNSIGNED64"));
  EXPECT_EQ(round_trip("-9223372036854775808", DataType::Integer64), "-9223372036854775808");
  EXPECT_THAT(refusal("9223372036854775808", DataType::Integer64), HasSubstr("no INTEGER64"));
  EXPECT_THAT(refusal("2", DataType::Boolean), HasSubstr("no BOOLEAN"));
}

TEST(TypedValue, TakesHexadecimalNumbersAsTheyAreWritten) {
  EXPECT_EQ(round_trip("0x1F", DataType::Unsigned8), "31");
  EXPECT_EQ(round_trip("1Fh", DataType::Unsigned8), "31");
  EXPECT_EQ(round_trip("0xFF", DataType::Integer8), "-1") << "it fills the width";
  EXPECT_THAT(refusal("0x1FF", DataType::Integer8), HasSubstr("no INTEGER8"));
  EXPECT_THAT(refusal("0x", DataType::Unsigned8), HasSubstr("no UNSIGNED8"));
  EXPECT_THAT(refusal("h", DataType::Unsigned8), HasSubstr("no UNSIGNED8"));
  EXPECT_THAT(refusal("1F", DataType::Unsigned8), HasSubstr("0x1F"));
}

TEST(TypedValue, TakesALeadingZeroForNothing) {
  EXPECT_EQ(round_trip("010", DataType::Unsigned8), "10");
  EXPECT_EQ(round_trip("-010", DataType::Integer16), "-10");
  EXPECT_EQ(round_trip("000", DataType::Unsigned8), "0");
  EXPECT_EQ(round_trip("08", DataType::Unsigned8), "8");
}

TEST(TypedValue, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "-", "five", "1.5", "1e3", "1,5", " 5", "5 ", "$NODEID+1", "--5"}) {
    EXPECT_THAT(refusal(text, DataType::Unsigned16), HasSubstr("no UNSIGNED16")) << text;
    EXPECT_THAT(refusal(text, DataType::Integer32), HasSubstr("no INTEGER32")) << text;
  }
  for (const char* text : {"", "inf", "nan", "1e999", "1,5", "five"}) {
    EXPECT_THAT(refusal(text, DataType::Real32), HasSubstr("no REAL32")) << text;
  }
}

TEST(TypedValue, HoldsRealsAndTexts) {
  EXPECT_EQ(round_trip("-0.5", DataType::Real32), "-0.5");
  EXPECT_EQ(round_trip("1e300", DataType::Real64), "1e+300");
  EXPECT_EQ(round_trip("a drive", DataType::VisibleString), "a drive");
  EXPECT_EQ(round_trip("01ff", DataType::Domain), "01 FF");
  EXPECT_THAT(refusal("01f", DataType::OctetString), HasSubstr("pairs of hexadecimal digits"));
}

TEST(TypedValue, TellsBytesThatAreNotOfItsLengthAsTheyAre) {
  const std::array<std::uint8_t, 3> bytes{1, 2, 0xFF};
  EXPECT_EQ(to_text(value_of(bytes, DataType::Unsigned16)), "01 02 FF");
  EXPECT_EQ(to_text(value_of(bytes, DataType::Unsigned32)), "01 02 FF");
  EXPECT_EQ(to_text(value_of({}, DataType::Unsigned8)), "");
}

TEST(TypedValue, GuessesOfAnUnknownTypeNoMoreThanItCan) {
  EXPECT_EQ(to_text(value_of(std::array<std::uint8_t, 2>{0xFF, 0xFF})), "65535");
  const std::string name = "servo";
  const std::vector<std::uint8_t> text(name.begin(), name.end());
  EXPECT_EQ(to_text(value_of(text)), "servo");
  EXPECT_EQ(to_text(value_of(std::array<std::uint8_t, 3>{'a', 7, 'b'})), "61 07 62");
}

TEST(TypedValue, TellsTextThatStaysWithinItsLine) {
  const std::array<std::uint8_t, 6> bytes{'a', '\n', 0xC3, 'b', 0, 0};
  EXPECT_EQ(to_text(value_of(bytes, DataType::VisibleString)), "a\\x0A\\xC3b");
}

TEST(TypeNames, AreReadInEitherSpellingAndAnyCase) {
  for (const DataType type : kWhole) {
    EXPECT_EQ(read_type_name(type_name(type)), type);
  }
  EXPECT_EQ(read_type_name("U16"), DataType::Unsigned16);
  EXPECT_EQ(read_type_name("integer8"), DataType::Integer8);
  EXPECT_EQ(read_type_name("vs"), DataType::VisibleString);
  for (const char* text : {"", "uint16", "u17", "u", "16"}) EXPECT_FALSE(read_type_name(text).has_value()) << text;
}

/// CiA 301's names, and those of CiA 309-3.
TEST(TypeNames, AreThoseOfTheStandards) {
  const std::vector<std::tuple<DataType, std::string, std::string>> names{
      {DataType::Boolean, "BOOLEAN", "b"},
      {DataType::Integer8, "INTEGER8", "i8"},
      {DataType::Integer16, "INTEGER16", "i16"},
      {DataType::Integer24, "INTEGER24", "i24"},
      {DataType::Integer32, "INTEGER32", "i32"},
      {DataType::Integer40, "INTEGER40", "i40"},
      {DataType::Integer48, "INTEGER48", "i48"},
      {DataType::Integer56, "INTEGER56", "i56"},
      {DataType::Integer64, "INTEGER64", "i64"},
      {DataType::Unsigned8, "UNSIGNED8", "u8"},
      {DataType::Unsigned16, "UNSIGNED16", "u16"},
      {DataType::Unsigned24, "UNSIGNED24", "u24"},
      {DataType::Unsigned32, "UNSIGNED32", "u32"},
      {DataType::Unsigned40, "UNSIGNED40", "u40"},
      {DataType::Unsigned48, "UNSIGNED48", "u48"},
      {DataType::Unsigned56, "UNSIGNED56", "u56"},
      {DataType::Unsigned64, "UNSIGNED64", "u64"},
      {DataType::Real32, "REAL32", "r32"},
      {DataType::Real64, "REAL64", "r64"},
      {DataType::VisibleString, "VISIBLE_STRING", "vs"},
      {DataType::OctetString, "OCTET_STRING", "os"},
      {DataType::UnicodeString, "UNICODE_STRING", "us"},
      {DataType::TimeOfDay, "TIME_OF_DAY", "t"},
      {DataType::TimeDifference, "TIME_DIFFERENCE", "td"},
      {DataType::Domain, "DOMAIN", "d"}};
  std::string all;
  for (const auto& [type, name, short_name] : names) {
    EXPECT_EQ(type_name(type), name);
    EXPECT_EQ(read_type_name(name), type);
    EXPECT_EQ(read_type_name(short_name), type);
    all += (all.empty() ? "" : ", ") + short_name;
  }
  EXPECT_EQ(short_type_names(), all);
  EXPECT_EQ(type_name(static_cast<DataType>(0x0123)), "type 0123h");
}

/// Of each whole type, the last that fits on either side and the first that does not.
TEST(TypedValue, HoldsAsFarAsItsBitsGo) {
  for (const DataType type : kWhole) {
    const bool is_signed = type_name(type).starts_with("INT");
    const unsigned bits = 8 * static_cast<unsigned>(bytes_of(type));
    const auto most = (is_signed ? (std::uint64_t{1} << (bits - 1)) : bits == 64 ? 0 : std::uint64_t{1} << bits) - 1;
    const std::string least = is_signed ? "-" + std::to_string(most + 1) : "0";
    EXPECT_EQ(round_trip(std::to_string(most), type), std::to_string(most));
    EXPECT_EQ(round_trip(least, type), least);
    const std::string range = "whole numbers from " + least + " to " + std::to_string(most) + " are one";
    const std::string beyond = most + 1 != 0 ? std::to_string(most + 1) : "18446744073709551616";
    EXPECT_THAT(refusal(beyond, type), HasSubstr(range));
    EXPECT_THAT(refusal(is_signed ? "-" + std::to_string(most + 2) : "-1", type), HasSubstr(range));
  }
}

}  // namespace
