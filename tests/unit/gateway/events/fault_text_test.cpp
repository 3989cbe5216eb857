// Faults in words, of a mill whose drives are on three buses.
#include "gateway/events/fault_text.hpp"

#include <gmock/gmock.h>

#include "gateway/mechanism/assembler.hpp"
#include "rmac/fieldbus/fault_texts.hpp"
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

TEST_F(FaultText, SaysOfALoopWhatIsWrongWithIt) {
  const auto of_joint = [](ServoFault::Kind kind, double value, double bound) {
    return ServoFault{kind, ServoFault::Part::Joint, 1, value, bound};
  };
  EXPECT_THAT(text(of_joint(ServoFault::Kind::Oscillation, 274, 300)),
              HasSubstr("joint 1 (Y): its servo loop swings at about 274 Hz, its effort by 300 either way; look for "
                        "loose mechanics"));
  EXPECT_THAT(text(of_joint(ServoFault::Kind::WrongDirection, -0.1, 250)),
              HasSubstr("joint 1 (Y): it went -0.1 faster and faster against an effort of 250; look for a motor"));
  EXPECT_THAT(text(of_joint(ServoFault::Kind::StandsStill, 1, 0.02)),
              HasSubstr("joint 1 (Y): its position stands still for 0.02 s, and it was to go 1; look for what "
                        "blocks the axis"));
  EXPECT_THAT(text(of_joint(ServoFault::Kind::StandsStill, 1, 0.02)), HasSubstr("friction that its loop is too weak"));
  EXPECT_THAT(
      text(of_joint(ServoFault::Kind::EncoderFrozen, 0.02, 40)),
      HasSubstr("joint 1 (Y): its encoder tells the same to the last digit for 0.02 s, while the effort changed "
                "by 40: it froze, or its shaft is held fast; check the encoder"));
  EXPECT_THAT(text({ServoFault::Kind::EncoderFrozen, ServoFault::Part::Actuator, 1, 0.02, 40}),
              HasSubstr("drive of actuator 1 (bus far, axis 1): its encoder tells the same to the last digit for 0.02 "
                        "s, while the effort changed by 40: it froze, or its shaft is held fast; check the encoder, "
                        "its cable, its coupling and the brake, and look where the axis really is, and square what "
                        "it moves together with others, then reset"));
  EXPECT_THAT(text({ServoFault::Kind::Skewed, ServoFault::Part::Actuator, 1, 0.3, 0.2}),
              HasSubstr("drive of actuator 1 (bus far, axis 1): the motors of its joint stand 0.3 apart, beyond the "
                        "bound of 0.2 (MaxSkew, "));
}

TEST_F(FaultText, NamesADrivesStateAsTheTopicOfDrivesDoes) {
  const ServoFault dropped{ServoFault::Kind::DriveDropped, ServoFault::Part::Actuator, 1, 0x0007};
  EXPECT_THAT(text(dropped), HasSubstr("drive of actuator 1 (bus far, axis 1): the drive left Operation Enabled by "
                                       "itself and is in quick stop active"));
}

/// A bus that knows why its drives are silent.
class TellingBus final : public DigitalControlInterface, public fieldbus::SilenceText {
 public:
  std::size_t axis_count() const noexcept override { return 3; }
  Expected<> start() override { return {}; }
  void stop() noexcept override {}
  [[nodiscard]] bool receive(std::span<DriveFeedback>) noexcept override { return true; }
  bool send(std::span<const DriveCommand>) noexcept override { return true; }
  std::optional<std::string> silence_text(std::size_t axis) const override {
    if (axis != 1) return {};
    return "node 7: two devices have this node id; give each an id of its own";
  }
};

// Red when the reason of an interface is not asked for, or asked of another axis.
TEST_F(FaultText, SaysWhyADriveIsSilentWhereItsBusKnows) {
  ServoLoopParts parts = mechanism_->loop->parts();
  const auto bus = std::make_shared<ServoBus>(std::make_shared<TellingBus>());
  for (ServoActuator& actuator : parts.actuators) actuator.bus = bus;
  auto loop = ServoLoop::create(std::move(parts));
  ASSERT_TRUE(loop) << loop.error().message;
  mechanism_->loop = std::move(*loop);
  const auto silent = [](std::uint32_t index) {
    return ServoFault{ServoFault::Kind::DriveOffline, ServoFault::Part::Actuator, index};
  };
  EXPECT_THAT(text(silent(1)), HasSubstr("(bus far, axis 1): node 7: two devices have this node id; give each an id of "
                                         "its own, then reset"));
  EXPECT_THAT(text(silent(0)), HasSubstr("the drive does not answer; check its power and its cable, then reset"));
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
