#include <gtest/gtest.h>

#include <random>

#include "rmac/motion/drive_power.hpp"
#include "unit/fieldbus/canopen/virtual_drive.hpp"

namespace {

using namespace rmac;
using rmac::fieldbus::test::kOptions;
using rmac::fieldbus::test::PowerStates;

constexpr std::array kStates{
    PowerStates::NotReady,         PowerStates::SwitchOnDisabled, PowerStates::ReadyToSwitchOn, PowerStates::SwitchedOn,
    PowerStates::OperationEnabled, PowerStates::QuickStop,        PowerStates::FaultReaction,   PowerStates::Fault};

/// A drive that was led to a state by commands and a fault.
PowerStates drive_in(PowerStates::State state) {
  PowerStates drive;
  if (state == PowerStates::NotReady) return drive;
  drive.proceed(true, kOptions);
  for (const std::uint16_t word : std::array<std::uint16_t, 3>{0x06, 0x07, 0x0F}) {
    if (drive.state() == state) return drive;
    drive.control(word, kOptions);
  }
  if (state == PowerStates::QuickStop) drive.control(0x02, kOptions);
  if (state == PowerStates::FaultReaction || state == PowerStates::Fault) drive.raise_fault(kOptions);
  if (state == PowerStates::Fault) drive.proceed(true, kOptions);
  EXPECT_EQ(drive.state(), state);
  return drive;
}

/// A drive and its master, which sees each statusword `delay` cycles late, as over a bus.
class Served {
 public:
  Served(PowerStates::State state, std::size_t delay) : drive(drive_in(state)), delay_(delay) {
    seen_.assign(delay_ + 1, drive.statusword());
  }
  void cycle(DriveWish wish, bool reset) {
    word = next_controlword(seen_.front(), wish, reset, word);
    drive.control(word, kOptions);
    drive.proceed(true, kOptions);
    seen_.erase(seen_.begin());
    seen_.push_back(drive.statusword());
  }
  PowerStates drive;
  std::uint16_t word = 0;

 private:
  std::size_t delay_;
  std::vector<std::uint16_t> seen_;
};

TEST(PowerStates, AreReadOffTheStatuswordTheDriveReports) {
  constexpr std::array kExpected{DriveState::NotReadyToSwitchOn,  DriveState::SwitchOnDisabled,
                                 DriveState::ReadyToSwitchOn,     DriveState::SwitchedOn,
                                 DriveState::OperationEnabled,    DriveState::QuickStopActive,
                                 DriveState::FaultReactionActive, DriveState::Fault};
  for (std::size_t i = 0; i < kStates.size(); ++i) {
    const PowerStates drive = drive_in(kStates[i]);
    EXPECT_EQ(drive_state(drive.statusword()), kExpected[i]);
    // Bits that are not of the state: voltage, warning, maker's own, remote, target, limit, mode.
    for (const unsigned other : {0x0010U, 0x0080U, 0xFF00U}) {
      EXPECT_EQ(drive_state(static_cast<std::uint16_t>(drive.statusword() ^ other)), kExpected[i]);
    }
  }
}

TEST(PowerStates, AreLeftForWhatIsWishedFromEveryState) {
  for (const PowerStates::State from : kStates) {
    for (const std::size_t delay : {0U, 1U, 2U}) {
      for (const DriveWish wish : {DriveWish::Off, DriveWish::Operational, DriveWish::QuickStop}) {
        Served served(from, delay);
        for (int i = 0; i < 40; ++i) served.cycle(wish, false);
        const bool faulted = from == PowerStates::Fault || from == PowerStates::FaultReaction;
        const bool ran = from == PowerStates::OperationEnabled || from == PowerStates::QuickStop;
        const PowerStates::State expected = faulted                               ? PowerStates::Fault
                                            : wish == DriveWish::Operational      ? PowerStates::OperationEnabled
                                            : wish == DriveWish::QuickStop && ran ? PowerStates::QuickStop
                                                                                  : PowerStates::SwitchOnDisabled;
        EXPECT_EQ(served.drive.state(), expected) << "from " << from << ", wish " << static_cast<int>(wish);
      }
    }
  }
}

TEST(PowerStates, OfADriveThatRunsChangeInTheNextCycleOfAQuickStop) {
  Served served(PowerStates::OperationEnabled, 2);
  served.cycle(DriveWish::QuickStop, false);
  EXPECT_EQ(served.drive.state(), PowerStates::QuickStop);
}

TEST(PowerStates, AreNeverEnabledOutOfAFaultWithoutARisingResetBit) {
  std::mt19937 random(402);
  int enabled = 0;
  for (int run = 0; run < 5000; ++run) {
    Served served(kStates[random() % kStates.size()], random() % 3);
    bool faulted = served.drive.state() == PowerStates::Fault || served.drive.state() == PowerStates::FaultReaction;
    bool reset_rose = false;
    for (int i = 0; i < 60; ++i) {
      if (random() % 25 == 0) {
        served.drive.raise_fault(kOptions);
        faulted = true;
        reset_rose = false;
      }
      const std::uint16_t before = served.word;
      const bool reset = random() % 10 == 0;
      // Most of the time it is to run: else it would hardly ever get there.
      const bool runs = random() % 8 != 0;
      served.cycle(runs ? DriveWish::Operational : static_cast<DriveWish>(random() % 3), reset);
      const bool rises = (served.word & 0x80) != 0 && (before & 0x80) == 0;
      ASSERT_TRUE(reset || !rises) << "a reset that nobody asked for";
      ASSERT_FALSE((served.word & 0x80) != 0 && (served.word & 0x0F) == 0x0F) << "a reset that enables at once";
      reset_rose = reset_rose || rises;
      if (served.drive.state() == PowerStates::OperationEnabled) {
        ASSERT_TRUE(!faulted || reset_rose) << "run " << run << ", cycle " << i;
        ++enabled;
        faulted = false;
      }
    }
  }
  EXPECT_GT(enabled, 5000);
}

TEST(PowerStates, OfTheSimulatedDriveFollowEveryTransitionOfTheStandard) {
  // CiA 402-2, tables of commands and transitions: where each controlword leads from each state.
  constexpr std::uint16_t kShutdown = 0x06, kSwitchOn = 0x07, kEnable = 0x0F, kDisableVoltage = 0x00, kQuick = 0x02,
                          kDisableOperation = 0x07, kReset = 0x80;
  using S = PowerStates;
  struct Row {
    S::State from;
    std::uint16_t word;
    S::State to;
  };
  constexpr Row kRows[] = {
      {S::SwitchOnDisabled, kShutdown, S::ReadyToSwitchOn},         // 2
      {S::ReadyToSwitchOn, kSwitchOn, S::SwitchedOn},               // 3
      {S::SwitchedOn, kEnable, S::OperationEnabled},                // 4
      {S::OperationEnabled, kDisableOperation, S::SwitchedOn},      // 5
      {S::SwitchedOn, kShutdown, S::ReadyToSwitchOn},               // 6
      {S::ReadyToSwitchOn, kQuick, S::SwitchOnDisabled},            // 7
      {S::ReadyToSwitchOn, kDisableVoltage, S::SwitchOnDisabled},   // 7
      {S::OperationEnabled, kShutdown, S::ReadyToSwitchOn},         // 8
      {S::OperationEnabled, kDisableVoltage, S::SwitchOnDisabled},  // 9
      {S::SwitchedOn, kDisableVoltage, S::SwitchOnDisabled},        // 10
      {S::SwitchedOn, kQuick, S::SwitchOnDisabled},                 // 10
      {S::OperationEnabled, kQuick, S::QuickStop},                  // 11
      {S::QuickStop, kDisableVoltage, S::SwitchOnDisabled},         // 12
      {S::Fault, kReset, S::SwitchOnDisabled},                      // 15
      {S::QuickStop, kEnable, S::OperationEnabled},                 // 16
      {S::SwitchOnDisabled, kEnable, S::SwitchOnDisabled},
      {S::Fault, kShutdown, S::Fault},
      {S::Fault, kEnable, S::Fault},
      {S::QuickStop, kQuick, S::QuickStop},
  };
  for (const Row& row : kRows) {
    PowerStates drive = drive_in(row.from);
    drive.control(row.word, kOptions);
    EXPECT_EQ(drive.state(), row.to) << "from " << row.from << " by " << row.word;
  }
}

}  // namespace
