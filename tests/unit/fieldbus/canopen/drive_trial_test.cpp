#include "rmac/fieldbus/canopen/drive_trial.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "rmac/fieldbus/canopen/sdo.hpp"
#include "unit/fieldbus/canopen/canopen_bench.hpp"

// A first motion of one drive that follows its setpoints exactly, and tells what a test makes of it.
namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::milliseconds;
using test::CanopenBench;
using test::CanWire;
using test::VirtualDrive;
using testing::HasSubstr;

class ExactTrial : public CanopenBench {
 protected:
  Expected<DriveTrialResult> attempt(const DriveTrial& trial, const test::Texts& texts = {}) {
    auto config =
        read_canopen_config("can0", {{"node", {1}}, {"mode", {static_cast<double>(trial.mode)}}}, texts, 0.001);
    if (!config) return tl::unexpected(config.error());
    make_from(*config);
    if (auto started = master_->start(); !started) return tl::unexpected(started.error());
    return try_drive(*master_, *config, trial, [this] {
      if (pass_) pass_();
      wire_.pass(milliseconds(1));
    });
  }
  /// The drive tells of a position that it is at `most` at most.
  void stand_still_at(std::int32_t most) {
    wire_.gateway = [most](CanFrame& frame) {
      const auto position = static_cast<std::int32_t>(long_at(&frame.data[2]));
      if (frame.id == 0x181) put_long(&frame.data[2], static_cast<std::uint32_t>(std::min(position, most)));
      return std::vector<CanWire::Time>{{}};
    };
  }
  bool reaches(std::int32_t way, std::int32_t most, std::int64_t tolerance_counts) {
    stand_still_at(most);
    const auto done = attempt({.mode = DriveMode::CyclicSyncPosition,
                               .amount = way,
                               .seconds = 0.1,
                               .most_counts = 50000,
                               .tolerance_counts = tolerance_counts});
    if (!done) {
      EXPECT_THAT(done.error().message, HasSubstr("it stands " + std::to_string(way - most) + " off"));
    }
    drive_.put_at(0);
    return done.has_value();
  }

  VirtualDrive& drive_ = wire_.add(1);
  std::function<void()> pass_;
};

TEST_F(ExactTrial, TakesAHundredthOfTheWayForReachedAndTenCountsOfAShortOne) {
  EXPECT_TRUE(reaches(30000, 29700, 0));
  EXPECT_FALSE(reaches(30000, 29699, 0));
  EXPECT_TRUE(reaches(500, 490, 0)) << "of a short way it would be too little";
  EXPECT_FALSE(reaches(500, 489, 0));
}

TEST_F(ExactTrial, TakesTheToleranceThatIsGivenHoweverSmall) {
  EXPECT_TRUE(reaches(30000, 29999, 1));
  EXPECT_FALSE(reaches(30000, 29998, 1));
  EXPECT_TRUE(reaches(500, 400, 100));
  EXPECT_FALSE(reaches(500, 399, 100));
}

TEST_F(ExactTrial, GoesAsFarAsIsAllowedAndNotACountFarther) {
  const DriveTrial trial{.mode = DriveMode::CyclicSyncPosition, .amount = 1000, .seconds = 0.1, .most_counts = 1000};
  const auto done = attempt(trial);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->farthest_counts, 1000);
  EXPECT_EQ(done->to_counts - done->from_counts, 1000);
  int cycles = 0;
  pass_ = [&] { cycles += drive_.state() == test::PowerStates::OperationEnabled ? 1 : 0; };
  wire_.gateway = [&](CanFrame& frame) {
    if (frame.id == 0x181 && cycles > 50) put_long(&frame.data[2], static_cast<std::uint32_t>(done->to_counts + 1001));
    return std::vector<CanWire::Time>{{}};
  };
  const auto far = attempt(trial);
  ASSERT_FALSE(far);
  EXPECT_THAT(far.error().message, HasSubstr("the drive went 1001 counts from where it stood, and 1000 are allowed"));
}

TEST_F(ExactTrial, BeginsWhereTheDriveStands) {
  for (const double stands : {12345.0, -70000.0}) {
    drive_.put_at(stands);
    std::vector<std::int32_t> told;
    wire_.listen = [&](const CanFrame& frame) {
      if (frame.id == 0x201 && drive_.state() == test::PowerStates::OperationEnabled) {
        told.push_back(static_cast<std::int32_t>(long_at(&frame.data[2])));
      }
    };
    const auto done =
        attempt({.mode = DriveMode::CyclicSyncPosition, .amount = -500, .seconds = 0.1, .most_counts = 1000});
    wire_.listen = nullptr;
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->from_counts, stands);
    ASSERT_FALSE(told.empty());
    EXPECT_EQ(told.front(), stands) << "it is enabled where it is";
    EXPECT_EQ(*std::min_element(told.begin(), told.end()), stands - 500);
  }
}

// Red when the power goes while the drive still runs: its brake would have to hold what its motor could.
TEST_F(ExactTrial, EndsWithAQuickStopAndTakesThePowerAtRest) {
  for (const DriveMode mode : {DriveMode::CyclicSyncVelocity, DriveMode::CyclicSyncTorque}) {
    drive_.put_at(0);
    bool moved = false, stopped = false;
    wire_.listen = [&](const CanFrame& frame) {
      if (frame.id != 0x201 || !stopped) return;
      EXPECT_EQ(word_at(&frame.data[2]), 0) << "whatever the drive does next, it is not told to move";
    };
    pass_ = [&] {
      const auto state = drive_.state();
      moved = moved || std::abs(drive_.velocity()) > 10000;
      stopped = stopped || state == test::PowerStates::QuickStop;
      const bool power = state == test::PowerStates::OperationEnabled || state == test::PowerStates::QuickStop;
      if (moved && !power) {
        EXPECT_TRUE(stopped);
        EXPECT_EQ(drive_.velocity(), 0);
      }
    };
    const int amount = mode == DriveMode::CyclicSyncVelocity ? 400000 : 800;
    const auto done = attempt({.mode = mode, .amount = amount, .seconds = 0.2, .most_counts = 500000});
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_TRUE(moved && stopped);
    EXPECT_EQ(drive_.state(), test::PowerStates::SwitchOnDisabled);
    wire_.listen = nullptr;
    pass_ = nullptr;
  }
}

TEST_F(ExactTrial, GivesUpADriveThatIsNotEnabledInFiveSeconds) {
  wire_.gateway = [](CanFrame& frame) {
    if (frame.id == 0x181) put_word(frame.data.data(), 0x0250);  // switch on disabled, whatever it is told
    return std::vector<CanWire::Time>{{}};
  };
  int cycles = 0;
  pass_ = [&] { ++cycles; };
  const auto done = attempt({.mode = DriveMode::CyclicSyncPosition, .amount = 10, .seconds = 0.1, .most_counts = 100});
  ASSERT_FALSE(done);
  EXPECT_EQ(
      done.error().message,
      "the drive was not enabled within 5 s, it stays in switch on disabled; check its power and its enable chain");
  EXPECT_NEAR(cycles, 5000, 30);
}

TEST_F(ExactTrial, SaysThatADriveLeftItsPowerByItself) {
  int cycles = 0;
  pass_ = [&] { ++cycles; };
  wire_.gateway = [&](CanFrame& frame) {
    if (frame.id == 0x181 && cycles > 100) put_word(frame.data.data(), 0x0250);
    return std::vector<CanWire::Time>{{}};
  };
  const auto done = attempt({.mode = DriveMode::CyclicSyncPosition, .amount = 10, .seconds = 1, .most_counts = 100});
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, "the drive left Operation Enabled by itself and is in switch on disabled");
}

TEST_F(ExactTrial, SaysThatADriveFellSilentOrTripped) {
  int cycles = 0;
  pass_ = [&] {
    if (++cycles == 100) drive_.trip(0x8611);
  };
  const DriveTrial trial{.mode = DriveMode::CyclicSyncPosition, .amount = 10, .seconds = 1, .most_counts = 100};
  const auto tripped = attempt(trial);
  ASSERT_FALSE(tripped);
  EXPECT_EQ(tripped.error().message, "the drive reports error 8611h (following error)");
  wire_ = CanWire();
  VirtualDrive& other = wire_.add(1);
  cycles = 0;
  pass_ = [&] {
    if (++cycles == 100) other.answers_sync = false;
  };
  const auto silent = attempt(trial);
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().message, "the drive does not answer any more");
}

TEST_F(ExactTrial, IsOfOneDriveThatTellsItsPosition) {
  const DriveTrial trial{.mode = DriveMode::CyclicSyncPosition, .amount = 10, .most_counts = 100};
  const auto blind = attempt(trial, {{"tpdo", "6041:00/16 6077:00/16"}});
  ASSERT_FALSE(blind);
  EXPECT_THAT(blind.error().message, HasSubstr("the drive does not tell its position (tpdo lacks 6064h)"));
  wire_.add(2);
  make({{"node", {1, 2}}, {"mode", {8}}});
  ASSERT_EQ(start_error(), "it started");
  const auto config = read_canopen_config("can0", {{"node", {1, 2}}, {"mode", {8}}}, {}, 0.001);
  const auto two = try_drive(*master_, *config, trial, [] {});
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().message, "one drive is tried at a time");
  for (const DriveMode mode : {DriveMode::None, DriveMode::Homing}) {
    make({{"node", {1}}, {"mode", {8}}});
    const auto one = read_canopen_config("can0", {{"node", {1}}, {"mode", {8}}}, {}, 0.001);
    const auto refused = try_drive(*master_, *one, {.mode = mode, .amount = 1, .most_counts = 10}, [] {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "a trial is by a mode of position, velocity or torque");
  }
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
