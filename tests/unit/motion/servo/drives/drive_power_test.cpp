#include "rmac/motion/drive_power.hpp"

#include <gtest/gtest.h>

namespace {

using namespace rmac;

TEST(DriveState, IsDecodedFromTheBitsThatTheStandardNames) {
  EXPECT_EQ(drive_state(0x0000), DriveState::NotReadyToSwitchOn);
  EXPECT_EQ(drive_state(0x0020), DriveState::NotReadyToSwitchOn);
  EXPECT_EQ(drive_state(0x0040), DriveState::SwitchOnDisabled);
  EXPECT_EQ(drive_state(0x0060), DriveState::SwitchOnDisabled);
  EXPECT_EQ(drive_state(0x0021), DriveState::ReadyToSwitchOn);
  EXPECT_EQ(drive_state(0x0023), DriveState::SwitchedOn);
  EXPECT_EQ(drive_state(0x0027), DriveState::OperationEnabled);
  EXPECT_EQ(drive_state(0x0007), DriveState::QuickStopActive);
  EXPECT_EQ(drive_state(0x000F), DriveState::FaultReactionActive);
  EXPECT_EQ(drive_state(0x002F), DriveState::FaultReactionActive);
  EXPECT_EQ(drive_state(0x0008), DriveState::Fault);
  EXPECT_EQ(drive_state(0x0028), DriveState::Fault);
}

TEST(DriveState, IgnoresAllOtherBits) {
  constexpr std::uint16_t kOther = 0xFFFF & ~0x6F;
  EXPECT_EQ(drive_state(0x27 | kOther), DriveState::OperationEnabled);
  EXPECT_EQ(drive_state(0x40 | kOther), DriveState::SwitchOnDisabled);
}

TEST(DriveState, HasTheTextThatClientsRead) {
  EXPECT_STREQ(drive_state_text(0x0000), "not ready to switch on");
  EXPECT_STREQ(drive_state_text(0x0040), "switch on disabled");
  EXPECT_STREQ(drive_state_text(0x0021), "ready to switch on");
  EXPECT_STREQ(drive_state_text(0x0023), "switched on");
  EXPECT_STREQ(drive_state_text(0x0627), "operation enabled") << "whatever the other bits say";
  EXPECT_STREQ(drive_state_text(0x0007), "quick stop active");
  EXPECT_STREQ(drive_state_text(0x000F), "fault reaction active");
  EXPECT_STREQ(drive_state_text(0x0028), "fault");
}

TEST(DriveState, IsWaitedForWhereTheStandardLeavesThePatternUndefined) {
  EXPECT_EQ(drive_state(0x0001), DriveState::NotReadyToSwitchOn);
  EXPECT_STREQ(drive_state_text(0x0001), "unknown");
}

std::uint16_t towards(DriveWish wish, std::uint16_t statusword) {
  return next_controlword(statusword, wish, false, 0);
}

TEST(NextControlword, ClimbsOneTransitionACycle) {
  EXPECT_EQ(towards(DriveWish::Operational, 0x40), 0x06);
  EXPECT_EQ(towards(DriveWish::Operational, 0x21), 0x07);
  EXPECT_EQ(towards(DriveWish::Operational, 0x23), 0x0F);
  EXPECT_EQ(towards(DriveWish::Operational, 0x27), 0x0F);
}

TEST(NextControlword, ComesBackFromAQuickStopByDisablingTheVoltage) {
  EXPECT_EQ(towards(DriveWish::Operational, 0x07), 0x00);
}

TEST(NextControlword, DisablesTheVoltageToGoOff) {
  for (const unsigned word : {0x00U, 0x40U, 0x21U, 0x23U, 0x27U, 0x07U}) {
    EXPECT_EQ(towards(DriveWish::Off, static_cast<std::uint16_t>(word)), 0);
  }
}

TEST(NextControlword, AsksForAQuickStopByClearingItsBitAlone) {
  EXPECT_EQ(towards(DriveWish::QuickStop, 0x27), 0x02);
  EXPECT_EQ(towards(DriveWish::QuickStop, 0x07), 0x02);
}

TEST(NextControlword, NeverResetsAFaultUnasked) {
  for (const DriveWish wish : {DriveWish::Off, DriveWish::Operational, DriveWish::QuickStop}) {
    EXPECT_EQ(next_controlword(0x08, wish, false, 0) & controlword::kFaultReset, 0);
  }
}

TEST(NextControlword, ResetsAFaultOnARisingEdge) {
  std::uint16_t word = 0x80;
  word = next_controlword(0x08, DriveWish::Operational, true, word);
  EXPECT_EQ(word, 0x00) << "the bit must fall before it can rise";
  word = next_controlword(0x08, DriveWish::Operational, true, word);
  EXPECT_EQ(word, 0x80);
}

}  // namespace
