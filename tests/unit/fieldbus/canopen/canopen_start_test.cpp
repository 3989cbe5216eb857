// What a start of the bus leaves behind of the run before, and of a start that fails.
#include <gtest/gtest.h>

#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using test::CanopenBench;
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

}  // namespace
}  // namespace rmac::fieldbus::canopen
