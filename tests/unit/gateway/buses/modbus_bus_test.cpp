#include <gmock/gmock.h>

#include "gateway/buses/built_in_interfaces.hpp"
#include "gateway/buses/bus_choice.hpp"
#include "places.hpp"

namespace {

using namespace rmac;
using namespace rmac::gateway;
using testing::HasSubstr;

const ModuleLoader& shared_folder() {
  static const ModuleLoader kLoader({std::filesystem::path(RMAC_SOURCE_DIR) / "drivers" / "modules"});
  return kLoader;
}

/// What the registry answers when a mechanism wants `bus`.
std::string answer(const sdk::ModuleChoice& choice, const std::string& bus = "spindle0") {
  BusRegistry registry;
  add_built_in_interfaces(registry, 0.001);
  const auto acquired = registry.acquire(bus, interface_of_bus(bus, choice), shared_folder());
  return acquired ? "acquired" : acquired.error().message;
}

std::string io_answer(const sdk::ModuleChoice& choice) {
  BusRegistry registry;
  add_built_in_interfaces(registry, 0.001);
  const auto checked = registry.check_io_interface(choice, shared_folder());
  return checked ? "fine" : checked.error().message;
}

sdk::ModuleChoice modbus(std::map<std::string, std::vector<double>> numbers, std::map<std::string, std::string> texts) {
  return {"ModbusInterface", std::move(numbers), std::move(texts)};
}

TEST(InterfaceOfBus, IsTheMachinesOwnUnlessTheBusNamesAnother) {
  const sdk::ModuleChoice machine{"CANopenInterface",
                                  {{"node", {1, 2}}, {"can1.node", {3}}, {"spindle0.slave", {4}}},
                                  {{"spindle0.interface", "ModbusInterface"}, {"spindle0.map", "delta-vfd-b"}}};
  const sdk::ModuleChoice can = interface_of_bus("can0", machine);
  EXPECT_EQ(can.name, "CANopenInterface");
  EXPECT_EQ(can.numbers, (decltype(can.numbers){{"node", {1, 2}}}));
  EXPECT_TRUE(can.texts.empty());
  EXPECT_EQ(interface_of_bus("can1", machine).numbers, (decltype(can.numbers){{"node", {1, 2}}, {"can1.node", {3}}}));
  const sdk::ModuleChoice spindle = interface_of_bus("spindle0", machine);
  EXPECT_EQ(spindle.name, "ModbusInterface");
  EXPECT_EQ(spindle.numbers, (decltype(can.numbers){{"slave", {4}}}));
  EXPECT_EQ(spindle.texts, (decltype(can.texts){{"map", "delta-vfd-b"}}));
}

TEST(InterfaceOfBus, StaysAsItIsWhileSomethingIsSaidOfAnotherBus) {
  BusRegistry registry;
  add_built_in_interfaces(registry, 0.001);
  const auto acquire = [&](const std::string& parameter) {
    const sdk::ModuleChoice machine{"SimulatedInterface", {{"axes", {2}}, {parameter, {2}}}, {}};
    return registry.acquire("can0", interface_of_bus("can0", machine), shared_folder());
  };
  const auto before = acquire("can1.axes");
  ASSERT_TRUE(before) << before.error().message;
  const auto after = acquire("can2.axes");
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_EQ(*before, *after) << "it is in use, and goes on";
}

TEST(ModbusBus, IsRefusedWithAWrongParameterThatIsNamed) {
  const std::string at = "ModbusInterface, bus spindle0: ";
  EXPECT_THAT(answer(modbus({{"slave", {1}}}, {{"map", "delta-vfd-b"}})),
              HasSubstr(at + "either \"address\" (the IP address of a TCP device) or \"device\""));
  EXPECT_EQ(answer(modbus({}, {{"address", "127.0.0.1"}})),
            at + "slave is missing; it lists the slave number of each axis, for example [1]");
  EXPECT_EQ(answer(modbus({{"slave", {1}}}, {{"address", "127.0.0.1"}})),
            at + "map is missing; it names the register map of the drive");
  EXPECT_EQ(answer(modbus({{"slave", {0}}}, {{"address", "127.0.0.1"}, {"map", "delta-vfd-b"}})),
            at + "slave is 0; allowed is a whole number from 1 to 255");
  EXPECT_EQ(answer(modbus({{"slave", {3, 3}}}, {{"address", "127.0.0.1"}, {"map", "delta-vfd-b"}})),
            at + "slave 3 stands twice; each drive needs a number of its own");
  EXPECT_THAT(answer(modbus({{"slave", {1}}, {"stale_ms", {200}}}, {{"address", "::1"}, {"map", "delta-vfd-b"}})),
              HasSubstr(at + "stale_ms is 200; it must be above period_ms and deadline_ms together, 250"));
  EXPECT_THAT(answer(modbus({{"slave", {1}}, {"sped", {1}}}, {{"address", "127.0.0.1"}, {"map", "delta-vfd-b"}})),
              HasSubstr(at + "parameter \"sped\" is not understood; there are address, bit_rate"));
  EXPECT_THAT(answer(modbus({{"slave", {1}}, {"bit_rate", {12345}}}, {{"device", "/dev/x"}, {"map", "delta-vfd-b"}})),
              HasSubstr(at + "bit rate 12345; there are 1200, "));
  EXPECT_THAT(answer(modbus({{"slave", {1}}}, {{"address", "127.0.0.1"}, {"map", "powtran-pi500"}})),
              HasSubstr(at + "maximum_hz is missing"));
}

TEST(ModbusBus, SaysWhereARegisterMapWasLookedFor) {
  EXPECT_THAT(answer(modbus({{"slave", {1}}}, {{"address", "127.0.0.1"}, {"map", "no-such-drive"}})),
              HasSubstr("map: there is no register map no-such-drive: no file no-such-drive.json in "));
  EXPECT_THAT(answer(modbus({{"slave", {1}}}, {{"address", "127.0.0.1"}, {"map", "../../etc/rmacd"}})),
              HasSubstr("cannot be the name of a register map"));
  EXPECT_THAT(answer(modbus({{"slave", {1}}}, {{"address", "127.0.0.1"}, {"map", "generic-remote-io"}})),
              HasSubstr("generic-remote-io.json: "));
}

TEST(ModbusBus, SaysThatASerialPortIsNotThere) {
  EXPECT_EQ(answer(modbus({{"slave", {1}}, {"boot_timeout_s", {0.1}}},
                          {{"device", "/dev/no-such-port"}, {"map", "delta-vfd-b"}})),
            "bus spindle0 did not come up: slave 1 at /dev/no-such-port was not reached within 0.1 s: "
            "/dev/no-such-port: cannot be opened: No such file or directory");
}

TEST(ModbusIo, IsRefusedWithAWrongParameterThatIsNamed) {
  const auto io = [](std::map<std::string, std::vector<double>> numbers, std::map<std::string, std::string> texts) {
    return io_answer({"ModbusIOInterface", std::move(numbers), std::move(texts)});
  };
  EXPECT_EQ(io({{"slave", {1}}}, {{"address", "127.0.0.1"}, {"map", "generic-remote-io"}}), "fine");
  EXPECT_EQ(io({}, {{"address", "127.0.0.1"}}),
            "ModbusIOInterface: map is missing; it names the register map of the device");
  EXPECT_THAT(io({}, {{"address", "127.0.0.1"}, {"map", "delta-vfd-b"}}), HasSubstr("delta-vfd-b.json: "));
}

}  // namespace
