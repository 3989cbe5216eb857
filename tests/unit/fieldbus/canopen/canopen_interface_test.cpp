#include "rmac/fieldbus/canopen/canopen_interface.hpp"

#include <random>

#include "conformance/control_interface_conformance.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"
#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace {

using namespace rmac;
using namespace rmac::fieldbus;
using namespace rmac::fieldbus::test;
using std::chrono::milliseconds;

/// A cycle of the bus passes with every exchange; the answers to the first SYNC come with the second.
class Paced final : public DigitalControlInterface {
 public:
  Paced(DigitalControlInterface& bus, CanWire& wire) : bus_(bus), wire_(wire) {}
  std::size_t axis_count() const noexcept override { return bus_.axis_count(); }
  Expected<> start() override {
    return bus_.start().map([this] {
      std::vector<DriveCommand> commands(axis_count());
      std::vector<DriveFeedback> feedback(axis_count());
      EXPECT_TRUE(exchange(commands, feedback));
    });
  }
  void stop() noexcept override { bus_.stop(); }
  [[nodiscard]] bool receive(std::span<DriveFeedback> feedback) noexcept override { return bus_.receive(feedback); }
  bool send(std::span<const DriveCommand> commands) noexcept override {
    const bool sound = bus_.send(commands);
    wire_.pass(milliseconds(1));
    return sound;
  }

 private:
  DigitalControlInterface& bus_;
  CanWire& wire_;
};

TEST_F(CanopenBench, ConformsToThePort) {
  wire_.add(1);
  wire_.add(2);
  make({{"node", {1, 2}}});
  Paced paced(*master_, wire_);
  conformance::ControlInterfaceConformance(paced, 1).check();
}

TEST_F(CanopenBench, ConformsToThePortWithSyncFirst) {
  wire_.add(1);
  make({{"node", {1}}}, {{"sync", "first"}});
  Paced paced(*master_, wire_);
  conformance::ControlInterfaceConformance(paced, 0).check();
}

TEST_F(CanopenBench, ReadsASensorBesideADriveWithItsSign) {
  VirtualDrive& drive = wire_.add(1);
  wire_.add(2);
  drive.set_bytes({0x6401, 1}, {0, 0});
  make({{"node", {1, 2}}}, {{"tpdo_0", "6041:00/16 6064:00/32 6401:01/16"}, {"sensor_0", "6401:01/16"}});
  start();
  std::vector<DriveCommand> commands(2);
  std::vector<DriveFeedback> feedback(2);
  for (const int reading : {0, 1234, -1234, 32767, -32768}) {
    drive.set(0x6401, 1, static_cast<std::uint16_t>(reading), 2);
    for (int i = 0; i < 3; ++i) {
      (void)master_->exchange(commands, feedback);
      wire_.pass(milliseconds(1));
    }
    EXPECT_EQ(feedback[0].sensor_counts, reading);
    EXPECT_TRUE(feedback[0].sensor_valid);
    EXPECT_FALSE(feedback[1].sensor_valid) << "no sensor is named beside this one";
  }
}

TEST_F(CanopenBench, LeavesSyncToTheNodeThatProducesIt) {
  wire_.add(1);
  make({{"node", {1}}}, {{"sync", "external"}});
  int syncs = 0, setpoints = 0;
  start();
  wire_.listen = [&](const CanFrame& frame) {
    syncs += frame.id == canopen::sync_frame().id ? 1 : 0;
    setpoints += frame.id == 0x201 ? 1 : 0;
  };
  std::vector<DriveCommand> commands(1);
  std::vector<DriveFeedback> feedback(1);
  for (int i = 0; i < 20; ++i) {
    (void)master_->exchange(commands, feedback);
    wire_.pass(milliseconds(1));
  }
  master_->stop();
  EXPECT_EQ(syncs, 0);
  EXPECT_GE(setpoints, 20);
}

TEST_F(CanopenBench, WritesMappingWatchAndModeAtBoot) {
  VirtualDrive& drive = wire_.add(5);
  make({{"node", {5}}, {"mode", {8}}, {"heartbeat_ms", {40}}}, {{"setup", "6085:00/32=70000"}});
  start();
  EXPECT_EQ(drive.value(0x1400, 1), 0x205U);
  EXPECT_EQ(drive.value(0x1400, 2), 1U);
  EXPECT_EQ(drive.value(0x1600, 0), 2U);
  EXPECT_EQ(drive.value(0x1600, 1), 0x60400010U);
  EXPECT_EQ(drive.value(0x1600, 2), 0x607A0020U);
  EXPECT_EQ(drive.value(0x1800, 1), 0x40000185U);
  EXPECT_EQ(drive.value(0x1A00, 2), 0x60640020U);
  EXPECT_EQ(drive.value(0x1401, 1) >> 31, 1U) << "a PDO that nobody counted stays valid";
  EXPECT_EQ(drive.value(0x1801, 1) >> 31, 1U);
  EXPECT_EQ(drive.value(0x1016, 1), 127U << 16 | 60U) << "the drive watches the master for one and a half periods";
  EXPECT_EQ(drive.value(0x1017, 0), 40U);
  EXPECT_EQ(drive.value(0x6007, 0), 3U) << "abort connection: quick stop";
  EXPECT_EQ(drive.value(0x6060, 0), 8U);
  EXPECT_EQ(drive.value(0x6085, 0), 70000U);
}

TEST_F(CanopenBench, NamesTheNodeThatIsMissingAndHowLongItWaited) {
  wire_.add(1);
  make({{"node", {1, 7}}, {"boot_timeout_s", {2.5}}});
  const auto before = wire_.now();
  EXPECT_EQ(
      start_error(),
      "node 7 (axis 1) is missing: no boot-up message in 2.5 s; check its power, its cable, its node id, and that "
      "it is set to 1000000 bit/s");
  EXPECT_NEAR(static_cast<double>((wire_.now() - before).count()) * 1e-9, 2.5, 0.1);
}

TEST_F(CanopenBench, TellsAnotherDeviceFromTheOneConfigured) {
  VirtualDrive& drive = wire_.add(3);
  make({{"node", {3}}, {"vendor_id", {0x103}}, {"product_code", {0x999}}});
  EXPECT_EQ(start_error(),
            "node 3 (axis 0) is another device than configured: its product code (1018h:02) is 203h, not 999h");
  drive.power_off();
  drive.set(0x1000, 0, 0x000F0191, 4);
  drive.power_on(wire_.now());
  EXPECT_EQ(start_error(),
            "node 3 (axis 0) is not a drive: its device type (1000h) is 000F0191h, and a CiA 402 drive ends in 0192h");
}

TEST_F(CanopenBench, RefusesADriveThatCannotDoTheMode) {
  VirtualDrive& drive = wire_.add(3);
  drive.power_off();
  drive.set(0x6502, 0, 0x05, 4);
  drive.power_on(wire_.now());
  make({{"node", {3}}});
  EXPECT_EQ(start_error(),
            "node 3 (axis 0) cannot do cyclic synchronous torque (mode 10): 6502h:00 says that it does the modes 1, "
            "3");
}

TEST_F(CanopenBench, RefusesADriveThatTurnsPositionsRoundAndFollowsTorques) {
  VirtualDrive& drive = wire_.add(3);
  drive.power_off();
  drive.set(0x607E, 0, 0x80, 1);
  drive.power_on(wire_.now());
  make({{"node", {3}}});
  EXPECT_EQ(
      start_error(),
      "node 3 (axis 0) turns its positions round (607Eh:00 is 80h), and follows torques, so it could run away; "
      "set polarity to 0 and the actuator's Direction to -1, or polarity to 128 where the drive turns its torques "
      "round, too");
  make({{"node", {3}}, {"polarity", {0}}});
  start();
  EXPECT_EQ(drive.value(0x607E, 0), 0U);
}

TEST_F(CanopenBench, ReadsWhatADriveCountsInATurnOfItsMotor) {
  VirtualDrive& drive = wire_.add(3);
  const auto counts = [&](const Numbers& numbers, const std::vector<std::pair<std::uint16_t, std::uint32_t>>& ratios) {
    drive.power_off();
    for (const int index : {0x608F, 0x6091, 0x6092}) drive.remove(static_cast<std::uint16_t>(index));
    for (const auto& [index, over] : ratios) {
      drive.set(index, 1, over, 4);
      drive.set(index, 2, 1, 4);
    }
    drive.power_on(wire_.now());
    make(numbers);
    start();
    const double told = master_->counts_per_revolution(0);
    master_->stop();
    return told;
  };
  EXPECT_EQ(counts({{"node", {3}}}, {}), 0) << "it does not say";
  EXPECT_EQ(counts({{"node", {3}}}, {{0x608F, 131072}}), 131072) << "without a feed constant the encoder's";
  EXPECT_EQ(counts({{"node", {3}}}, {{0x608F, 131072}, {0x6091, 4}, {0x6092, 10000}}), 2500);
  EXPECT_EQ(counts({{"node", {3}}, {"gear_motor_turns", {5}}, {"gear_shaft_turns", {2}}, {"feed_counts", {10000}}},
                   {{0x608F, 131072}, {0x6091, 1}, {0x6092, 1}}),
            4000)
      << "10000 counts a turn of the shaft, which are 2.5 turns of the motor";
  EXPECT_EQ(counts({{"node", {3}}, {"check_scale", {0}}}, {{0x608F, 131072}}), 0) << "not asked for";
}

TEST_F(CanopenBench, SaysWhichObjectADriveRefusedAndWhy) {
  wire_.add(3).remove(0x6007);
  make({{"node", {3}}});
  EXPECT_EQ(
      start_error(),
      "node 3 (axis 0) refused 3h for 6007h:00: object does not exist in the object dictionary (06020000h); it is "
      "needed for it to stop when the master dies (where abort_connection is -1 it is not written)");
  make({{"node", {3}}, {"abort_connection", {-1}}});
  EXPECT_EQ(start_error(), "it started");
}

TEST_F(CanopenBench, SaysWhatADriveLeftUnanswered) {
  wire_.add(3).answers_sdo = false;
  make({{"node", {3}}});
  EXPECT_EQ(start_error(),
            "node 3 (axis 0) did not answer when 1000h:00 was read: SDO protocol timed out; a drive that takes longer "
            "to answer needs a longer sdo_timeout_ms");
}

TEST_F(CanopenBench, MovesSeveralAxesOfOneNode) {
  VirtualDrive& drive = wire_.add(9, 2);
  make({{"node", {9, 9}}, {"axis_in_node", {0, 1}}, {"mode", {8, 9}}});
  start();
  enable_all();
  EXPECT_EQ(drive.value(0x1640, 2), 0x68FF0020U) << "the second axis's objects lie 800h above the first's";
  commands_[0].target_position_counts = -4000;
  commands_[1].target_velocity_rpm = 2500;
  cycles(100, DriveWish::Operational);
  EXPECT_EQ(feedback_[0].position_counts, -4000);
  EXPECT_NEAR(drive.velocity(1), 2500, 1);
  EXPECT_GT(feedback_[1].position_counts, 200);
}

TEST_F(CanopenBench, TurnsASpindleInItsDrivesOwnUnits) {
  VirtualDrive& drive = wire_.add(4);
  make({{"node", {4}}, {"mode", {3}}, {"velocity_units_per_rpm", {10}}});
  start();
  enable_all();
  commands_[0].target_velocity_rpm = -600;
  cycles(5, DriveWish::Operational);
  EXPECT_EQ(drive.velocity(), -6000);
  EXPECT_EQ(feedback_[0].velocity_rpm, -600);
}

TEST_F(CanopenBench, StopsEveryDriveWithinTwoHeartbeatPeriodsOfTheMastersDeath) {
  VirtualDrive& a = wire_.add(1);
  VirtualDrive& b = wire_.add(2);
  make({{"node", {1, 2}}, {"heartbeat_ms", {50}}});
  std::mt19937 random(288);
  for (int death = 0; death < 200; ++death) {
    start();
    enable_all();
    for (DriveCommand& command : commands_) command.target_torque_permille = 300;
    cycles(30 + static_cast<int>(random() % 100), DriveWish::Operational);
    ASSERT_GT(a.velocity(), 0);
    wire_.pass(milliseconds(100));  // nobody calls the cycle any more
    for (const VirtualDrive* drive : {&a, &b}) {
      ASSERT_EQ(drive->state(), PowerStates::QuickStop);
      ASSERT_EQ(drive->value(0x603F, 0), 0x8130U);
    }
    wire_.pass(milliseconds(500));
    ASSERT_EQ(a.velocity(), 0);
    for (DriveCommand& command : commands_) command = {};
  }
}

TEST_F(CanopenBench, LeavesDrivesInPeaceWhenItStops) {
  VirtualDrive& drive = wire_.add(1);
  make({{"node", {1}}});
  start();
  enable_all();
  master_->stop();
  EXPECT_EQ(drive.state(), PowerStates::SwitchOnDisabled);
  wire_.pass(std::chrono::seconds(2));
  EXPECT_EQ(drive.value(0x603F, 0), 0U) << "a drive that was let go misses its master";
  start();
  enable_all();
}

TEST_F(CanopenBench, BringsBackANodeThatWasGoneAndEnablesNothing) {
  wire_.add(1);
  VirtualDrive& drive = wire_.add(2);
  make({{"node", {1, 2}}, {"heartbeat_ms", {20}}});
  start();
  enable_all();
  drive.power_off();
  cycles(31, DriveWish::Operational);
  EXPECT_TRUE(sound_);
  EXPECT_TRUE(feedback_[0].online);
  EXPECT_FALSE(feedback_[1].online);
  cycles(3000, DriveWish::Off);
  EXPECT_EQ(master_->counters().nodes_lost, 1U);
  drive.power_on(wire_.now());
  commands_[1] = {};
  for (int i = 0; i < 2000 && !feedback_[1].online; ++i) cycle(DriveWish::Off);
  EXPECT_TRUE(feedback_[1].online) << "not operational again within 2 s";
  EXPECT_EQ(master_->counters().nodes_recovered, 1U);
  EXPECT_EQ(drive.state(), PowerStates::SwitchOnDisabled);
  enable_all();
}

// Red when a drive that is away misses answers all the time: the count is of a bus that loses some.
TEST_F(CanopenBench, CountsNoAnswersOfANodeThatIsLost) {
  VirtualDrive& drive = wire_.add(2);
  make({{"node", {2}}, {"heartbeat_ms", {20}}});
  start();
  enable_all();
  drive.power_off();
  while (master_->counters().nodes_lost == 0) cycle(DriveWish::Off);
  cycle(DriveWish::Off);
  const std::uint64_t missed = master_->counters().missed_answers;
  EXPECT_GT(missed, 0U) << "before it was known to be lost";
  cycles(100, DriveWish::Off);
  EXPECT_EQ(master_->counters().missed_answers, missed);
}

TEST_F(CanopenBench, BringsBackANodeThatFellOutOfOperational) {
  VirtualDrive& drive = wire_.add(2);
  make({{"node", {2}}});
  start();
  enable_all();
  drive.receive({.id = 0, .size = 2, .data = {0x80, 2}}, wire_.now());
  cycles(60, DriveWish::Operational);
  EXPECT_EQ(master_->counters().nodes_lost, 1U);
  cycles(1500, DriveWish::Off);
  EXPECT_TRUE(feedback_[0].online);
  EXPECT_TRUE(drive.operational());
}

TEST_F(CanopenBench, RecoversFromACutCable) {
  VirtualDrive& drive = wire_.add(2);
  make({{"node", {2}}});
  start();
  enable_all();
  wire_.cut = true;
  cycles(500, DriveWish::Operational);
  EXPECT_FALSE(feedback_[0].online);
  EXPECT_EQ(drive.state(), PowerStates::QuickStop);
  wire_.cut = false;
  cycles(2000, DriveWish::Off);
  EXPECT_TRUE(feedback_[0].online);
  EXPECT_NE(drive.state(), PowerStates::OperationEnabled);
}

TEST_F(CanopenBench, ReportsWhatADriveSaysInAnEmergency) {
  VirtualDrive& drive = wire_.add(1);
  make({{"node", {1}}});
  start();
  enable_all();
  drive.trip(0x2310);
  cycles(3, DriveWish::Operational);
  EXPECT_EQ(feedback_[0].error_code, 0x2310);
  EXPECT_EQ(drive_state(feedback_[0].statusword), DriveState::Fault);
  cycles(50, DriveWish::Operational);
  EXPECT_EQ(drive.state(), PowerStates::Fault);
  for (int i = 0; i < 10; ++i) cycle(DriveWish::Off, true);
  EXPECT_EQ(drive.state(), PowerStates::SwitchOnDisabled);
}

// Red when an error code that a drive tells in its PDO gives way to the code of an emergency message.
TEST_F(CanopenBench, BelievesTheErrorCodeOfAPdoRatherThanThatOfAnEmergency) {
  VirtualDrive& drive = wire_.add(1);
  make({{"node", {1}}}, {{"tpdo_0", "6041:00/16 6064:00/32 603F:00/16"}});
  start();
  drive.set(0x603F, 0, 0x7305, 2);
  wire_.inject({.id = 0x81, .size = 8, .data = {0x10, 0x81, 0x11}});
  cycles(3, DriveWish::Off);
  EXPECT_EQ(feedback_[0].error_code, 0x7305);
  EXPECT_EQ(master_->counters().emergencies, 1U);
}

// Red when what a node that is away still sends counts: it would be online again with positions from before.
TEST_F(CanopenBench, TakesNoAnswerFromANodeThatIsNotUp) {
  VirtualDrive& drive = wire_.add(2);
  make({{"node", {2}}, {"heartbeat_ms", {20}}});
  start();
  enable_all();
  drive.power_off();
  cycles(100, DriveWish::Off);
  ASSERT_EQ(master_->counters().nodes_lost, 1U);
  const DriveFeedback before = feedback_[0];
  wire_.inject({.id = 0x182, .size = 8, .data = {0x27, 0x02, 0x39, 0x30}});
  cycles(2, DriveWish::Off);
  EXPECT_EQ(feedback_[0].statusword, before.statusword);
  EXPECT_EQ(feedback_[0].position_counts, before.position_counts);
  drive.answers_sync = false;
  drive.power_on(wire_.now());
  for (int i = 0; i < 3000 && master_->counters().nodes_recovered == 0; ++i) cycle(DriveWish::Off);
  ASSERT_EQ(master_->counters().nodes_recovered, 1U);
  EXPECT_FALSE(feedback_[0].online) << "it has not answered since it came up";
  drive.answers_sync = true;
  cycles(3, DriveWish::Off);
  EXPECT_TRUE(feedback_[0].online);
}

TEST_F(CanopenBench, CountsAFullQueueAsAFaultOfItsCycleAndNeverRetries) {
  wire_.add(1);
  make({{"node", {1}}});
  start();
  enable_all();
  int carried = 0;
  wire_.listen = [&](const CanFrame& frame) { carried += frame.id == 0x201 ? 1 : 0; };
  wire_.full = true;
  cycle(DriveWish::Operational);
  EXPECT_FALSE(sound_);
  EXPECT_EQ(master_->counters().unsent, 2U) << "setpoints and SYNC";
  EXPECT_EQ(carried, 0);
  wire_.full = false;
  cycle(DriveWish::Operational);
  EXPECT_TRUE(sound_);
  EXPECT_EQ(carried, 1) << "the setpoint of the lost cycle came late";
}

TEST_F(CanopenBench, PassesOverOneMissedAnswerAndNotTwo) {
  VirtualDrive& drive = wire_.add(1);
  make({{"node", {1}}});
  start();
  enable_all();
  drive.answers_sync = false;
  cycle(DriveWish::Operational);
  drive.answers_sync = true;
  cycle(DriveWish::Operational);
  EXPECT_TRUE(feedback_[0].online);
  EXPECT_EQ(master_->counters().missed_answers, 1U);
  cycle(DriveWish::Operational);
  EXPECT_TRUE(feedback_[0].online);
  drive.answers_sync = false;
  cycles(3, DriveWish::Operational);
  EXPECT_FALSE(feedback_[0].online);
}

TEST_F(CanopenBench, TakesNothingFromAnAnswerThatIsTooShort) {
  VirtualDrive& drive = wire_.add(1);
  make({{"node", {1}}});
  start();
  enable_all();
  drive.tpdo_length_change = 1;
  cycles(4, DriveWish::Operational);
  EXPECT_FALSE(feedback_[0].online);
  EXPECT_EQ(master_->counters().short_answers, 3U);
}

TEST_F(CanopenBench, SendsAllSetpointsBeforeTheSyncOfTheirCycle) {
  for (const auto node : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}}) wire_.add(node);
  make({{"node", {1, 2, 3}}, {"mode", {8}}, {"load_share", {100}}});
  start();
  enable_all();
  std::vector<unsigned> ids;
  wire_.listen = [&](const CanFrame& frame) {
    if (frame.id < 0x580) ids.push_back(frame.id);
  };
  cycle(DriveWish::Operational);
  EXPECT_EQ(ids, (std::vector<unsigned>{0x201, 0x202, 0x203, 0x080, 0x181, 0x182, 0x183}));
}

TEST_F(CanopenBench, HaltsAllAxesInOneSync) {
  std::vector<VirtualDrive*> drives;
  for (const auto node : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}}) drives.push_back(&wire_.add(node));
  make({{"node", {1, 2, 3}}});
  start();
  enable_all();
  for (auto& command : commands_) command.target_torque_permille = 100;
  cycles(20, DriveWish::Operational);
  for (std::size_t i = 0; i < drives.size(); ++i) commands_[i].controlword = controlword::kEnableVoltage;
  (void)master_->exchange(commands_, feedback_);
  for (const VirtualDrive* drive : drives) EXPECT_EQ(drive->state(), PowerStates::QuickStop);
}

TEST(CanopenTime, CountsDaysSince1984AndMillisecondsSinceMidnight) {
  using namespace std::chrono;
  constexpr sys_days kDay = year(2026) / November / 21;
  const CanFrame frame = canopen::time_frame(kDay + hours(10) + minutes(37) + seconds(45) + milliseconds(123));
  EXPECT_EQ(frame.id, 0x100);
  EXPECT_EQ(frame.size, 6);
  const std::uint32_t ms = canopen::long_at(frame.data.data());
  EXPECT_EQ(ms, ((10U * 60 + 37) * 60 + 45) * 1000 + 123);
  EXPECT_EQ(canopen::word_at(&frame.data[4]), 15665) << "date -d 2026-11-21 +%s and 1984-01-01, in days apart";
}

TEST_F(CanopenBench, SendsTimeAtItsIntervalWhereItIsAskedTo) {
  wire_.add(1);
  int times = 0;
  wire_.listen = [&](const CanFrame& frame) { times += frame.id == 0x100 ? 1 : 0; };
  make({{"node", {1}}});
  start();
  cycles(300, DriveWish::Off);
  EXPECT_EQ(times, 0);
  master_->stop();
  make({{"node", {1}}, {"time_s", {0.1}}});
  start();
  cycles(300, DriveWish::Off);
  EXPECT_NEAR(times, 4, 1);
}

}  // namespace
