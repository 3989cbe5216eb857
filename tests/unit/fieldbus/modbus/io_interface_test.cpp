#include "rmac/fieldbus/modbus/io_interface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "conformance/digital_io_conformance.hpp"
#include "unit/fieldbus/modbus/register_bank.hpp"
#include "unit/fieldbus/modbus/still_clock.hpp"

namespace rmac::fieldbus::modbus {
namespace {

using namespace std::chrono_literals;
using Wire = ModbusPeer::Wire;

/// Two inputs as bits, four in a register, inverted; outputs likewise.
IoMap io_map() {
  return {"a device",
          "",
          8,
          {{{Table::DiscreteInputs, 3, 1}, 2, 0, false}, {{Table::InputRegisters, 9}, 4, 8, true}},
          {{{Table::Coils, 5, 1}, 3, 0, false}, {{Table::HoldingRegisters, 7}, 20, 16, false}}};
}

class ModbusIo : public testing::TestWithParam<Wire> {
 protected:
  ModbusIo() : peer(GetParam()) {
    peer.respond([this](const Bytes& request) { return bank.answer(request); });
    make(60s);
  }
  /// However busy the computer is, an honest peer answers within a minute.
  void make(std::chrono::milliseconds deadline) {
    IoLineConfig config;
    config.line.endpoint = peer.endpoint();
    config.line.deadline = deadline;
    config.line.period = 2ms;
    config.line.first_pause = config.line.longest_pause = 0ms;
    config.line.now = clock.now();
    config.boot_timeout = 60s;
    config.slave = 1;
    config.map = map;
    io = std::make_unique<IoInterface>(std::move(config));
  }
  /// Cycles until the inputs are as wanted.
  bool inputs_become(std::uint64_t outputs, std::uint64_t wanted) {
    const auto give_up = Clock::now() + 60s;
    std::uint64_t inputs = 0;
    while (!io->exchange(outputs, inputs) || inputs != wanted) {
      if (Clock::now() > give_up) return false;
      std::this_thread::yield();
    }
    return true;
  }

  IoMap map = io_map();
  RegisterBank bank;
  ModbusPeer peer;
  StillClock clock;
  std::unique_ptr<IoInterface> io;
};

INSTANTIATE_TEST_SUITE_P(Wires, ModbusIo, testing::Values(Wire::Tcp, Wire::Rtu),
                         [](const auto& wire) { return wire.param == Wire::Tcp ? "Tcp" : "Rtu"; });

TEST_P(ModbusIo, ConformsToThePort) {
  conformance::DigitalIoConformance(*io, {.input = 1,
                                          .output = 2,
                                          .turn_input = [this](bool on) { bank.set(Table::DiscreteInputs, 4, on); },
                                          .output_is_on = [this] { return bank.get(Table::Coils, 7) != 0; },
                                          .pass = [] { std::this_thread::yield(); }})
      .check();
}

TEST_P(ModbusIo, CarriesBitsBothWays) {
  ASSERT_TRUE(io->start());
  EXPECT_TRUE(inputs_become(0, 0xF00)) << "inverted ones are on while they read 0";
  bank.set(Table::DiscreteInputs, 4, 1);
  bank.set(Table::InputRegisters, 9, 0b0101);
  EXPECT_TRUE(inputs_become(0, 0xA02));
  static_cast<void>(peer.take_requests());
  std::uint64_t inputs = 0;
  EXPECT_TRUE(io->exchange(std::uint64_t{0b101} | std::uint64_t{0x81234} << 16U, inputs));
  Bytes written;
  EXPECT_TRUE(peer.wait_for([&](const Bytes& request) {
    if (request[1] == 16) written = request;
    return request[1] == 16;
  }));
  EXPECT_EQ(written, (Bytes{1, 16, 0, 7, 0, 2, 4, 0x12, 0x34, 0, 8}));
  EXPECT_EQ(bank.get(Table::Coils, 5), 1);
  EXPECT_EQ(bank.get(Table::Coils, 6), 0);
  EXPECT_EQ(bank.get(Table::Coils, 7), 1);
}

TEST_P(ModbusIo, CarriesNoBitsButItsOwn) {
  for (std::uint16_t address = 0; address < 16; ++address) {
    bank.set(Table::DiscreteInputs, address, 1);
    bank.set(Table::InputRegisters, address, 0);
  }
  ASSERT_TRUE(io->start());
  EXPECT_TRUE(inputs_become(0, 0xF03));
  static_cast<void>(peer.take_requests());
  std::uint64_t inputs = 0;
  EXPECT_TRUE(io->exchange(~std::uint64_t{0}, inputs));
  Bytes coils, registers;
  EXPECT_TRUE(peer.wait_for([&](const Bytes& request) {
    if (request[1] == 15) coils = request;
    if (request[1] == 16) registers = request;
    return request[1] == 16;
  }));
  EXPECT_EQ(coils, (Bytes{1, 15, 0, 5, 0, 3, 1, 0b111}));
  EXPECT_EQ(registers, (Bytes{1, 16, 0, 7, 0, 2, 4, 0xFF, 0xFF, 0, 0x0F}));
}

TEST_P(ModbusIo, ReadsSixteenBitsOfARegisterTheLowestFirst) {
  map.inputs = {{{Table::InputRegisters, 9}, 20, 4, false}};
  make(60s);
  bank.set(Table::InputRegisters, 9, 0x8001);
  bank.set(Table::InputRegisters, 10, 0xFFFA);
  ASSERT_TRUE(io->start());
  EXPECT_TRUE(inputs_become(0, 0xA80010)) << "and four of the next";
}

TEST_P(ModbusIo, WritesAnInvertedOutputTheOtherWayRound) {
  map = io_map();
  map.outputs = {{{Table::HoldingRegisters, 7}, 3, 1, true}};
  make(60s);
  ASSERT_TRUE(io->start());
  EXPECT_EQ(bank.get(Table::HoldingRegisters, 7), 0b111) << "off";
  std::uint64_t inputs = 0;
  EXPECT_TRUE(io->exchange(0b0101, inputs));
  EXPECT_TRUE(peer.wait_for([](const Bytes& request) { return request[1] == 6 && request.back() == 0b101; }))
      << "bit 2 is its second";
  io->stop();
  EXPECT_EQ(bank.get(Table::HoldingRegisters, 7), 0b111);
}

// Red when nothing is read of a device that only takes: nobody would know whether it is there.
TEST_P(ModbusIo, ReadsTheOutputsOfADeviceWithoutInputs) {
  map.inputs.clear();
  make(60s);
  ASSERT_TRUE(io->start());
  EXPECT_TRUE(inputs_become(0, 0));
  EXPECT_TRUE(peer.wait_for([](const Bytes& request) { return request[1] == 1; }));
  EXPECT_TRUE(peer.wait_for([](const Bytes& request) { return request[1] == 3; }));
}

TEST_P(ModbusIo, IsReportedWithItsLine) {
  EXPECT_EQ(io->fault_text(), "what it told last is too old; see that the computer has time for its line");
  ASSERT_TRUE(io->start());
  const LineReport line = io->line_report();
  EXPECT_EQ(line.endpoint, to_string(peer.endpoint()));
  ASSERT_EQ(line.units.size(), 1U);
  EXPECT_EQ(line.units[0].unit, 1);
  EXPECT_EQ(line.units[0].state, "answers");
  EXPECT_GT(line.units[0].traffic.answers, 0U);
}

TEST_P(ModbusIo, SwitchesItsOutputsOffWhenItEnds) {
  ASSERT_TRUE(io->start());
  std::uint64_t inputs = 0;
  ASSERT_TRUE(io->exchange(0b111, inputs));
  ASSERT_TRUE(peer.wait_for([](const Bytes& request) { return request[1] == 15 && request.back() == 0b111; }));
  io->stop();
  for (std::uint16_t address = 5; address < 8; ++address) EXPECT_EQ(bank.get(Table::Coils, address), 0);
  EXPECT_FALSE(io->exchange(0b111, inputs)) << "what is not running has no inputs";
  static_cast<void>(peer.take_requests());
  ASSERT_TRUE(io->start());
  for (const Bytes& request : peer.take_requests()) {
    if (request[1] == 15) {
      EXPECT_EQ(request.back(), 0) << "what was wanted before it ended is not any more";
    }
  }
}

// Red when what was written before stands for what the device has: a person, or another master, may have switched it.
TEST_P(ModbusIo, SwitchesOffWhatSomebodyElseSwitchedOn) {
  ASSERT_TRUE(io->start());
  ASSERT_TRUE(inputs_become(0, 0b111100000000));
  bank.set(Table::Coils, 6, 1);
  io->stop();
  EXPECT_EQ(bank.get(Table::Coils, 6), 0) << "at its end";
  bank.set(Table::Coils, 6, 1);
  ASSERT_TRUE(io->start());
  EXPECT_EQ(bank.get(Table::Coils, 6), 0) << "at its begin";
}

TEST_P(ModbusIo, FailsWhenItsInputsGrowOldAndLetsItsOutputsFall) {
  make(50ms);
  ASSERT_TRUE(io->start());
  std::uint64_t inputs = 0;
  ASSERT_TRUE(io->exchange(0b111, inputs));
  ASSERT_TRUE(peer.wait_for([](const Bytes& request) { return request[1] == 15 && request.back() == 0b111; }));
  peer.behave(ModbusPeer::Manner::Silent);
  clock.pass(1000ms);
  EXPECT_TRUE(io->exchange(0b111, inputs));
  clock.pass(1ms);
  EXPECT_FALSE(io->exchange(0b111, inputs));
  const auto give_up = Clock::now() + 60s;
  while (io->fault_text().find("no whole answer within 50 ms") == std::string::npos) ASSERT_LT(Clock::now(), give_up);
  EXPECT_THAT(io->fault_text(), testing::HasSubstr("the device does not answer: "));
  static_cast<void>(peer.take_requests());
  peer.behave(ModbusPeer::Manner::Honest);
  EXPECT_TRUE(peer.wait_for([](const Bytes& request) { return request[1] == 15 && request.back() == 0; }));
}

}  // namespace
}  // namespace rmac::fieldbus::modbus
