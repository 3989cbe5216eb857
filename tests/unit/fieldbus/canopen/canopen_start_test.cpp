// What a start of the bus leaves behind of the run before, and of a start that fails.
#include <gtest/gtest.h>

#include "rmac/fieldbus/canopen/nmt.hpp"
#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::milliseconds;
using test::CanopenBench;
using test::CanWire;
using test::PowerStates;
using test::VirtualDrive;

// Red when a start that fails leaves a running interface without its port: the next cycle crashed.
TEST_F(CanopenBench, StandsStillWhereItIsStartedAgainAndThatFails) {
  VirtualDrive& drive = wire_.add(1);
  make({{"node", {1}}});
  start();
  enable_all();
  drive.answers_sdo = false;
  EXPECT_NE(start_error(), "it started");
  EXPECT_NE(drive.state(), PowerStates::OperationEnabled);
  cycles(3, DriveWish::Operational);
  EXPECT_TRUE(sound_) << "as one that was never started";
  EXPECT_FALSE(feedback_[0].online);
  master_->stop();
  drive.answers_sdo = true;
  EXPECT_EQ(start_error(), "it started");
  EXPECT_EQ(drive.state(), PowerStates::Fault) << "it missed its master meanwhile";
  for (const bool reset : {false, false, true, false}) cycle(DriveWish::Operational, reset);
  enable_all();
}

// Red when what a drive said before the bus was stopped counts for an answer.
TEST_F(CanopenBench, TakesNoDriveForPresentThatHasNotAnsweredSinceTheStart) {
  VirtualDrive& drive = wire_.add(1);
  make({{"node", {1}}});
  start();
  enable_all();
  master_->stop();
  drive.answers_sync = false;
  ASSERT_EQ(start_error(), "it started");
  for (int i = 0; i < 5; ++i) {
    cycle();
    ASSERT_FALSE(feedback_[0].online) << "cycle " << i;
    ASSERT_FALSE(feedback_[0].missed) << "nothing was expected yet";
  }
}

// The phase of another's SYNC is not the master's, and it may come late: drives act on what they were told last before
// they are reset.
TEST_F(CanopenBench, LetsASyncOfAnotherPassBeforeItResetsDrives) {
  wire_.add(1);
  make({{"node", {1}}}, {{"sync", "external"}});
  start();
  CanWire::Time told{}, reset{};
  wire_.listen = [&](const CanFrame& frame) {
    if (frame.id == 0x201) told = wire_.now();
    if (frame.id == nmt_frame(NmtCommand::ResetCommunication, 1).id) reset = wire_.now();
  };
  master_->stop();
  constexpr milliseconds kCycle{1};
  EXPECT_GE(reset - told, kCycle + std::chrono::microseconds(500)) << "the phase, and half a cycle late";
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
