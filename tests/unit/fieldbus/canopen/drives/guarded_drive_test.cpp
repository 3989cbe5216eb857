// Drives that make no heartbeat, and those whose statusword departs from the standard.
#include <gmock/gmock.h>

#include "canopen/drives/drive_of_node.hpp"
#include "unit/fieldbus/canopen/drives/known_drive.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using test::description_of;
using test::KnownDrive;
using test::VirtualDrive;
using testing::Contains;
using testing::HasSubstr;

class GuardedDrive : public KnownDrive {
 protected:
  /// No 1016h and 1017h, but 100Ch and 100Dh.
  VirtualDrive& add_guarded() {
    VirtualDrive& drive = wire_.add(1);
    drive.remove(0x1016);
    drive.remove(0x1017);
    drive.set_bytes({0x100C, 0}, {0, 0});
    drive.set_bytes({0x100D, 0}, {0});
    return drive;
  }
};

// Red when a question is missed, is no remote frame, or comes at another pace than the node was told.
TEST_F(GuardedDrive, IsAskedAtThePaceItWasTold) {
  VirtualDrive& drive = add_guarded();
  make_known(DriveManners{.node_guarding = true}, {{"node", {1}}});
  start();
  EXPECT_THAT(master_->start_notes(),
              Contains("node 1 knows no heartbeat of its master (1016h): it is guarded, by remote frames"));
  enable_all();
  EXPECT_EQ(drive.value(0x100C, 0), 50U);
  EXPECT_EQ(drive.value(0x100D, 0), 2U);
  int asked = 0;
  wire_.listen = [&](const CanFrame& frame) { asked += frame.remote && frame.id == 0x701 && frame.size == 1 ? 1 : 0; };
  for (int i = 0; i < 1000; ++i) {
    cycle(DriveWish::Operational);
    ASSERT_TRUE(feedback_[0].online) << i;
  }
  EXPECT_EQ(asked, 20);
  EXPECT_EQ(drive.state(), test::PowerStates::State::OperationEnabled);
}

// Red when heartbeats that it makes, too, are taken for copies of its answers.
TEST_F(GuardedDrive, IsTaughtToMakeNoHeartbeatWhereItCould) {
  VirtualDrive& drive = add_guarded();
  drive.set_bytes({0x1017, 0}, {20, 0});
  make_known(DriveManners{.node_guarding = true}, {{"node", {1}}});
  start();
  enable_all();
  EXPECT_EQ(drive.value(0x1017, 0), 0U);
  cycles(500, DriveWish::Operational);
  EXPECT_EQ(master_->counters().nodes_lost, 0U);
}

// Red when a node without heartbeats counts as there for ever.
TEST_F(GuardedDrive, IsLostWhenItAnswersNoMoreAndComesBack) {
  VirtualDrive& drive = add_guarded();
  make_known(DriveManners{.node_guarding = true}, {{"node", {1}}});
  start();
  enable_all();
  drive.sends_heartbeats = false;
  cycles(80, DriveWish::Operational);
  EXPECT_FALSE(feedback_[0].online);
  EXPECT_EQ(master_->counters().nodes_lost, 1U);
  drive.sends_heartbeats = true;
  cycles(3000, DriveWish::Off);
  EXPECT_TRUE(feedback_[0].online);
  enable_all();
}

// Red when the toggle bit is not looked at.
TEST_F(GuardedDrive, IsLostWhenItsAnswersAreCopies) {
  VirtualDrive& drive = add_guarded();
  make_known(DriveManners{.node_guarding = true}, {{"node", {1}}});
  start();
  enable_all();
  drive.repeats_toggle = true;
  cycles(200, DriveWish::Operational);
  EXPECT_GE(master_->counters().nodes_lost, 1U);
}

// Red when the master goes and the drive does not know it.
TEST_F(GuardedDrive, StopsByItselfWhenItsMasterIsGone) {
  VirtualDrive& drive = add_guarded();
  make_known(DriveManners{.node_guarding = true}, {{"node", {1}}});
  start();
  enable_all();
  wire_.pass(std::chrono::milliseconds(45));
  EXPECT_EQ(drive.state(), test::PowerStates::State::OperationEnabled) << "its life time is 100 ms";
  wire_.pass(std::chrono::milliseconds(110));
  EXPECT_EQ(drive.state(), test::PowerStates::State::QuickStop);
}

// Red when a drive whose life guarding begins as it is told sees its master dead while it is set up.
TEST_F(GuardedDrive, IsGuardedWhileItIsSetUp) {
  VirtualDrive& drive = add_guarded();
  drive.lives_from_writing = true;
  drive.sdo_time = std::chrono::milliseconds(30);
  int told = 0;
  wire_.listen = [&](const CanFrame& frame) { told += frame.id == 0x81 ? 1 : 0; };
  make_known(DriveManners{.node_guarding = true}, {{"node", {1}}});
  start();
  enable_all();
  EXPECT_EQ(told, 0) << "EMCY: life guard error";
  EXPECT_EQ(drive.state(), test::PowerStates::State::OperationEnabled);
}

TEST_F(GuardedDrive, IsRefusedWhereNobodySaysSo) {
  add_guarded();
  make({{"node", {1}}});
  EXPECT_THAT(start_error(), HasSubstr("1016h:01"));
}

TEST(Guarding, GoesNotWithADriveThatGoesOn) {
  const auto checked = check(DriveManners{.no_heartbeat_consumer = "it goes on", .node_guarding = true});
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().message, HasSubstr("/NodeGuarding is true and /NoHeartbeatConsumer is given"));
}

// Red when bit 5 is taken as it stands: Operation enabled reads as Quick stop active.
TEST_F(GuardedDrive, WithAnInvertedQuickStopBitIsEnabled) {
  for (const bool known : {true, false}) {
    master_.reset();
    wire_ = test::CanWire();
    wire_.add(1).quick_stop_mask = 1U << 5U;
    make_known(DriveManners{.quick_stop_inverted = known}, {{"node", {1}}});
    start();
    cycles(20, DriveWish::Operational);
    EXPECT_EQ(drive_state(feedback_[0].statusword) == DriveState::OperationEnabled, known);
  }
}

TEST(HomingWithoutTargetReached, IsOverWithItsResultInHomingAlone) {
  const DriveDescription drive = description_of({.homing_without_target_reached = true});
  const auto reached = [&](unsigned word, DriveMode mode, const DriveDescription* by) {
    const DriveFeedback told{.statusword = static_cast<std::uint16_t>(word), .mode = mode};
    return (status_by(by, told) & statusword::kTargetReached) != 0;
  };
  constexpr unsigned kEnabled = 0x0237, kAttained = 0x1237, kError = 0x2237, kFault = 0x2238;
  EXPECT_TRUE(reached(kAttained, DriveMode::Homing, &drive));
  EXPECT_TRUE(reached(kError, DriveMode::Homing, &drive));
  EXPECT_FALSE(reached(kEnabled, DriveMode::Homing, &drive)) << "it is on its way";
  EXPECT_FALSE(reached(kFault, DriveMode::Homing, &drive));
  EXPECT_FALSE(reached(kAttained, DriveMode::CyclicSyncPosition, &drive));
  EXPECT_FALSE(reached(kAttained, DriveMode::Homing, nullptr));
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
