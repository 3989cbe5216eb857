#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "gateway/buses/register_map_file.hpp"
#include "gateway/json/schemas.hpp"
#include "places.hpp"
#include "unit/gateway/device_driver_manager/fixtures.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
using fieldbus::modbus::IoMap;
using fieldbus::modbus::SpindleMap;
using fieldbus::modbus::Table;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

const fs::path kMaps = fs::path(RMAC_SOURCE_DIR) / "drivers" / "modules" / "modbus";

json document_of(const fs::path& file) {
  return json::parse(std::ifstream(file));
}

/// A map that is written, read back, and gone.
class ChangedMap {
 public:
  explicit ChangedMap(const json& document) : file_(folder_.write("map.json", document.dump())) {}
  [[nodiscard]] std::string spindle_error() const {
    const auto read = read_spindle_map(file_);
    return read ? "no error" : read.error().message;
  }
  [[nodiscard]] std::string io_error() const {
    const auto read = read_io_map(file_);
    return read ? "no error" : read.error().message;
  }

 private:
  test::TemporaryFolder folder_;
  fs::path file_;
};

TEST(RegisterMaps, AreSoundAsShipped) {
  int spindles = 0;
  for (const auto& entry : fs::directory_iterator(kMaps)) {
    SCOPED_TRACE(entry.path().string());
    const json document = document_of(entry.path());
    EXPECT_GT(document["Manual"].get<std::string>().size(), 20U) << "a map cites its manual";
    EXPECT_TRUE(document.contains("LeftOut")) << "a map says what it leaves out";
    if (document["Kind"] == "Spindle") {
      const auto map = read_spindle_map(entry.path());
      ASSERT_TRUE(map) << map.error().message;
      EXPECT_FALSE(map->backward_run.empty());
      ++spindles;
    } else {
      const auto map = read_io_map(entry.path());
      ASSERT_TRUE(map) << map.error().message;
    }
  }
  EXPECT_EQ(spindles, 5);
}

TEST(RegisterMaps, AreReadAsTheyAreWritten) {
  const auto map = read_spindle_map(kMaps / "hitachi-wj200.json");
  ASSERT_TRUE(map);
  EXPECT_EQ(map->speed.place.address, 0x1000);
  EXPECT_EQ(map->speed.place.bits, 32);
  EXPECT_FALSE(map->speed.place.low_word_first);
  EXPECT_EQ(map->speed.per_unit, 100);
  EXPECT_EQ(map->running->place.table, Table::Coils);
  EXPECT_EQ(map->running->place.bits, 1);
  EXPECT_EQ(map->fault_texts.at(7), "over-voltage (E07)");
  ASSERT_EQ(map->backward_run.size(), 2U);
  EXPECT_EQ(map->backward_run[0].value, 1);
}

TEST(RegisterMaps, NameTheEntryThatIsWrong) {
  const json good = document_of(kMaps / "toshiba-vf-s11.json");
  const auto error = [&good](const std::string& patch) {
    json changed = good;
    changed.merge_patch(json::parse(patch));
    return ChangedMap(changed).spindle_error();
  };
  EXPECT_EQ(error("{}"), "no error");
  EXPECT_THAT(error(R"({"Speed": {"Address": 65536}})"),
              AllOf(HasSubstr("/Speed/Address is 65536"), HasSubstr("0 to 65535, or up to four hexadecimal digits")));
  EXPECT_THAT(error(R"({"Speed": {"Address": "FD0Gh"}})"), HasSubstr("/Speed/Address is \"FD0Gh\""));
  EXPECT_THAT(error(R"({"Stop": null})"), HasSubstr("lacks the key \"Stop\""));
  EXPECT_THAT(error(R"({"Sped": {}})"), HasSubstr("unknown key \"Sped\""));
  EXPECT_THAT(error(R"({"MostPerRead": 2, "Speed": {"Address": "FFFFh", "Bits": 32}})"),
              HasSubstr("Speed (holding registers FFFFh to 10000h) goes beyond address FFFFh"));
  EXPECT_THAT(error(R"({"MostPerRead": 2, "Speed": {"Address": "FD00h", "Bits": 32}})"),
              HasSubstr("Speed (holding registers FD00h to FD01h) and Running (holding register FD01h) overlap"));
  EXPECT_THAT(error(R"({"Speed": {"Address": "FD10h", "Bits": 32}})"), HasSubstr("longer than the 1 that MostPerRead"));
  EXPECT_THAT(error(R"({"SpeedCommand": {"Address": "FA00h"}})"),
              HasSubstr("SpeedCommand (holding register FA00h) and Forward (holding register FA00h) overlap"));
  EXPECT_THAT(error(R"({"SpeedCommand": {"Table": "InputRegisters"}})"), HasSubstr("cannot be written"));
  EXPECT_THAT(error(R"({"Stop": [{"Table": "Coils", "Address": 1, "Value": 7}]})"), HasSubstr("takes 0 or 1"));
  EXPECT_THAT(error(R"({"Running": {"Table": "Coils", "Bits": 32}})"), HasSubstr("Running is a coil"));
  EXPECT_THAT(error(R"({"Fault": {"Tripped": null, "Code": null}})"), HasSubstr("tells a fault"));
}

TEST(RegisterMaps, NameInputsAndOutputsThatOverlap) {
  const json good = document_of(kMaps / "generic-remote-io.json");
  const auto error = [&good](const std::string& patch) {
    json changed = good;
    changed.merge_patch(json::parse(patch));
    return ChangedMap(changed).io_error();
  };
  EXPECT_EQ(error("{}"), "no error");
  EXPECT_THAT(error(R"({"Inputs": [{"Table": "DiscreteInputs", "Address": 0, "Count": 8},
                                   {"Table": "DiscreteInputs", "Address": 7, "Count": 8, "FirstBit": 8}]})"),
              HasSubstr("Inputs/0 (discrete inputs 0000h to 0007h) and Inputs/1 (discrete inputs 0007h to 000Eh) "
                        "overlap"));
  EXPECT_THAT(error(R"({"Inputs": [{"Table": "DiscreteInputs", "Address": 0, "Count": 8},
                                   {"Table": "DiscreteInputs", "Address": 8, "Count": 8, "FirstBit": 7}]})"),
              HasSubstr("fills bits that another one fills already"));
  EXPECT_THAT(error(R"({"Inputs": [{"Table": "DiscreteInputs", "Address": 0, "Count": 8, "FirstBit": 60}]})"),
              HasSubstr("fills bits 60 to 67; there are 64"));
  EXPECT_THAT(error(R"({"Outputs": [{"Table": "DiscreteInputs", "Address": 0, "Count": 8}]})"),
              HasSubstr("cannot be written"));
  EXPECT_THAT(error(R"({"Inputs": null, "Outputs": null})"), HasSubstr("neither inputs nor outputs"));
}

}  // namespace
}  // namespace rmac::gateway
