#include "servo/drives/exchange.hpp"

#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

class FakeIo final : public DigitalIoInterface {
 public:
  [[nodiscard]] Expected<> start() override { return {}; }
  void stop() noexcept override {}
  [[nodiscard]] bool exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept override {
    sent = outputs;
    inputs = told;
    return works;
  }
  std::uint64_t sent = 0, told = 0;
  bool works = true;
};

/// Actuators on axes 0 and 1 of a bus and a spindle on axis 3; a force sensor on another bus.
class Exchanged : public testing::Test {
 protected:
  Exchanged() {
    parts_.actuators.push_back({bus_, 0, {}});
    parts_.actuators.push_back({bus_, 1, {}});
    parts_.spindles.push_back({.bus = bus_, .axis = 3});
    parts_.joints.resize(2);
    parts_.joints[1].force_sensor = ServoForceSensor{other_, 0, 1, 0};
    parts_.io = io_;
    for (DriveCommand& words : bus_->commands) words.controlword = 0xF;
  }
  std::uint64_t run(Exchange& exchange, std::uint64_t outputs = 0) {
    const std::uint64_t inputs = exchange.receive(outputs, faults_);
    exchange.send(faults_);
    return inputs;
  }
  std::shared_ptr<FakeBus> fake_ = std::make_shared<FakeBus>(4), fake_other_ = std::make_shared<FakeBus>(1);
  std::shared_ptr<ServoBus> bus_ = std::make_shared<ServoBus>(fake_), other_ = std::make_shared<ServoBus>(fake_other_);
  std::shared_ptr<FakeIo> io_ = std::make_shared<FakeIo>();
  ServoLoopParts parts_;
  RecordedFaults faults_;
};

TEST_F(Exchanged, EachBusIsExchangedOnce) {
  Exchange exchange(parts_);
  run(exchange);
  EXPECT_EQ(fake_->exchanges, 1);
  EXPECT_EQ(fake_other_->exchanges, 1);
  EXPECT_TRUE(faults_.raised.empty());
}

TEST_F(Exchanged, WordsThatWereThereAskForNothingAtFirstAndCountFromThenOn) {
  Exchange exchange(parts_);
  run(exchange);
  EXPECT_EQ(fake_->drives[0].command.controlword, 0);
  bus_->commands[0].controlword = 0x6;
  run(exchange);
  EXPECT_EQ(fake_->drives[0].command.controlword, 0x6);
}

// Red when what is sent was made of the answers of a cycle before: a whole cycle's delay in every loop.
TEST_F(Exchanged, WhatIsMadeOfAnswersGoesOutInTheirCycle) {
  Exchange exchange(parts_);
  fake_->drives[0].words.position_counts = 77;
  (void)exchange.receive(0, faults_);
  bus_->commands[0].target_position_counts = bus_->feedback[0].position_counts;
  exchange.send(faults_);
  EXPECT_EQ(fake_->drives[0].command.target_position_counts, 77);
}

TEST_F(Exchanged, WordsThatAnotherLoopLeftStandForItsOwnDrives) {
  Exchange exchange(parts_);
  exchange.take_over();
  run(exchange);
  EXPECT_EQ(fake_->drives[0].command.controlword, 0xF);
  EXPECT_EQ(fake_->drives[1].command.controlword, 0xF);
  EXPECT_EQ(fake_->drives[2].command.controlword, 0) << "nobody's";
  EXPECT_EQ(fake_->drives[3].command.controlword, 0xF) << "the spindle's";
}

TEST_F(Exchanged, BusThatFailsIsNamedByItsPlace) {
  Exchange exchange(parts_);
  const auto failed = testing::ElementsAre(is_fault(ServoFault::Kind::BusFailure, ServoFault::Part::Bus, 1, 0, 0));
  fake_other_->sends = false;
  run(exchange);
  EXPECT_THAT(faults_.raised, failed);
  faults_.raised.clear();
  fake_other_->works = false;
  (void)exchange.receive(0, faults_);
  EXPECT_THAT(faults_.raised, failed);
}

TEST_F(Exchanged, IoThatFailsIsAFaultOfItsOwn) {
  Exchange exchange(parts_);
  io_->works = false;
  run(exchange);
  EXPECT_THAT(faults_.raised,
              testing::ElementsAre(is_fault(ServoFault::Kind::IoFailure, ServoFault::Part::Io, 0, 0, 0)));
}

TEST_F(Exchanged, OutputsGoOutAndInputsComeInWithThoseOfDrives) {
  parts_.drive_inputs = {{1, 0x2, 0x10}, {1, 0x4, 0x20}};
  Exchange exchange(parts_);
  io_->told = 0x21;
  fake_->drives[1].words.inputs = 0x2;
  EXPECT_EQ(run(exchange, 0x5), 0x11U) << "the drive's word decides on its inputs, whatever the I/O has there";
  EXPECT_EQ(io_->sent, 0x5U);
}

}  // namespace
}  // namespace rmac::servo_test
