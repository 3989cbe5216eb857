#include "canopen/object_list.hpp"

#include <gtest/gtest.h>

namespace rmac::fieldbus::canopen {
namespace {

using Octets = std::vector<std::uint8_t>;

TEST(Mapping, IsReadAsItIsWritten) {
  const auto objects = read_mapping("6040:00/16  1a00:fF/8\n607A:0/0x20");
  ASSERT_TRUE(objects) << objects.error().message;
  EXPECT_EQ(*objects, (std::vector<MappedObject>{{{0x6040, 0}, 16}, {{0x1A00, 0xFF}, 8}, {{0x607A, 0}, 32}}));
  EXPECT_TRUE(read_mapping("")->empty());
}

TEST(Mapping, RefusesWhatIsNoObject) {
  for (const char* const text :
       {"6040",        "6040:00",     "6040/16",     "6040:00/",    ":00/16",      "6040:/16",
        "6040/16:00",  "/16:6040",    "6040:100/16", "16040:00/16", "6040:00/16x", "6040:00x/16",
        "x6040:00/16", "6040:00/-8",  "6040:00/0",   "6040:00/7",   "6040:00/12",  "6040:00/33",
        "6040:00/40",  "6040:00/256", "6040:00/0x",  "6040::00/16"}) {
    EXPECT_FALSE(read_mapping(text)) << text;
  }
  for (const char* const text : {"6040:00/8", "6040:00/16", "6040:00/24", "6040:00/32"})
    EXPECT_TRUE(read_mapping(text));
}

TEST(Mapping, HoldsEightBytes) {
  EXPECT_TRUE(read_mapping("6040:00/32 6041:00/32"));
  EXPECT_FALSE(read_mapping("6040:00/32 6041:00/32 6060:00/8"));
}

/// With a sign or without: whatever has so many bits.
TEST(Setup, TakesValuesThatFitTheirBits) {
  struct Case {
    const char* text;
    Octets bytes;
  };
  for (const Case& one :
       {Case{"2000:01/8=255", {0xFF}}, Case{"2000:01/8=-128", {0x80}}, Case{"2000:01/8=0", {0}},
        Case{"2000:01/16=65535", {0xFF, 0xFF}}, Case{"2000:01/16=-32768", {0x00, 0x80}},
        Case{"2000:01/24=0x123456", {0x56, 0x34, 0x12}}, Case{"2000:01/32=4294967295", {0xFF, 0xFF, 0xFF, 0xFF}},
        Case{"2000:01/32=-2147483648", {0, 0, 0, 0x80}}}) {
    const auto writes = read_setup(one.text);
    ASSERT_TRUE(writes) << writes.error().message;
    ASSERT_EQ(writes->size(), 1U);
    EXPECT_EQ((*writes)[0].object, (ObjectAddress{0x2000, 1}));
    EXPECT_EQ((*writes)[0].bytes, one.bytes) << one.text;
  }
  for (const char* const text :
       {"2000:01/8=256", "2000:01/8=-129", "2000:01/16=65536", "2000:01/16=-32769", "2000:01/32=4294967296",
        "2000:01/32=-2147483649", "2000:01/8=", "2000:01/8", "=5", "2000:01/8=5=6", "2000:01/9=5", "2000:01/8=x"}) {
    EXPECT_FALSE(read_setup(text)) << text;
  }
  EXPECT_EQ(read_setup("2000:01/8=1 2001:02/8=2")->at(1).object, (ObjectAddress{0x2001, 2}));
}

TEST(Words, StandOnceEachAndAsLongAsTheyAre) {
  const auto said = [](const Expected<>& checked) { return checked ? "sound" : checked.error().message; };
  const auto setpoints = [&](const char* text) { return said(check_setpoints(*read_mapping(text))); };
  const auto answers = [&](const char* text) { return said(check_answers(*read_mapping(text))); };
  EXPECT_EQ(setpoints("6040:00/16 0005:00/8 0005:00/8 0006:00/16 0006:00/16"), "sound") << "dummies fill room";
  EXPECT_EQ(setpoints("6040:00/16 6040:00/16"), "6040h:00 is mapped twice");
  EXPECT_EQ(setpoints("6040:00/8"), "6040h:00 has 16 bits, not 8");
  EXPECT_EQ(setpoints("6071:00/16"), "6040h:00 is missing");
  EXPECT_EQ(setpoints("6040:00/16 2000:00/16"), "2000h:00 has no value that the master could send");
  EXPECT_EQ(setpoints("6040:00/16 0005:00/16"), "0005h:00 has 8 bits, not 16");
  EXPECT_EQ(setpoints("6040:00/16 6041:00/16"), "6041h:00 has no value that the master could send");
  EXPECT_EQ(answers("6041:00/16 2000:00/16"), "sound") << "a sensor's, which somebody else reads";
  EXPECT_EQ(answers("6041:00/16 2000:00/16 2000:00/16"), "2000h:00 is mapped twice");
  EXPECT_EQ(answers("6064:00/32"), "6041h:00 is missing");
  EXPECT_EQ(answers("6064:00/32 6041:00/16"), "sound") << "wherever it stands";
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
