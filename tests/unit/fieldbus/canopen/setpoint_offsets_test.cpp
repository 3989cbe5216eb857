// What a drive that closes its loops itself is told beside its setpoint: torque (60B2h) and velocity (60B1h).
#include <gtest/gtest.h>

#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using test::CanopenBench;
using test::CanWire;
using test::Texts;
using test::VirtualDrive;

class SetpointOffsets : public CanopenBench {};

// Red with another object, unit or length, or where a word is cut off at its end.
TEST_F(SetpointOffsets, SendsATorqueBesideAPositionAndAVelocity) {
  for (const double mode : {8.0, 9.0}) {
    master_.reset();
    wire_ = CanWire();
    VirtualDrive& drive = wire_.add(1);
    drive.set_bytes({0x60B2, 0}, {0, 0});
    drive.set_bytes({0x6502, 0}, {0xFF, 0x03, 0, 0});
    make({{"node", {1}}, {"mode", {mode}}},
         {{"rpdo", mode == 8 ? "6040:00/16 607A:00/32 60B2:00/16" : "6040:00/16 60FF:00/32 60B2:00/16"}});
    EXPECT_TRUE(master_->takes_torque_offset(0));
    start();
    for (const std::int16_t permille : std::initializer_list<std::int16_t>{0, 1, -1, 32767, -32768}) {
      commands_[0].torque_offset_permille = permille;
      cycles(2, DriveWish::Operational);
      EXPECT_EQ(static_cast<std::int16_t>(drive.value(0x60B2, 0)), permille) << "mode " << mode;
    }
  }
}

TEST_F(SetpointOffsets, TakesNoTorqueBesideWhereNoneIsMapped) {
  wire_.add(1);
  make({{"node", {1}}, {"mode", {8}}});
  EXPECT_FALSE(master_->takes_torque_offset(0));
}

TEST_F(SetpointOffsets, SendsAVelocityOffsetInTheDrivesUnitsWithinItsWord) {
  VirtualDrive& drive = wire_.add(1);
  drive.set_bytes({0x60B1, 0}, {0, 0, 0, 0});
  make({{"node", {1}}, {"velocity_units_per_rpm", {10}}}, {{"rpdo", "6040:00/16 6071:00/16 60B1:00/32"}});
  start();
  for (const auto& [rpm, word] : {std::pair{0.0, 0}, {12.34, 123}, {-600.0, -6000}, {1e12, 2147483647}}) {
    commands_[0].velocity_offset_rpm = rpm;
    cycles(2, DriveWish::Operational);
    EXPECT_EQ(static_cast<std::int32_t>(drive.value(0x60B1, 0)), word);
  }
}

const Texts kBothOffsets{{"rpdo", "6040:00/16 607A:00/32"}, {"second_rpdo", "60B1:00/32 60B2:00/16"}};

class SecondRpdo : public CanopenBench {
 protected:
  VirtualDrive& add_drive() {
    VirtualDrive& drive = wire_.add(1);
    drive.set_bytes({0x60B1, 0}, {0, 0, 0, 0});
    drive.set_bytes({0x60B2, 0}, {0, 0});
    return drive;
  }
};

// Red where the second frame is not sent, is sent behind SYNC, or carries the words of another cycle.
TEST_F(SecondRpdo, ActsWithTheSameSyncAsTheFirst) {
  VirtualDrive& drive = add_drive();
  make({{"node", {1}}, {"mode", {8}}}, kBothOffsets);
  EXPECT_TRUE(master_->takes_torque_offset(0));
  start();
  enable_all();
  EXPECT_EQ(drive.value(0x1401, 1), 0x301U);
  for (int i = 1; i < 50; ++i) {
    commands_[0].target_position_counts = 1000 * i;
    commands_[0].velocity_offset_rpm = 100 * i;
    commands_[0].torque_offset_permille = static_cast<std::int16_t>(-i);
    cycle(DriveWish::Operational);
    ASSERT_EQ(drive.value(0x607A, 0), 1000U * static_cast<unsigned>(i));
    ASSERT_EQ(drive.value(0x60B1, 0), 100U * static_cast<unsigned>(i));
    ASSERT_EQ(static_cast<std::int16_t>(drive.value(0x60B2, 0)), -i);
  }
  master_->stop();
  EXPECT_EQ(drive.value(0x60B1, 0), 0U) << "nothing is left behind";
}

// Red where a frame is queued for a node that is away.
TEST_F(SecondRpdo, IsNotSentToANodeThatIsAway) {
  VirtualDrive& drive = add_drive();
  make({{"node", {1}}, {"mode", {8}}}, kBothOffsets);
  start();
  enable_all();
  drive.power_off();
  cycles(100, DriveWish::Operational);
  ASSERT_FALSE(feedback_[0].online);
  int sent = 0;
  wire_.listen = [&](const CanFrame& frame) { sent += frame.id == 0x301 ? 1 : 0; };
  cycles(100, DriveWish::Operational);
  EXPECT_EQ(sent, 0);
}

TEST_F(SecondRpdo, IsRefusedWhereTheDriveHasNone) {
  VirtualDrive& drive = add_drive();
  drive.remove(0x1401);
  make({{"node", {1}}, {"mode", {8}}}, kBothOffsets);
  EXPECT_EQ(start_error(),
            "node 1 (axis 0) refused 80000301h for 1401h:01: object does not exist in the object dictionary "
            "(06020000h); it is needed to send it its "
            "setpoints (second_rpdo)");
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
