#include "rmac/fieldbus/eds/device_description.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "places.hpp"

namespace rmac::fieldbus::eds {
namespace {

using testing::HasSubstr;

std::string sheet_of_virtual_drive() {
  std::ifstream stream(RMAC_SOURCE_DIR "/gateway/simulators/vdrive/rmac-vdrive.eds", std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A sheet of one object; `more` stands behind it.
std::string sheet(const std::string& object, const std::string& more = {}) {
  return "[DeviceInfo]\nVendorName=a\n[OptionalObjects]\nSupportedObjects=1\n1=0x2000\n[2000]\n" + object + more;
}

std::string refusal(const std::string& text) {
  const auto read = parse_device_description(text, "drive.eds");
  return read ? "accepted" : read.error().message;
}

DeviceDescription parsed(const std::string& text) {
  auto read = parse_device_description(text, "drive.eds");
  EXPECT_TRUE(read.has_value()) << (read ? "" : read.error().message);
  return read ? std::move(*read) : DeviceDescription();
}

TEST(Eds, TellsDeviceObjectsTypesAccessLimitsAndDefaults) {
  const DeviceDescription drive = parsed(sheet_of_virtual_drive());
  EXPECT_EQ(drive.product_name, "rmac-vdrive");
  EXPECT_EQ(drive.product_number, 0x402U);
  EXPECT_TRUE(drive.bit_rates.contains(1'000'000));
  EXPECT_FALSE(drive.node.has_value());
  const ObjectEntry* torque = drive.find({0x6071, 0});
  ASSERT_NE(torque, nullptr);
  EXPECT_EQ(torque->name, "Target torque");
  EXPECT_EQ(torque->type, DataType::Integer16);
  EXPECT_TRUE(torque->mappable);
  EXPECT_TRUE(settable_by_pdo(torque->access));
  EXPECT_EQ(drive.find({0x6007, 0})->most->number_for(1, DataType::Integer16), 3);
  EXPECT_FALSE(settable_by_pdo(drive.find({0x6041, 0})->access));
  EXPECT_EQ(drive.find({0x60C2, 2})->initial->number_for(1, DataType::Integer8), -3);
  EXPECT_EQ(drive.find({0x1008, 0})->initial->bytes.size(), 11U);
  EXPECT_EQ(drive.find({0x1800, 4}), nullptr);
  EXPECT_TRUE(drive.has(0x1800));
  EXPECT_FALSE(drive.has(0x1900));
}

TEST(Eds, IsReadWithLineEndsAndMarksOfAnySystem) {
  std::string text = "\xEF\xBB\xBF" + sheet_of_virtual_drive();
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2)) text.insert(at, "\r");
  EXPECT_EQ(parsed(text).entries.size(), parsed(sheet_of_virtual_drive()).entries.size());
}

TEST(Eds, IsReadWithLinesOfAnyLengthIndentedOrWithASemicolonInAValue) {
  const std::string long_name(5000, 'n');
  const DeviceDescription drive =
      parsed(sheet("ParameterName=" + long_name + " ; and more\n  DataType=0x0003\n\tAccessType=rw\n"));
  EXPECT_EQ(drive.find({0x2000, 0})->name, long_name + " ; and more");
  EXPECT_EQ(drive.find({0x2000, 0})->type, DataType::Integer16);
}

TEST(Eds, AddsTheNodesIdWhereTheFileSaysSo) {
  const DeviceDescription drive = parsed(sheet_of_virtual_drive());
  const ObjectEntry& id = *drive.find({0x1800, 1});
  EXPECT_EQ(id.initial->number_for(5, id.type), 0x40000185);
  EXPECT_EQ(id.initial->bytes_for(0x7F), (std::vector<std::uint8_t>{0xFF, 1, 0, 0x40}));
}

TEST(Eds, ReadsNumbersOfEveryWriting) {
  const auto number = [](const char* type, const char* text) {
    const auto read = parsed(sheet(std::string("DataType=") + type + "\nAccessType=rw\nDefaultValue=" + text + "\n"));
    const ObjectEntry& entry = *read.find({0x2000, 0});
    return entry.initial->number_for(0, entry.type);
  };
  EXPECT_EQ(number("0x0003", "-32768"), -32768);
  EXPECT_EQ(number("0x0003", "0xFFFF"), -1);
  EXPECT_EQ(number("0x0006", "0xFFFF"), 65535);
  EXPECT_EQ(number("7", "017"), 15);  // octal
  EXPECT_EQ(number("0x001B", "0xFFFFFFFFFFFFFFFF"), -1);
  EXPECT_EQ(number("0x0015", "-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(number("0x0008", "1.5"), 0x3FC00000);
  EXPECT_EQ(number("0x0001", "1"), 1);
}

TEST(Eds, ReadsTheCompactWritingOfArraysAndTheirConfiguredValues) {
  const DeviceDescription drive = parsed(
      sheet("ParameterName=Table\nObjectType=0x8\nDataType=0x0003\nAccessType=rw\nDefaultValue=7\nCompactSubObj=3\n",
            "[2000Value]\nNrOfEntries=1\n2=-9\n[DeviceComissioning]\nNodeID=4\nBaudrate=500\n"));
  EXPECT_EQ(drive.find({0x2000, 0})->initial->bytes, std::vector<std::uint8_t>{3});
  EXPECT_EQ(drive.find({0x2000, 3})->initial->number_for(0, DataType::Integer16), 7);
  EXPECT_FALSE(drive.find({0x2000, 1})->configured.has_value());
  EXPECT_EQ(drive.find({0x2000, 2})->configured->number_for(0, DataType::Integer16), -9);
  EXPECT_EQ(drive.node, 4);
  EXPECT_EQ(drive.bit_rate, 500'000U);
}

TEST(Eds, KnowsThePdosThatAreNotWrittenOut) {
  const std::string counts = "NrOfRXPDO=3\nNrOfTXPDO=5\n";
  const std::string written = "DataType=7\nAccessType=ro\n";
  std::string text = "[DeviceInfo]\nCompactPDO=0x13\n" + counts +
                     "[OptionalObjects]\nSupportedObjects=2\n1=0x1401\n2=0x1601\n[1401]\n" + written + "[1601]\n" +
                     written;
  const DeviceDescription drive = parsed(text);
  // One of three RPDOs is written out, and of five TPDOs none.
  for (const int pdo : {0, 2}) {
    const ObjectEntry* id = drive.find({static_cast<std::uint16_t>(0x1400 + pdo), 1});
    ASSERT_NE(id, nullptr) << pdo;
    EXPECT_EQ(id->initial->number_for(5, id->type), 0x205 + 0x100 * pdo) << "the predefined connection set";
    EXPECT_TRUE(writable(id->access));
    EXPECT_NE(drive.find({static_cast<std::uint16_t>(0x1400 + pdo), 2}), nullptr);
    EXPECT_EQ(drive.find({static_cast<std::uint16_t>(0x1400 + pdo), 3}), nullptr) << "its bit is off";
    EXPECT_EQ(drive.find({static_cast<std::uint16_t>(0x1400 + pdo), 5})->type, DataType::Unsigned16);
    EXPECT_EQ(drive.find({static_cast<std::uint16_t>(0x1400 + pdo), 0})->initial->bytes.at(0), 5);
    for (std::uint8_t sub = 1; sub <= 64; ++sub) {
      const ObjectEntry* mapped = drive.find({static_cast<std::uint16_t>(0x1600 + pdo), sub});
      ASSERT_NE(mapped, nullptr) << int{sub};
      EXPECT_EQ(mapped->type, DataType::Unsigned32);
      EXPECT_TRUE(writable(mapped->access));
    }
    EXPECT_EQ(drive.find({static_cast<std::uint16_t>(0x1600 + pdo), 0})->type, DataType::Unsigned8);
    EXPECT_EQ(drive.find({static_cast<std::uint16_t>(0x1600 + pdo), 65}), nullptr);
  }
  EXPECT_FALSE(writable(drive.find({0x1401, 0})->access)) << "as it is written out";
  EXPECT_FALSE(drive.has(0x1403));
  EXPECT_EQ(drive.find({0x1804, 1})->initial->number_for(5, DataType::Unsigned32), 0x80000000) << "beyond four, off";
  EXPECT_FALSE(drive.has(0x1805));
  EXPECT_EQ(refusal("[DeviceInfo]\nCompactPDO=1\nNrOfRXPDO=513\n"),
            "drive.eds:3: \"513\" is no whole number from 0 to 512");
  text.erase(text.find("CompactPDO=0x13\n"), 16);
  EXPECT_FALSE(parsed(text).has(0x1400));
}

TEST(Eds, SaysWhichOfTheAnnouncedObjectsIsNone) {
  const auto list = [](const std::string& lines) { return refusal("[DeviceInfo]\n[OptionalObjects]\n" + lines); };
  EXPECT_EQ(list("SupportedObjects=2\n1=0x2000\n[2000]\nDataType=3\nAccessType=ro\n"),
            "drive.eds:2: [OptionalObjects] announces 2 objects, and its number 2 is missing");
  for (const std::string number : {"0x10000", "-1", "x", "2000h", "1.5"}) {
    EXPECT_EQ(list("SupportedObjects=1\n1=" + number + "\n"),
              "drive.eds:4: [OptionalObjects] announces 1 objects, and its number 1 is no index from 0 to 0xFFFF");
  }
  EXPECT_EQ(list("SupportedObjects=0x10000\n"), "drive.eds:3: \"0x10000\" is no whole number from 0 to 65535");
}

TEST(Eds, NamesTheLineThatIsWrong) {
  const std::string good = "DataType=0x0003\nAccessType=rw\n";
  EXPECT_EQ(refusal(sheet(good)), "accepted");
  EXPECT_EQ(refusal(sheet(good + "DefaultValue=40000x\n")),
            "drive.eds:9: \"40000x\" is no value of data type 0x0003, 16 bits");
  EXPECT_EQ(refusal(sheet(good + "HighLimit=65536\n")),
            "drive.eds:9: \"65536\" is no value of data type 0x0003, 16 bits");
  EXPECT_EQ(refusal(sheet("DataType=3\nAccessType=rx\n")),
            "drive.eds:8: AccessType is \"rx\"; allowed are ro, wo, rw, rwr, rww and const");
  EXPECT_EQ(refusal(sheet("AccessType=ro\n")), "drive.eds:6: [2000] has no DataType");
  EXPECT_EQ(refusal(sheet(good + "PDOMapping=yes\n")), "drive.eds:9: PDOMapping is \"yes\"; it is 0 or 1");
  EXPECT_EQ(refusal(sheet(good + "AccessType=ro\n")),
            "drive.eds:9: AccessType stands in [2000] for the second time; the first is in line 8");
  EXPECT_EQ(refusal(sheet(good, "[2000]\n")),
            "drive.eds:9: section [2000] stands here for the second time; the first is in line 6");
  EXPECT_EQ(
      refusal(sheet(good, "[2001]\n" + good)),
      "drive.eds:9: [2001] stands in none of [MandatoryObjects], [OptionalObjects] and [ManufacturerObjects]; add it "
      "where it belongs");
  EXPECT_EQ(refusal(sheet(good, "[2000sub1]\n" + good)),
            "drive.eds:9: [2000sub1] belongs to no array or record; [2000] is missing or none");
  EXPECT_EQ(refusal(sheet("ObjectType=9\nSubNumber=2\n[2000sub0]\n" + good)),
            "drive.eds:8: [2000] announces 2 sub-indices, and 1 have a section");
  EXPECT_EQ(refusal("[DeviceInfo]\n[MandatoryObjects]\nSupportedObjects=1\n1=0x1000\n"),
            "drive.eds:4: the object is listed, and there is no section [1000]");
  EXPECT_EQ(refusal("[DeviceInfo]\nthis\n"),
            "drive.eds:2: this is neither a section, nor name=value, nor a comment behind a semicolon");
  EXPECT_EQ(refusal("[DeviceInfo]\nVendorName: a\n"),
            "drive.eds:2: this is neither a section, nor name=value, nor a comment behind a semicolon");
  EXPECT_EQ(refusal("[DeviceInfo] and more\n"), "drive.eds:1: a section is written [Name]");
  EXPECT_EQ(refusal("VendorName=a\n[DeviceInfo]\n"), "drive.eds:1: a value stands before the first section");
  EXPECT_EQ(refusal("; nothing\n"), "drive.eds:1: there is no section [DeviceInfo]; this is no EDS or DCF file");
}

TEST(Eds, SaysWhichFileCannotBeRead) {
  const auto read = read_device_description("/no/such/drive.eds");
  ASSERT_FALSE(read.has_value());
  EXPECT_EQ(read.error().message, "/no/such/drive.eds: the file cannot be read");
}

/// The same as a DCF, which says values and which node they are for.
std::string configuration_of_virtual_drive() {
  std::string text = sheet_of_virtual_drive();
  constexpr std::string_view kDefault = "\nDefaultValue=";
  for (std::size_t at = 0; (at = text.find(kDefault, at)) != std::string::npos; at += kDefault.size()) {
    if (at % 3 == 0) text.insert(at, "\nParameterValue=0x1");
  }
  return text + "\n[DeviceComissioning]\nNodeID=5\nNodeName=left\nBaudrate=1000\nNetNumber=1\n";
}

/// Whatever the bytes are: an answer, or an error that names a line of the file.
void expect_damage_is_refused_by_line(const std::string& good) {
  const auto lines = static_cast<std::size_t>(std::count(good.begin(), good.end(), '\n'));
  std::mt19937 random(306);  // NOLINT: the same damage in every run
  const auto below = [&](std::size_t bound) {
    return std::uniform_int_distribution<std::size_t>(0, bound - 1)(random);
  };
  constexpr std::string_view kTokens = "=[];\n0x$NODEID+-9sub";
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string text = good;
    for (std::size_t damage = 1 + below(4); damage > 0; --damage) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
        case 0:
          text[at] = static_cast<char>(below(256));
          break;
        case 1:
          text.insert(at, 1, kTokens[below(kTokens.size())]);
          break;
        case 2:
          text.erase(at, 1 + below(40));
          break;
        default:
          text.insert(at, text.substr(below(text.size()), below(80)));
          break;
      }
    }
    if (below(20) == 0) text.resize(below(text.size()));
    const auto read = parse_device_description(text, "drive.eds");
    if (read) continue;
    ++refused;
    const std::string& message = read.error().message;
    ASSERT_TRUE(message.starts_with("drive.eds:")) << message;
    const std::size_t line = std::stoul(message.substr(10));
    ASSERT_GE(line, 1U) << message;
    ASSERT_LE(line, 2 * lines) << message;
  }
  EXPECT_GT(refused, 40);
  EXPECT_LT(refused, 400);
}

TEST(Eds, RefusesDamagedFilesByLine) {
  expect_damage_is_refused_by_line(sheet_of_virtual_drive());
}

TEST(Dcf, RefusesDamagedFilesByLine) {
  expect_damage_is_refused_by_line(configuration_of_virtual_drive());
}

}  // namespace
}  // namespace rmac::fieldbus::eds
