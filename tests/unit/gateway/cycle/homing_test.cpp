#include <gmock/gmock.h>

#include "rmac/motion/drive_power.hpp"
#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

/// The simulated bus, whose drives find home where they stand, some cycles after they are told to look for it. Home is
/// at 5000 counts of theirs.
class HomingBus final : public fieldbus::SimulatedInterface {
 public:
  static constexpr std::int32_t kHome = 5000;
  static constexpr int kCycles = 300;

  HomingBus() : SimulatedInterface(fieldbus::default_simulated_axes(), 0.001), drives_(axis_count()) {}

  [[nodiscard]] bool receive(std::span<DriveFeedback> feedback) noexcept override {
    const bool sound = SimulatedInterface::receive(feedback);
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      Drive& drive = drives_[i];
      const bool homes = drive.told.mode == DriveMode::Homing;
      const bool looks = homes && (drive.told.controlword & controlword::kStartHoming) != 0;
      drive.cycles = looks ? drive.cycles + 1 : 0;
      if (drive.cycles == kCycles) {
        drive.shift = kHome - feedback[i].position_counts;
        ++drive.homings;
      }
      feedback[i].position_counts += drive.shift;
      feedback[i].mode = drive.told.mode;
      if (homes && (!looks || drive.cycles >= kCycles)) {
        feedback[i].statusword |= statusword::kTargetReached;
        if (looks) feedback[i].statusword |= statusword::kHomingAttained;
      }
    }
    return sound;
  }
  bool send(std::span<const DriveCommand> commands) noexcept override {
    std::vector<DriveCommand> forwarded(commands.begin(), commands.end());
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      drives_[i].told = commands[i];
      if (forwarded[i].mode != DriveMode::Homing) continue;
      forwarded[i].mode = DriveMode::CyclicSyncTorque;
      forwarded[i].target_torque_permille = 0;
    }
    return SimulatedInterface::send(forwarded);
  }

  struct Drive {
    DriveCommand told;
    int cycles = 0;
    std::int32_t shift = 0;
    std::atomic<int> homings{0};
  };
  [[nodiscard]] int homings(std::size_t axis) const { return drives_[axis].homings; }

 private:
  std::vector<Drive> drives_;
};

class Homing : public testing::Test {
 protected:
  Homing() : machine_(options()) {}
  void SetUp() override {
    sdk::DeviceObject device = TestMachine::mill();
    device.digital_control_interface.name = "HomingBus";
    device.actuators[0].homing_turn = 2;
    device.actuators[1].homing_turn = 1;
    const auto loaded = machine_.load(device);
    ASSERT_TRUE(loaded) << loaded.error().message;
  }
  ControllerOptions options() {
    ControllerOptions with_bus = TestMachine::options();
    with_bus.control_interfaces["HomingBus"] = [this](const std::string&, const sdk::ModuleChoice&, const ModuleLoader&)
        -> Expected<std::shared_ptr<DigitalControlInterface>> { return bus_ = std::make_shared<HomingBus>(); };
    return with_bus;
  }
  sdk::RmacCam& cam() { return machine_.controller.cam(); }
  CycleState state() { return machine_.controller.sample().state; }

  std::shared_ptr<HomingBus> bus_;
  TestMachine machine_;
};

TEST_F(Homing, HasTheDrivesHomeAndTheMachineGoOnFromThere) {
  const auto homed = cam().positioning().home();
  ASSERT_TRUE(homed) << homed.error().message;
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::Stopped));
  EXPECT_THAT(machine_.last(Event::Kind::Stopped), HasSubstr("the drives have found home"));
  ASSERT_TRUE(machine_.run_until([&] { return state() == CycleState::Idle; })) << "a sample is some cycles behind";
  EXPECT_EQ(bus_->homings(0), 1);
  EXPECT_EQ(bus_->homings(1), 1);
  EXPECT_EQ(bus_->homings(2), 0);
  EXPECT_EQ(machine_.controller.sample().fault.kind, ServoFault::Kind::None);

  // The next move begins where the joints stand now.
  machine_.events.clear();
  ASSERT_TRUE(cam().positioning().jog_joint(0, 3));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::Stopped));
  EXPECT_EQ(machine_.count(Event::Kind::Fault), 0) << machine_.last(Event::Kind::Fault);
}

TEST_F(Homing, RefusesWhateverElseMovesMeanwhile) {
  ASSERT_TRUE(cam().positioning().home());
  EXPECT_FALSE(cam().positioning().jog_joint(2, 1));
  EXPECT_FALSE(cam().cycle().start(sdk::CycleMode::Automatic));
  EXPECT_FALSE(cam().positioning().home());
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::Stopped));
  EXPECT_EQ(bus_->homings(0), 1);
}

TEST_F(Homing, IsEndedByAStopAndCanBeginAnew) {
  for (const auto stop : {&sdk::CycleControl::stop, &sdk::CycleControl::stop_now, &sdk::CycleControl::hold}) {
    machine_.events.clear();
    ASSERT_TRUE(cam().positioning().home());
    ASSERT_TRUE((cam().cycle().*stop)());
    ASSERT_TRUE(machine_.run_until([&] { return state() == CycleState::Idle; }));
    ASSERT_TRUE(machine_.run_until_event(Event::Kind::Stopped));
    EXPECT_EQ(machine_.last(Event::Kind::Stopped).find("found home"), std::string::npos);
  }
  machine_.events.clear();
  ASSERT_TRUE(cam().positioning().home());
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::Stopped));
  EXPECT_THAT(machine_.last(Event::Kind::Stopped), HasSubstr("the drives have found home"));
  EXPECT_EQ(machine_.count(Event::Kind::Fault), 0);
}

}  // namespace
}  // namespace rmac::gateway
