#include "conformance/control_interface_conformance.hpp"
#include "rmac/fieldbus/canopen/canopen_interface.hpp"
#include "rmac/motion/drive_power.hpp"
#include "unit/gateway/simulators/vdrive/wire.hpp"

// The CANopen master and these drives know nothing of each other but the standards.
namespace rmac::vdrive::test {
namespace {

using fieldbus::CanPort;
using fieldbus::canopen::CanopenInterface;
using std::chrono::milliseconds;

class MasterOverVirtualDrives : public testing::Test, public DigitalControlInterface {
 protected:
  void make(const std::map<std::string, std::vector<double>>& numbers,
            const std::map<std::string, std::string>& texts = {}) {
    auto config = fieldbus::canopen::read_canopen_config(
        "can0", numbers, texts, 0.001,
        [](const std::string&, const std::string&) -> Expected<fieldbus::eds::DeviceDescription> { return sheet(); });
    ASSERT_TRUE(config.has_value()) << config.error().message;
    master_ = std::make_unique<CanopenInterface>(*config, [this](std::span<const std::uint16_t>, std::size_t) {
      return Expected<std::unique_ptr<CanPort>>(wire_.open());
    });
    commands_.assign(master_->axis_count(), {});
    feedback_.assign(master_->axis_count(), {});
  }
  std::size_t axis_count() const noexcept override { return master_->axis_count(); }
  Expected<> start() override {
    return master_->start().map([this] { EXPECT_TRUE(exchange(commands_, feedback_)); });
  }
  void stop() noexcept override { master_->stop(); }
  [[nodiscard]] bool receive(std::span<DriveFeedback> feedback) noexcept override { return master_->receive(feedback); }
  bool send(std::span<const DriveCommand> commands) noexcept override {
    const bool sound = master_->send(commands);
    wire_.pass(milliseconds(1));
    return sound;
  }
  void cycles(int count, DriveWish wish, bool reset = false) {
    for (int i = 0; i < count; ++i) {
      for (std::size_t a = 0; a < commands_.size(); ++a) {
        commands_[a].controlword = next_controlword(feedback_[a].statusword, wish, reset, commands_[a].controlword);
      }
      EXPECT_TRUE(exchange(commands_, feedback_));
    }
  }

  Wire wire_;
  std::unique_ptr<CanopenInterface> master_;
  std::vector<DriveCommand> commands_;
  std::vector<DriveFeedback> feedback_;
};

TEST_F(MasterOverVirtualDrives, ConformsToThePort) {
  wire_.add(1);
  wire_.add(2);
  make({{"node", {1, 2}}}, {{"eds", "rmac-vdrive"}});
  conformance::ControlInterfaceConformance(*this, 1).check();
}

TEST_F(MasterOverVirtualDrives, MovesByTorquePositionAndVelocity) {
  for (int id = 1; id <= 3; ++id) wire_.add(static_cast<std::uint8_t>(id));
  make({{"node", {1, 2, 3}}, {"mode", {10, 8, 9}}, {"load_share", {100}}},
       {{"tpdo", "6041:00/16 6064:00/32"}, {"eds", "rmac-vdrive"}});
  ASSERT_TRUE(start().has_value());
  cycles(20, DriveWish::Operational);
  for (const DriveFeedback& words : feedback_) ASSERT_EQ(drive_state(words.statusword), DriveState::OperationEnabled);
  commands_[0].mode = DriveMode::CyclicSyncTorque;
  for (int i = 0; i < 500; ++i) {
    commands_[0].target_torque_permille = static_cast<std::int16_t>(i < 100 ? 300 : 0);
    commands_[1].target_position_counts = static_cast<std::int32_t>(std::lround(40000 * (1 - std::cos(i * 0.01))));
    commands_[2].target_velocity_rpm = 100000;  // units of the drive: counts/s
    cycles(1, DriveWish::Operational);
  }
  EXPECT_GT(feedback_[0].position_counts, 100000);
  EXPECT_NEAR(feedback_[1].position_counts, 40000 * (1 - std::cos(4.97)), 500);
  EXPECT_NEAR(feedback_[2].position_counts, 50000, 3000);
  stop();
}

TEST_F(MasterOverVirtualDrives, TellsInACycleWhereADriveWasAtTheSyncOfTheOneBefore) {
  constexpr std::int32_t kShift = 5000, kStands = 100;
  Node& node = wire_.add(1);
  make({{"node", {1}}}, {{"eds", "rmac-vdrive"}});
  ASSERT_TRUE(start().has_value());
  cycles(20, DriveWish::Off);
  const std::int32_t before = feedback_[0].position_counts;
  node.axis().shift_encoder(kShift);
  cycles(1, DriveWish::Off);
  EXPECT_NEAR(feedback_[0].position_counts, before, kStands);
  cycles(1, DriveWish::Off);
  EXPECT_NEAR(feedback_[0].position_counts, before + kShift, kStands);
  EXPECT_EQ(master_->answer_delay(0), 1);
  stop();
}

TEST_F(MasterOverVirtualDrives, MovesTwoThatShareAnRpdoEachByItsOwnWords) {
  wire_.add(1);
  wire_.add(2);
  make({{"node", {1, 2}}, {"rpdo_node", {1, 1}}}, {{"rpdo_0", "6040:00/16 6071:00/16 0007:00/32"},
                                                   {"rpdo_1", "0007:00/32 6040:00/16 6071:00/16"},
                                                   {"tpdo", "6041:00/16 6064:00/32"},
                                                   {"eds", "rmac-vdrive"}});
  ASSERT_TRUE(start().has_value());
  cycles(20, DriveWish::Operational);
  for (const DriveFeedback& words : feedback_) ASSERT_EQ(drive_state(words.statusword), DriveState::OperationEnabled);
  for (DriveCommand& command : commands_) command.mode = DriveMode::CyclicSyncTorque;
  commands_[0].target_torque_permille = 300;
  commands_[1].target_torque_permille = -300;
  cycles(200, DriveWish::Operational);
  EXPECT_GT(feedback_[0].position_counts, 10000);
  EXPECT_LT(feedback_[1].position_counts, -10000);
  stop();
}

TEST_F(MasterOverVirtualDrives, BringsBackOneOfTwoThatShareAnRpdo) {
  Node& stays = wire_.add(1);
  Node& goes = wire_.add(2);
  make({{"node", {1, 2}}, {"rpdo_node", {1, 1}}}, {{"rpdo_0", "6040:00/16 6071:00/16 0007:00/32"},
                                                   {"rpdo_1", "0007:00/32 6040:00/16 6071:00/16"},
                                                   {"tpdo", "6041:00/16 6064:00/32"},
                                                   {"eds", "rmac-vdrive"}});
  ASSERT_TRUE(start().has_value());
  cycles(20, DriveWish::Operational);
  goes.outlet().set_mute(true);
  cycles(200, DriveWish::Operational);
  EXPECT_FALSE(feedback_[1].online);
  EXPECT_EQ(stays.axis().state(), PowerStates::OperationEnabled);
  goes.outlet().set_mute(false);
  cycles(1500, DriveWish::Operational);
  EXPECT_TRUE(feedback_[1].online);
  EXPECT_EQ(stays.axis().state(), PowerStates::OperationEnabled) << "it never noticed";
  stop();
}

TEST_F(MasterOverVirtualDrives, CarriesInputsAndTouchProbes) {
  Node& node = wire_.add(1);
  make({{"node", {1}}}, {{"rpdo", "6040:00/16 6071:00/16 60B8:00/16"},
                         {"tpdo", "6041:00/16 6064:00/32 60B9:00/16"},
                         {"second_tpdo", "60FD:00/32 60BA:00/32"},
                         {"eds", "rmac-vdrive"}});
  EXPECT_EQ(master_->input_bits(0), 0xFFFFFFFFU);
  EXPECT_TRUE(master_->latches(0, TouchProbeEdge::FirstRising));
  EXPECT_FALSE(master_->latches(0, TouchProbeEdge::FirstFalling)) << "60BBh is not mapped";
  ASSERT_TRUE(start().has_value());
  commands_[0].mode = DriveMode::CyclicSyncTorque;
  commands_[0].touch_probe = touch_probe::latch_once(TouchProbeEdge::FirstRising);
  cycles(20, DriveWish::Operational);
  EXPECT_EQ(feedback_[0].touch_probe, 1);
  EXPECT_EQ(feedback_[0].inputs, 0U);
  commands_[0].target_torque_permille = 200;
  cycles(100, DriveWish::Operational);
  const std::int32_t before = feedback_[0].position_counts;
  node.axis().touch(true);
  cycles(3, DriveWish::Operational);
  EXPECT_EQ(feedback_[0].touch_probe, 3);
  EXPECT_EQ(feedback_[0].inputs, 1U << 16U);
  EXPECT_GT(feedback_[0].latched_counts[0], before);
  EXPECT_LT(feedback_[0].latched_counts[0], feedback_[0].position_counts);
  commands_[0].touch_probe = 0;
  cycles(3, DriveWish::Operational);
  EXPECT_EQ(feedback_[0].touch_probe, 0);
  stop();
}

/// A sine in position mode, with words beside the positions; how far the drive is behind at most.
class OffsetsOverTheBus : public MasterOverVirtualDrives {
 protected:
  double farthest(bool velocity, bool torque) {
    master_.reset();
    wire_ = Wire();
    Node& node = wire_.add(1);
    std::string second = velocity ? "60B1:00/32" : "";
    if (torque) second += " 60B2:00/16";
    make({{"node", {1}}, {"mode", {8}}}, {{"rpdo", "6040:00/16 607A:00/32"},
                                          {"second_rpdo", second},
                                          {"tpdo", "6041:00/16 6064:00/32"},
                                          {"setup", "2002:00/16=0"},  // no velocity of its own
                                          {"eds", "rmac-vdrive"}});
    EXPECT_TRUE(start().has_value());
    commands_[0].mode = DriveMode::CyclicSyncPosition;
    commands_[0].target_position_counts = feedback_[0].position_counts;
    cycles(20, DriveWish::Operational);
    EXPECT_EQ(drive_state(feedback_[0].statusword), DriveState::OperationEnabled);
    const fieldbus::AxisPlantParameters plant;
    const double permille_per_count =
        plant.inertia_kg_m2() * 2 * M_PI / plant.encoder.counts_per_revolution / plant.rated_torque_nm * 1000;
    const double from = feedback_[0].position_counts, w = 2 * M_PI / 0.2, amplitude = 65536;
    double farthest = 0;
    for (int i = 1; i <= 400; ++i) {
      const double t = i * 0.001, half = 0.0005;
      commands_[0].target_position_counts =
          static_cast<std::int32_t>(std::lround(from + amplitude * (1 - std::cos(w * t))));
      commands_[0].velocity_offset_rpm = amplitude * w * std::sin(w * (t - half));  // units of the drive: counts/s
      commands_[0].torque_offset_permille =
          static_cast<std::int16_t>(std::lround(permille_per_count * amplitude * w * w * std::cos(w * (t - half))));
      cycles(1, DriveWish::Operational);
      if (i > 100) farthest = std::max(farthest, std::abs(static_cast<double>(node.dictionary().number(0x60F4))));
    }
    stop();
    return farthest;
  }
};

// Red where one of the two words does not arrive, or not in the cycle of its position.
TEST_F(OffsetsOverTheBus, FollowNearestWithBothInASecondRpdo) {
  const double alone = farthest(false, false), velocity = farthest(true, false), both = farthest(true, true);
  EXPECT_LT(velocity, alone / 3);
  EXPECT_LT(both, velocity / 2);
  RecordProperty("alone_counts", std::to_string(alone));
  RecordProperty("velocity_counts", std::to_string(velocity));
  RecordProperty("velocity_and_torque_counts", std::to_string(both));
}

TEST_F(MasterOverVirtualDrives, SeesFaultsAndGoesOnAfterThem) {
  Node& hot = wire_.add(1);
  Node& mute = wire_.add(2);
  make({{"node", {1, 2}}}, {{"eds", "rmac-vdrive"}});
  ASSERT_TRUE(start().has_value());
  cycles(20, DriveWish::Operational);
  hot.axis().set_overheated(true);
  cycles(20, DriveWish::Operational);
  EXPECT_EQ(drive_state(feedback_[0].statusword), DriveState::Fault);
  EXPECT_EQ(feedback_[0].error_code, 0x4310);
  hot.axis().set_overheated(false);
  mute.outlet().set_mute(true);
  cycles(5, DriveWish::Off);
  EXPECT_FALSE(feedback_[1].online);
  mute.outlet().set_mute(false);
  // Its heartbeat was away for less than the master waits: the answers are back at once.
  cycles(5, DriveWish::Off);
  EXPECT_TRUE(feedback_[1].online);
  mute.outlet().set_mute(true);
  cycles(200, DriveWish::Off);
  mute.outlet().set_mute(false);
  cycles(1500, DriveWish::Off);
  EXPECT_TRUE(feedback_[1].online) << "brought up again";
  hot.set_pdo_length_change(-1);
  cycles(5, DriveWish::Off);
  EXPECT_FALSE(feedback_[0].online);
  EXPECT_GT(master_->counters().short_answers, 0U);
  hot.set_pdo_length_change(0);
  cycles(5, DriveWish::Off, true);
  EXPECT_TRUE(feedback_[0].online);
  EXPECT_NE(drive_state(feedback_[0].statusword), DriveState::Fault);
  stop();
}

TEST_F(MasterOverVirtualDrives, StopsThemByItsDeath) {
  Node& node = wire_.add(1);
  make({{"node", {1}}}, {{"eds", "rmac-vdrive"}, {"setup", "605A:00/16=6"}});
  ASSERT_TRUE(start().has_value());
  cycles(20, DriveWish::Operational);
  EXPECT_EQ(node.axis().state(), PowerStates::OperationEnabled);
  wire_.pass(milliseconds(100));  // two heartbeat periods
  EXPECT_EQ(node.axis().state(), PowerStates::QuickStop);
}

}  // namespace
}  // namespace rmac::vdrive::test
