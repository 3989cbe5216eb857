#include "rmac/fieldbus/modbus/register_map.hpp"

#include <gmock/gmock.h>

#include "unit/fieldbus/modbus/spindle_drive.hpp"

namespace rmac::fieldbus::modbus {
namespace {

using testing::HasSubstr;

/// What is said of the map of a drive in which something was changed.
std::string spindle_said(const std::function<void(SpindleMap&)>& change) {
  SpindleMap map = spindle_map();
  change(map);
  const auto checked = check(map);
  return checked ? "fine" : checked.error().message;
}

std::string io_said(std::vector<BitRange> inputs, std::vector<BitRange> outputs = {}) {
  const auto checked = check(IoMap{"a device", "", 8, std::move(inputs), std::move(outputs)});
  return checked ? "fine" : checked.error().message;
}

BitRange bits(Table table, std::uint16_t address, std::size_t count, std::size_t first) {
  return {{table, address, static_cast<std::uint8_t>(of_bits(table) ? 1 : 16)}, count, first, false};
}

TEST(ModbusSpindleMap, MayShareARegisterButNotHalfOfAValue) {
  EXPECT_EQ(spindle_said([](SpindleMap&) {}), "fine") << "three conditions of one register";
  const auto with_speed_at = [](std::uint16_t address) {
    return spindle_said([address](SpindleMap& map) {
      map.speed.place = {kHolding, address, 32};
      map.speed_read_back.reset();
    });
  };
  EXPECT_EQ(with_speed_at(kStatus + 1), "fine") << "they touch on both sides";
  EXPECT_EQ(with_speed_at(kStatus - 2), "fine");
  EXPECT_EQ(
      with_speed_at(kStatus - 1),
      "register map a drive: Speed (holding registers 001Fh to 0020h) and Running (holding register 0020h) overlap");
  EXPECT_THAT(with_speed_at(kFault - 1), HasSubstr("Speed (holding registers 0022h to 0023h) and Fault/Code"));
  EXPECT_EQ(spindle_said([](SpindleMap& map) {
              map.speed.place = {Table::InputRegisters, kStatus - 1, 32};
              map.speed_read_back.reset();
            }),
            "fine")
      << "the same addresses of another table are other registers";
}

TEST(ModbusSpindleMap, EndsWithTheLastAddress) {
  EXPECT_EQ(spindle_said([](SpindleMap& map) { map.speed.place = {kHolding, 0xFFFF}; }), "fine");
  EXPECT_EQ(spindle_said([](SpindleMap& map) { map.speed.place = {kHolding, 0xFFFE, 32}; }), "fine");
  EXPECT_THAT(spindle_said([](SpindleMap& map) {
                map.speed.place = {kHolding, 0xFFFF, 32};
              }),
              HasSubstr("Speed (holding registers FFFFh to 10000h) goes beyond address FFFFh"));
}

TEST(ModbusSpindleMap, HasValuesAsLongAsTheirTableAllows) {
  const auto with_running = [](const Place& place) {
    return spindle_said([&place](SpindleMap& map) { map.running->place = place; });
  };
  EXPECT_EQ(with_running({Table::Coils, 0, 1}), "fine");
  EXPECT_THAT(with_running({Table::Coils, 0, 16}), HasSubstr("Running is a coil, which has 1 bit without a sign"));
  EXPECT_THAT(with_running({Table::DiscreteInputs, 0, 1, true}), HasSubstr("Running is a discrete input, which has 1"));
  for (const int wrong : {1, 8, 64}) {
    EXPECT_THAT(with_running({kHolding, 0x100, static_cast<std::uint8_t>(wrong)}),
                HasSubstr("Running has " + std::to_string(wrong) + " bits; a register has 16, and two make 32"));
  }
  EXPECT_EQ(spindle_said([](SpindleMap& map) {
              map.most_per_read = 2;
              map.speed.place = {kHolding, 0x100, 32};
            }),
            "fine");
  EXPECT_THAT(spindle_said([](SpindleMap& map) {
                map.most_per_read = 1;
                map.speed.place = {kHolding, 0x100, 32};
              }),
              HasSubstr("Speed (holding registers 0100h to 0101h) is longer than the 1 that MostPerRead allows"));
}

TEST(ModbusSpindleMap, ChecksEachOfItsEntries) {
  const Place odd{kHolding, 0x100, 8};
  EXPECT_THAT(spindle_said([&](SpindleMap& map) { map.speed_command.place = odd; }), HasSubstr("SpeedCommand has 8"));
  EXPECT_THAT(spindle_said([&](SpindleMap& map) { map.speed.place = odd; }), HasSubstr("Speed has 8"));
  EXPECT_THAT(spindle_said([&](SpindleMap& map) { map.speed_read_back = odd; }), HasSubstr("ReadBack has 8"));
  EXPECT_THAT(spindle_said([&](SpindleMap& map) { map.running->place = odd; }), HasSubstr("Running has 8"));
  EXPECT_THAT(spindle_said([&](SpindleMap& map) { map.backward->place = odd; }), HasSubstr("Reversed has 8"));
  EXPECT_THAT(spindle_said([&](SpindleMap& map) { map.tripped->place = odd; }), HasSubstr("Fault/Tripped has 8"));
  EXPECT_THAT(spindle_said([&](SpindleMap& map) { map.fault_code = odd; }), HasSubstr("Fault/Code has 8"));
  const std::vector<std::pair<std::vector<RegisterWrite> SpindleMap::*, const char*>> lists{
      {&SpindleMap::forward_run, "Forward"},
      {&SpindleMap::backward_run, "Reverse"},
      {&SpindleMap::stop, "Stop"},
      {&SpindleMap::reset_fault, "ResetFault"}};
  for (const auto& [list, name] : lists) {
    const auto with = [&, list = list](std::vector<RegisterWrite> writes) {
      return spindle_said([&](SpindleMap& map) { map.*list = writes; });
    };
    const std::string entry = name;
    EXPECT_EQ(with({}), entry == "Reverse" ? "fine" : "register map a drive: " + entry + " writes nothing");
    EXPECT_THAT(with({{Table::InputRegisters, 5, 0}}), HasSubstr(entry + " (input register 0005h) cannot be written"));
    EXPECT_THAT(with({{Table::Coils, 5, 2}}), HasSubstr(entry + " (coil 0005h) takes 0 or 1"));
    EXPECT_EQ(with({{Table::Coils, 5, 1}, {kHolding, 5, 2}}), "fine");
    EXPECT_THAT(with({{kHolding, kSpeedCommand, 1}}),
                HasSubstr("SpeedCommand (holding register 0011h) and " + entry + " (holding register 0011h) overlap"));
  }
}

TEST(ModbusSpindleMap, TellsAFaultSomehow) {
  EXPECT_EQ(spindle_said([](SpindleMap& map) { map.tripped.reset(); }), "fine");
  EXPECT_EQ(spindle_said([](SpindleMap& map) { map.fault_code.reset(); }), "fine");
  EXPECT_THAT(spindle_said([](SpindleMap& map) {
                map.tripped.reset();
                map.fault_code.reset();
              }),
              HasSubstr("neither Fault/Tripped nor Fault/Code tells a fault"));
  EXPECT_THAT(spindle_said([](SpindleMap& map) { map.speed_command.place.table = Table::InputRegisters; }),
              HasSubstr("SpeedCommand (input register 0011h) cannot be written"));
}

TEST(ModbusIoMap, FillsEachOfItsBitsOnce) {
  EXPECT_EQ(io_said({bits(Table::DiscreteInputs, 0, 64, 0)}), "fine");
  EXPECT_EQ(io_said({bits(Table::DiscreteInputs, 0, 8, 56)}), "fine");
  EXPECT_EQ(io_said({bits(Table::DiscreteInputs, 0, 8, 0), bits(Table::DiscreteInputs, 8, 8, 8)}), "fine");
  EXPECT_EQ(io_said({bits(Table::DiscreteInputs, 0, 1, 4), bits(Table::DiscreteInputs, 8, 1, 3),
                     bits(Table::DiscreteInputs, 9, 1, 5)}),
            "fine");
  EXPECT_EQ(io_said({bits(Table::DiscreteInputs, 0, 8, 57)}),
            "register map a device: Inputs/0 (discrete inputs 0000h to 0007h) fills bits 57 to 64; there are 64");
  EXPECT_THAT(io_said({bits(Table::DiscreteInputs, 0, 0, 5)}), HasSubstr("fills bits 5 to 4; there are 64"));
  EXPECT_EQ(
      io_said({bits(Table::DiscreteInputs, 0, 8, 0), bits(Table::DiscreteInputs, 8, 8, 7)}),
      "register map a device: Inputs/1 (discrete inputs 0008h to 000Fh) fills bits that another one fills already");
  EXPECT_THAT(io_said({bits(Table::DiscreteInputs, 0, 64, 0), bits(Table::Coils, 0, 1, 63)}),
              HasSubstr("fills bits that another one fills already"));
}

TEST(ModbusIoMap, ReadsEachAddressOnce) {
  EXPECT_EQ(io_said({bits(Table::DiscreteInputs, 0, 8, 0), bits(Table::DiscreteInputs, 7, 8, 8)}),
            "register map a device: Inputs/0 (discrete inputs 0000h to 0007h) and Inputs/1 (discrete inputs 0007h to "
            "000Eh) overlap");
  EXPECT_EQ(io_said({bits(Table::InputRegisters, 5, 17, 0), bits(Table::InputRegisters, 7, 1, 17)}), "fine");
  EXPECT_THAT(io_said({bits(Table::InputRegisters, 5, 17, 0), bits(Table::InputRegisters, 6, 1, 17)}),
              HasSubstr("Inputs/0 (input registers 0005h to 0006h) and Inputs/1 (input register 0006h) overlap"));
  EXPECT_EQ(io_said({bits(Table::Coils, 0, 8, 0)}, {bits(Table::Coils, 0, 8, 0)}), "fine") << "read and written";
  EXPECT_THAT(io_said({bits(Table::Coils, 0xFFFF, 2, 0)}), HasSubstr("Inputs/0 (coils FFFFh to 10000h) goes beyond"));
}

TEST(ModbusIoMap, HasOutputsThatCanBeWrittenOrInputs) {
  EXPECT_EQ(io_said({}, {bits(Table::HoldingRegisters, 0, 8, 0)}), "fine");
  EXPECT_THAT(io_said({}, {bits(Table::InputRegisters, 0, 8, 0)}),
              HasSubstr("Outputs/0 (input register 0000h) cannot be written"));
  EXPECT_THAT(io_said({}, {bits(Table::Coils, 0, 8, 60)}), HasSubstr("Outputs/0 (coils 0000h to 0007h) fills bits 60"));
  EXPECT_THAT(io_said({}), HasSubstr("it has neither inputs nor outputs"));
}

}  // namespace
}  // namespace rmac::fieldbus::modbus
