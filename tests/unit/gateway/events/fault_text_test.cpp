// Faults in words, of a mill whose drives are on three buses.
#include "gateway/events/fault_text.hpp"

#include <gmock/gmock.h>

#include "gateway/mechanism/assembler.hpp"
#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class FaultText : public testing::Test {
 protected:
  void SetUp() override {
    sdk::DeviceObject device = TestMachine::plane_mill();
    device.actuators[0].bus = "near";
    device.actuators[1].bus = "far";
    device.actuators[2].bus = "near";
    device.spindles[0].bus = "spindle";
    device.inputs = {{"DoorOpen", 4}};
    auto made =
        assemble(device, {.virtual_mode = true}, ModuleLoader({TestMachine::options().module_folders[0]}), registry_);
    ASSERT_TRUE(made) << made.error().message;
    mechanism_ = std::move(*made);
  }
  [[nodiscard]] std::string text(const ServoFault& fault) const { return describe(fault, mechanism_.get()); }

  BusRegistry registry_;
  std::shared_ptr<Mechanism> mechanism_;
};

TEST_F(FaultText, NamesABusAsItsDriveDoes) {
  constexpr auto kKind = ServoFault::Kind::BusFailure;
  constexpr auto kPart = ServoFault::Part::Bus;
  EXPECT_THAT(text({kKind, kPart, 0}), HasSubstr("bus near: the bus failed"));
  EXPECT_THAT(text({kKind, kPart, 1}), HasSubstr("bus far: "));
  EXPECT_THAT(text({kKind, kPart, 2}), HasSubstr("bus spindle: ")) << "the third actuator's has been counted already";
  EXPECT_THAT(text({kKind, kPart, 3}), HasSubstr("bus 3: ")) << "there is none";
  EXPECT_THAT(describe({kKind, kPart, 1}, nullptr), HasSubstr("bus 1: ")) << "nobody is there to name it";
}

TEST_F(FaultText, NamesJointsThatAreHeld) {
  const auto of_joint = [](std::uint32_t number) {
    return ServoFault{ServoFault::Kind::NotANumber, ServoFault::Part::Joint, number};
  };
  EXPECT_THAT(text(of_joint(1)), HasSubstr("joint 1 (Y): "));
  EXPECT_THAT(text(of_joint(2)), HasSubstr("held joint 2 (Z): "));
  EXPECT_THAT(text(of_joint(3)), HasSubstr("joint 3: "));
}

TEST_F(FaultText, NamesADrivesStateAsTheTopicOfDrivesDoes) {
  const ServoFault dropped{ServoFault::Kind::DriveDropped, ServoFault::Part::Actuator, 1, 0x0007};
  EXPECT_THAT(text(dropped), HasSubstr("drive of actuator 1 (bus far, axis 1): the drive left Operation Enabled by "
                                       "itself and is in quick stop active"));
}

TEST_F(FaultText, NamesInputs) {
  const ServoFault stop{ServoFault::Kind::EmergencyStop, ServoFault::Part::Io, 4};
  EXPECT_THAT(text(stop), HasSubstr("DoorOpen (input 4) stopped the machine"));
}

TEST_F(FaultText, BecomesAnEventWithTheStatusThatItLeaves) {
  FaultRecord record;
  record.cycle = 12;
  record.t_s = 0.012;
  record.move_id = 7;
  record.fault = {ServoFault::Kind::DriveOffline, ServoFault::Part::Actuator, 0, 0, 0, StopCategory::StopKeepPower};
  const Event event = event_of(record, mechanism_.get());
  EXPECT_EQ(event.kind, Event::Kind::Fault);
  EXPECT_EQ(event.cycle, 12);
  EXPECT_EQ(event.t_s, 0.012);
  EXPECT_EQ(event.move_id, 7);
  EXPECT_EQ(event.code, MinorCode::CommTimeout);
  EXPECT_THAT(event.message, HasSubstr("every other joint brakes and is held under power"));
}

}  // namespace
}  // namespace rmac::gateway
