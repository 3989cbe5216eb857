#include <algorithm>
#include <fstream>
#include <iterator>

#include "canopen/boot_plan.hpp"
#include "places.hpp"
#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace {

using namespace rmac;
using namespace rmac::fieldbus;
using namespace rmac::fieldbus::test;
using rmac::fieldbus::canopen::FindDescription;

std::string sheet_of_virtual_drive() {
  std::ifstream stream(RMAC_SOURCE_DIR "/gateway/simulators/vdrive/rmac-vdrive.eds", std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Puts `line` behind the line `after` of section `section`, or takes the line `after` out where `line` is empty.
std::string changed(std::string text, const std::string& section, const std::string& after, const std::string& line) {
  const std::size_t at = text.find("[" + section + "]\n");
  EXPECT_NE(at, std::string::npos) << section;
  const std::size_t found = text.find(after + "\n", at);
  EXPECT_NE(found, std::string::npos) << after;
  text.replace(found, after.size(), line);
  return text;
}

/// Finds one file, whatever name is asked for.
FindDescription holding(const std::string& text) {
  return [text](const std::string& kind, const std::string& name) {
    return eds::parse_device_description(text, name + "." + kind);
  };
}

std::string answer(const std::string& file, const Texts& texts, const Numbers& more = {}) {
  Numbers numbers = more;
  numbers["node"] = {5};
  const auto config = canopen::read_canopen_config("can0", numbers, texts, 0.001, holding(file));
  return config ? "accepted" : config.error().message;
}

/// Where a section of the unchanged file begins: "drive.eds:12".
std::string place(const std::string& text, const std::string& section) {
  const auto at = static_cast<std::ptrdiff_t>(text.find("[" + section + "]\n"));
  return "drive.eds:" + std::to_string(1 + std::count(text.begin(), text.begin() + at, '\n'));
}

const std::string kAt = "CANopenInterface, bus can0: ";

TEST(DeviceDescriptionCheck, AcceptsWhatTheDriveHas) {
  EXPECT_EQ(answer(sheet_of_virtual_drive(), {{"eds", "drive"}}), "accepted");
  EXPECT_EQ(answer(sheet_of_virtual_drive(), {{"eds_0", "drive"},
                                              {"rpdo", "6040:00/16 607A:00/32 6071:00/16"},
                                              {"tpdo", "6041:00/16 60FD:00/32"},
                                              {"setup", "6085:00/32=70000 2000:01/32=-5"}}),
            "accepted");
}

TEST(DeviceDescriptionCheck, NamesTheLineOfWhatCannotBeMapped) {
  const std::string good = sheet_of_virtual_drive();
  EXPECT_EQ(answer(good, {{"eds", "drive"}, {"tpdo", "6041:00/16 6066:00/16"}}),
            kAt + "axis 0: " + place(good, "6066") +
                ": 6066h:00 (Following error time out) cannot be mapped into a PDO (PDOMapping)");
  EXPECT_EQ(answer(good, {{"eds", "drive"}, {"tpdo", "6041:00/16 6079:00/32"}}),
            kAt + "axis 0: drive.eds: the device has no 6079h:00, which is mapped by tpdo");
  EXPECT_EQ(answer(good, {{"eds", "drive"}, {"tpdo", "6041:00/16 60F4:00/16"}}),
            kAt + "axis 0: " + place(good, "60F4") +
                ": 60F4h:00 (Following error actual value) has 32 bits, and 16 are mapped");
  EXPECT_EQ(answer(changed(good, "6071", "AccessType=rw", "AccessType=ro"), {{"eds", "drive"}}),
            kAt + "axis 0: " + place(good, "6071") + ": 6071h:00 (Target torque) cannot be set by a PDO (AccessType)");
  EXPECT_EQ(answer(good, {{"eds", "drive"}, {"tpdo", "6041:00/16 6064:00/32 6041:00/16"}}),
            kAt + "tpdo: 6041h:00 is mapped twice");
}

TEST(DeviceDescriptionCheck, NamesTheLineOfADummyThatTheDriveCannotMap) {
  const std::string good = sheet_of_virtual_drive();
  const Texts texts{{"eds", "drive"}, {"rpdo", "6040:00/16 0006:00/16 6071:00/16"}};
  EXPECT_EQ(answer(good, texts), "accepted");
  const std::string without = changed(good, "DummyUsage", "Dummy0006=1", "Dummy0006=0");
  const auto line = std::count(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(good.find("Dummy0006")), '\n');
  EXPECT_EQ(answer(without, texts),
            kAt + "axis 0: drive.eds:" + std::to_string(1 + line) + ": 0006h:00 (Dummy0006) cannot fill room in a PDO");
}

TEST(DeviceDescriptionCheck, NamesTheLineOfWhatCannotBeWritten) {
  const std::string good = sheet_of_virtual_drive();
  EXPECT_EQ(answer(good, {{"eds", "drive"}, {"setup", "6502:00/32=1"}}),
            kAt + "axis 0: " + place(good, "6502") +
                ": 6502h:00 (Supported drive modes) cannot be written, and it would be at boot "
                "(AccessType)");
  EXPECT_EQ(answer(good, {{"eds", "drive"}, {"setup", "6085:00/16=1"}}),
            kAt + "axis 0: " + place(good, "6085") +
                ": 6085h:00 (Quick stop deceleration) has 4 bytes, and 2 would be written");
  EXPECT_EQ(answer(good, {{"eds", "drive"}, {"setup", "605A:00/16=9"}}),
            kAt + "axis 0: " + place(good, "605A") +
                ": 605Ah:00 (Quick stop option code) would be set to 9, which is beyond its limits "
                "in the file");
  EXPECT_EQ(answer(good, {{"eds", "drive"}, {"setup", "3000:00/16=9"}}),
            kAt + "axis 0: drive.eds: the device has no 3000h:00, which is written at boot");
  EXPECT_EQ(answer(changed(good, "1600sub0", "AccessType=rw", "AccessType=const"), {{"eds", "drive"}}),
            kAt + "axis 0: " + place(good, "1600sub0") +
                ": 1600h:00 (Number of mapped objects) cannot be written, and it would be at boot "
                "(AccessType)");
}

TEST(DeviceDescriptionCheck, HoldsNodeAndBitRateAgainstTheFile) {
  const std::string good = sheet_of_virtual_drive();
  EXPECT_EQ(answer(good + "[DeviceComissioning]\nNodeID=6\n", {{"dcf", "x"}}),
            kAt + "axis 0: x.dcf configures node 6, not node 5");
  EXPECT_EQ(answer(good + "[DeviceComissioning]\nNodeID=5\nBaudrate=250\n", {{"dcf", "x"}}),
            kAt + "axis 0: x.dcf configures 250000 bit/s, and bit_rate is 1000000");
  EXPECT_EQ(answer(changed(good, "DeviceInfo", "BaudRate_1000=1", "BaudRate_1000=0"), {{"eds", "x"}}),
            kAt +
                "axis 0: x.eds: the device does not know 1000000 bit/s; it knows 10000, 20000, 50000, 125000, 250000, "
                "500000, 800000");
  EXPECT_EQ(answer(good, {{"eds", "x"}, {"dcf", "x"}}),
            kAt + "axis 0 names both eds and dcf; a DCF says all that its EDS says");
}

TEST(DeviceDescriptionCheck, TakesIdentityAndMappingFromADcf) {
  std::string file = sheet_of_virtual_drive();
  file = changed(file, "DeviceInfo", "VendorNumber=0", "VendorNumber=0x1A1");
  file = changed(file, "1A00sub0", "DefaultValue=1", "DefaultValue=1\nParameterValue=2");
  file = changed(file, "1A00sub2", "DefaultValue=0", "ParameterValue=0x606C0020");
  const auto config = canopen::read_canopen_config("can0", {{"node", {5}}}, {{"dcf", "x"}}, 0.001, holding(file));
  ASSERT_TRUE(config.has_value()) << config.error().message;
  const canopen::AxisConfig& axis = config->axes.at(0);
  EXPECT_EQ(axis.identity.vendor_id, 0x1A1U);
  EXPECT_EQ(axis.identity.product_code, 0x402U);
  ASSERT_EQ(axis.answers.size(), 2U);
  EXPECT_EQ(axis.answers[1].object, (ObjectAddress{0x606C, 0}));
  EXPECT_EQ(axis.setpoints.at(1).object, (ObjectAddress{0x6071, 0})) << "what the file leaves open goes by the mode";
}

TEST(DeviceDescriptionCheck, WritesNoDomains) {
  std::string file = sheet_of_virtual_drive();
  file = changed(file, "6081", "DataType=0x0007", "DataType=0x000F\nParameterValue=firmware.bin");
  const auto config = canopen::read_canopen_config("can0", {{"node", {5}}}, {{"dcf", "x"}}, 0.001, holding(file));
  ASSERT_TRUE(config.has_value()) << config.error().message;
  for (const auto& step : canopen::boot_plan(*config, 5, nullptr)) EXPECT_NE(step.object, (ObjectAddress{0x6081, 0}));
}

TEST_F(CanopenBench, WritesTheValuesOfADcfAtBootBeforeTheSetup) {
  std::string file = changed(sheet_of_virtual_drive(), "DeviceInfo", "ProductNumber=0x402", "ProductNumber=0");
  file = changed(file, "6085", "DefaultValue=131072000", "ParameterValue=4000");
  file = changed(file, "6081", "DefaultValue=1310720", "ParameterValue=0x12345678");
  file = changed(file, "6040", "DefaultValue=0", "ParameterValue=15");
  file = changed(file, "1017", "DefaultValue=0", "ParameterValue=999");
  file = changed(file, "1029sub1", "DefaultValue=0", "ParameterValue=1");
  VirtualDrive& drive = wire_.add(5);
  drive.power_off();
  drive.set(0x1029, 1, 0, 1);
  drive.set(0x6081, 0, 0, 4);
  drive.power_on(wire_.now());
  auto config = canopen::read_canopen_config("can0", {{"node", {5}}}, {{"dcf", "x"}, {"setup", "6085:00/32=70000"}},
                                             kPeriodS, holding(file));
  ASSERT_TRUE(config.has_value()) << config.error().message;
  make_from(*config);
  start();
  EXPECT_EQ(drive.value(0x6081, 0), 0x12345678U);
  EXPECT_EQ(drive.value(0x6085, 0), 70000U);
  EXPECT_EQ(drive.value(0x1029, 1), 1U);
  EXPECT_EQ(drive.value(0x1017, 0), 50U) << "the heartbeat is the master's";
  EXPECT_EQ(drive.value(0x6040, 0), 0U) << "a file must not enable a drive";
}

}  // namespace
