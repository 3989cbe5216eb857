#include "gateway/rmac/program/timing.hpp"

#include <gtest/gtest.h>

#include "gateway/api/methods/method_table.hpp"

namespace rmac::cli {
namespace {

TEST(Timing, IsAMoveForEveryMethodThatQueuesOne) {
  for (const gateway::Method& method : gateway::method_table()) {
    EXPECT_EQ(timing_of(method.name) == Timing::Move, method.effect == gateway::Effect::Queues) << method.name;
  }
}

TEST(Timing, NeverSendsAheadWhatStartsOrStopsMotion) {
  for (const gateway::Method& method : gateway::method_table()) {
    if (timing_of(method.name) != Timing::Stream) continue;
    EXPECT_EQ(method.effect, gateway::Effect::None) << method.name;
  }
}

TEST(Timing, SendsQuestionsWithoutWaiting) {
  for (const char* name : {"RMAC_CAM.GetState", "RMAC_CAM.CurrentPosition", "Device.Machine_GetMechanismName", "hello",
                           "subscribe", "authority.renew", "RMAC_CAM.StatusMajorCode"}) {
    EXPECT_EQ(timing_of(name), Timing::Stream) << name;
  }
}

TEST(Timing, SendsWhatHoldsForLaterMovesWithoutWaiting) {
  for (const char* name : {"RMAC_CAM.SetFeedrate", "RMAC_CAM.SetPathTolerance", "RMAC_CAM.SetOrientationTolerance",
                           "RMAC_CAM.SetPathAccelRise", "RMAC_CAM.SetPathAccelFall", "RMAC_CAM.SetFeedOverride",
                           "RMAC_CAM.SetJointInterpSpeed"}) {
    EXPECT_EQ(timing_of(name), Timing::Stream) << name;
  }
}

TEST(Timing, WaitsBeforeWhatActsOnTheMachineAndBeforeQuestionsAboutTheMoves) {
  for (const char* name :
       {"RMAC_CAM.Home", "RMAC_CAM.JogJoint", "RMAC_CAM.SetSpindleRPM", "RMAC_CAM.SetPartFrame", "RMAC_CAM.SetTool",
        "RMAC_CAM.TurnCoolantOn", "RMAC_CAM.SetOutput", "RMAC_Config.Apply", "Device.Load", "Device.Unload",
        "RMAC_CAM.CycleStop", "RMAC_CAM.NewHit", "RMAC_CAM.LastHitPosition", "RMAC_CAM.ProbeActive",
        "RMAC_CAM.Parameter", "RMAC_CAM.ControlMode", "FlightRecorder.Record"}) {
    EXPECT_EQ(timing_of(name), Timing::Settled) << name;
  }
}

TEST(Timing, KnowsBothStartsOfTheCycle) {
  EXPECT_EQ(timing_of("RMAC_CAM.CycleStart"), Timing::Start);
  EXPECT_EQ(timing_of("RMAC_CAM.SetCycleStartStatus"), Timing::Start);
}

TEST(Timing, WaitsBeforeWhatTheTableDoesNotHave) {
  EXPECT_EQ(timing_of("RMAC_CAM.MoveAlongMoebiusStrip"), Timing::Settled);
  EXPECT_EQ(timing_of("CycleStart"), Timing::Settled) << "the appliance has no such method either";
}

TEST(Timing, KnowsWhatStandsBetweenMoves) {
  for (const char* name :
       {"RMAC_CAM.Dwell", "RMAC_CAM.ProgramStop", "RMAC_CAM.AwaitInput", "RMAC_CAM.InTurn", "RMAC_CAM.DoToolChange"}) {
    EXPECT_TRUE(stands_between_moves(name)) << name;
    EXPECT_EQ(timing_of(name), Timing::Move) << name;
  }
  EXPECT_FALSE(stands_between_moves("RMAC_CAM.MoveAlongLine"));
  EXPECT_EQ(timing_of("RMAC_CAM.SetOptionalStop"), Timing::Settled) << "it is for the stops behind it";
}

TEST(Timing, KnowsTheMoveThatEndsAtThePart) {
  EXPECT_TRUE(measures("RMAC_CAM.AutoMeasure"));
  EXPECT_FALSE(measures("RMAC_CAM.MoveToXYZ"));
}

}  // namespace
}  // namespace rmac::cli
