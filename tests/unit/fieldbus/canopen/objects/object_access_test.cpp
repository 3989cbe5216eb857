#include "rmac/fieldbus/canopen/object_access.hpp"

#include <gmock/gmock.h>

#include "rmac/fieldbus/canopen/object_meaning.hpp"
#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace {

using namespace rmac;
using namespace rmac::fieldbus;
using namespace rmac::fieldbus::canopen;
using namespace rmac::fieldbus::test;
using testing::HasSubstr;
using testing::StartsWith;

class ObjectAccess : public CanopenBench {
 protected:
  std::string read(ObjectAddress object, std::uint8_t node = 3) {
    const auto port = wire_.open();
    const auto bytes = read_object(*port, node, object);
    return bytes ? value_text(object, meaning_of(object, nullptr), *bytes) : bytes.error().message;
  }
  std::string write(ObjectAddress object, const Bytes& bytes) {
    const auto port = wire_.open();
    auto done = check_moves_nothing(*port, 3, object, bytes);
    if (done) done = write_object(*port, 3, object, bytes);
    return done ? "written" : done.error().message;
  }
};

TEST_F(ObjectAccess, ReadsANumberWithWhatItStandsFor) {
  wire_.add(3).set(0x6041, 0, 0x0250, 2);
  EXPECT_EQ(read({0x6041, 0}), "0250h (switch on disabled)");
  EXPECT_EQ(read({0x1018, 4}), "00000403h");
}

TEST_F(ObjectAccess, ReadsNamesOfAnyLength) {
  VirtualDrive& drive = wire_.add(3);
  for (const std::size_t length : {1U, 4U, 5U, 7U, 8U, 29U, 200U, 5000U}) {
    const std::string name(length, 'n');
    drive.set_bytes({0x1008, 0}, Bytes(name.begin(), name.end()));
    EXPECT_EQ(read({0x1008, 0}), name);
  }
}

TEST_F(ObjectAccess, TellsTheNodesReasonInWords) {
  wire_.add(3).refuse_reading({0x6064, 0}, 0x08000022);
  EXPECT_EQ(read({0x5FFF, 0}), "node 3 refused 5FFFh:00: object does not exist in the object dictionary (06020000h)");
  EXPECT_THAT(read({0x6064, 0}), HasSubstr("present device state (08000022h)"));
}

/// An abort code of 0 says nothing, and is a refusal all the same.
TEST_F(ObjectAccess, TakesARefusalWithoutReasonForOne) {
  wire_.add(3).power_off();
  wire_.listen = [this](const CanFrame& frame) {
    if (frame.id == 0x603) {
      wire_.inject({.id = 0x583, .size = 8, .data = {0x80, frame.data[1], frame.data[2], frame.data[3]}});
    }
  };
  EXPECT_THAT(read({0x6064, 0}), StartsWith("node 3 refused 6064h:00"));
}

TEST_F(ObjectAccess, SaysThatNobodyAnswers) {
  wire_.add(3);
  EXPECT_THAT(read({0x6041, 0}, 4), HasSubstr("node 4 does not answer"));
}

TEST_F(ObjectAccess, WritesWhatCanBeReadBack) {
  wire_.add(3).set(0x6081, 0, 0, 4);
  EXPECT_EQ(write({0x6081, 0}, {0x20, 0x4E, 0, 0}), "written");
  EXPECT_EQ(read({0x6081, 0}), "20000 velocity units");
}

TEST_F(ObjectAccess, GivesNoMotorPower) {
  VirtualDrive& drive = wire_.add(3, 2);
  for (const std::uint16_t index : std::array<std::uint16_t, 2>{0x6040, 0x6840}) {
    for (const std::uint8_t low : Bytes{0x0F, 0x1F, 0x3F}) {
      EXPECT_THAT(write({index, 0}, {low, 0}), HasSubstr("rmac bus move")) << int{low};
      EXPECT_EQ(drive.value(index, 0), 0U);
    }
    EXPECT_EQ(write({index, 0}, {0x07, 0}), "written");
    EXPECT_EQ(drive.value(index, 0), 7U);
  }
}

/// Whichever axis has it: a value of the node may concern all of them.
TEST_F(ObjectAccess, WritesNothingWhileAMotorHasPowerButWhatTakesIt) {
  constexpr std::uint32_t kEnabled = 0x0237, kQuickStop = 0x0217, kFaultReaction = 0x021F, kSwitchedOn = 0x0233,
                          kFault = 0x0218;
  VirtualDrive& drive = wire_.add(3, 2);
  drive.set(0x6081, 0, 0, 4);
  for (const std::uint16_t axis : std::array<std::uint16_t, 2>{0, kAxisOffset}) {
    const auto statusword = static_cast<std::uint16_t>(0x6041 + axis);
    for (const std::uint32_t word : {kEnabled, kQuickStop, kFaultReaction}) {
      drive.set(statusword, 0, word, 2);
      EXPECT_THAT(write({0x6081, 0}, {1, 0, 0, 0}), HasSubstr("has power on its motor")) << statusword << " " << word;
      EXPECT_EQ(drive.value(0x6081, 0), 0U);
      EXPECT_EQ(write({static_cast<std::uint16_t>(0x6040 + axis), 0}, {0, 0}), "written");
    }
    for (const std::uint32_t word : {kSwitchedOn, kFault}) {
      drive.set(statusword, 0, word, 2);
      EXPECT_EQ(write({0x6081, 0}, {0, 0, 0, 0}), "written");
    }
  }
}

TEST_F(ObjectAccess, WritesToANodeThatIsNoDrive) {
  VirtualDrive& node = wire_.add(3);
  node.remove(0x6041);
  node.set(0x2000, 0, 0, 2);
  EXPECT_EQ(write({0x2000, 0}, {5, 0}), "written");
}

TEST(ObjectAddress, IsReadAsPeopleWriteIt) {
  const ObjectAddress statusword{0x6041, 0};
  for (const char* text : {"6041", "6041:0", "6041:00", "0x6041:0", "0X6041", "6041h", "6041h:00", "6041H:0h"}) {
    const auto object = read_object_address(text);
    ASSERT_TRUE(object.has_value()) << text;
    EXPECT_EQ(*object, statusword) << text;
  }
  EXPECT_EQ(*read_object_address("1a00:10"), (ObjectAddress{0x1A00, 0x10})) << "sub-indices are hexadecimal, too";
  for (const char* text : {"", ":", ":0", "6041:", "60411", "6041:100", "6041/0", "statusword", "-6041", "0x", "h",
                           "6041 0", "6041:0:0", "0x6041h"}) {
    EXPECT_FALSE(read_object_address(text).has_value()) << text;
  }
}

TEST(ObjectMeaning, IsTheSheetsWhereItSaysSomething) {
  eds::DeviceDescription sheet;
  sheet.entries[{0x6041, 0}].name = "Status";
  sheet.entries[{0x6041, 0}].type = eds::DataType::Unsigned16;
  sheet.entries[{0x2001, 3}].name = "Gain";
  sheet.entries[{0x2001, 3}].type = eds::DataType::Integer16;
  EXPECT_EQ(object_text({0x6041, 0}, meaning_of({0x6041, 0}, &sheet)), "6041h:00 Status");
  const ObjectMeaning gain = meaning_of({0x2001, 3}, &sheet);
  EXPECT_EQ(value_text({0x2001, 3}, gain, Bytes{0xFE, 0xFF}), "-2");
  EXPECT_EQ(object_text({0x2001, 4}, meaning_of({0x2001, 4}, &sheet)), "2001h:04");
}

TEST(ObjectMeaning, IsTheStandardsForEachAxisOtherwise) {
  EXPECT_EQ(meaning_of({0x6064, 0}, nullptr).name, "Position actual value");
  EXPECT_EQ(meaning_of({0x7864, 0}, nullptr).name, "Position actual value");
  EXPECT_EQ(meaning_of({0x8064, 0}, nullptr).name, "") << "there are four axes";
  EXPECT_EQ(value_text({0x6861, 0}, meaning_of({0x6861, 0}, nullptr), Bytes{10}), "10 (cyclic synchronous torque)");
  EXPECT_EQ(value_text({0x603F, 0}, meaning_of({0x603F, 0}, nullptr), Bytes{0x11, 0x86}), "8611h (following error)");
}

}  // namespace
