#include "rmac/fieldbus/canopen/drive_trial.hpp"

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "unit/gateway/simulators/vdrive/wire.hpp"

// The master's modes, one by one, against drives that know nothing of it.
namespace rmac::vdrive::test {
namespace {

using fieldbus::CanPort;
using fieldbus::canopen::CanopenConfig;
using fieldbus::canopen::CanopenInterface;
using fieldbus::canopen::DriveTrial;
using fieldbus::canopen::DriveTrialResult;
using std::chrono::milliseconds;

class DriveTrials : public testing::Test {
 protected:
  Expected<DriveTrialResult> attempt(const DriveTrial& trial, const std::string& setup = "") {
    std::map<std::string, std::string> texts{{"eds", "rmac-vdrive"}, {"tpdo", "6041:00/16 6064:00/32"}};
    if (!setup.empty()) texts["setup"] = setup;
    auto config = fieldbus::canopen::read_canopen_config(
        "can0", {{"node", {1}}, {"mode", {static_cast<double>(trial.mode)}}}, texts, 0.005,
        [](const std::string&, const std::string&) -> Expected<fieldbus::eds::DeviceDescription> { return sheet(); });
    if (!config) return tl::unexpected(config.error());
    CanopenInterface master(*config, [this](std::span<const std::uint16_t>, std::size_t) {
      return Expected<std::unique_ptr<CanPort>>(wire_.open());
    });
    if (auto started = master.start(); !started) return tl::unexpected(started.error());
    return try_drive(master, *config, trial, [this] {
      wire_.pass(milliseconds(5));
      if (watch_) watch_();
    });
  }

  Wire wire_;
  Node& node_ = wire_.add(1);
  std::function<void()> watch_;  ///< after each cycle
};

TEST_F(DriveTrials, GoByEachModeOfPositionAsFarAsTheyAreTold) {
  for (const DriveMode mode :
       {DriveMode::ProfilePosition, DriveMode::InterpolatedPosition, DriveMode::CyclicSyncPosition}) {
    for (const int way : {30000, -45000}) {
      SCOPED_TRACE(static_cast<int>(mode));
      const auto done =
          attempt({.mode = mode, .amount = way, .seconds = 0.5, .most_counts = 50000}, "6081:00/32=200000");
      ASSERT_TRUE(done) << done.error().message;
      EXPECT_NEAR(done->to_counts - done->from_counts, way, 300);
      EXPECT_EQ(node_.axis().state(), PowerStates::SwitchOnDisabled) << "it is left without power";
      EXPECT_EQ(node_.axis().velocity(), 0);
    }
  }
}

TEST_F(DriveTrials, RunByEachModeOfVelocityAndTorqueForTheirTime) {
  for (const auto& [mode, amount] :
       {std::pair{DriveMode::ProfileVelocity, 100000}, std::pair{DriveMode::CyclicSyncVelocity, 100000},
        std::pair{DriveMode::ProfileTorque, 80}, std::pair{DriveMode::CyclicSyncTorque, 80}}) {
    SCOPED_TRACE(static_cast<int>(mode));
    const auto done =
        attempt({.mode = mode, .amount = amount, .seconds = 0.2, .most_counts = 500000}, "6087:00/32=2000");
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_GT(done->to_counts - done->from_counts, 2000);
    EXPECT_NEAR(done->seconds, 0.2, 0.01);
    EXPECT_EQ(node_.axis().state(), PowerStates::SwitchOnDisabled);
  }
}

TEST_F(DriveTrials, StopADriveThatGoesTooFar) {
  const auto done = attempt({.mode = DriveMode::CyclicSyncTorque, .amount = 500, .seconds = 3, .most_counts = 20000});
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("and 20000 are allowed; it was stopped"), std::string::npos)
      << done.error().message;
  EXPECT_EQ(node_.axis().state(), PowerStates::SwitchOnDisabled);
  EXPECT_LT(node_.axis().position(), 200000);
}

TEST_F(DriveTrials, FailWhereTheDriveEndsElsewhereWhateverItSays) {
  for (const DriveMode mode :
       {DriveMode::ProfilePosition, DriveMode::InterpolatedPosition, DriveMode::CyclicSyncPosition}) {
    SCOPED_TRACE(static_cast<int>(mode));
    const auto limited = attempt({.mode = mode, .amount = 30000, .seconds = 0.5, .most_counts = 50000},
                                 "6081:00/32=200000 607D:01/32=-20000 607D:02/32=20000");
    ASSERT_FALSE(limited) << "went to " << limited->to_counts;
    EXPECT_LE(node_.axis().position(), 21000);
    const auto back = attempt({.mode = mode, .amount = -15000, .seconds = 0.5, .most_counts = 50000},
                              "6081:00/32=200000 607D:01/32=-20000 607D:02/32=20000");
    EXPECT_TRUE(back) << back.error().message;
    node_.dictionary().set({0x607D, 1}, 0);
    node_.dictionary().set({0x607D, 2}, 0);
  }
}

TEST_F(DriveTrials, TakeAPlaceForReachedThatIsWithinWhatIsAsked) {
  const auto done = attempt({.mode = DriveMode::CyclicSyncPosition,
                             .amount = 30000,
                             .seconds = 0.5,
                             .most_counts = 50000,
                             .tolerance_counts = 15000},
                            "6081:00/32=200000 607D:01/32=-20000 607D:02/32=20000");
  EXPECT_TRUE(done) << done.error().message;
}

// Red when the way is a straight line, begins or ends with a jolt, or goes elsewhere.
TEST_F(DriveTrials, FollowAPathThatBeginsAndEndsAtRest) {
  std::vector<double> targets;
  watch_ = [&] { targets.push_back(static_cast<std::int32_t>(node_.dictionary().number(0x607A))); };
  const double seconds = 0.5, way = 40000, period_s = 0.005;
  const auto done =
      attempt({.mode = DriveMode::CyclicSyncPosition, .amount = 40000, .seconds = 0.5, .most_counts = 50000});
  ASSERT_TRUE(done) << done.error().message;
  // Of the polynomial of fifth degree whose velocity and acceleration are zero at both ends.
  const double most_step = 1.875 * way / seconds * period_s;
  const double most_bend = 5.7736 * way / (seconds * seconds) * period_s * period_s;
  double farthest_step = 0;
  for (std::size_t i = 2; i < targets.size(); ++i) {
    const double step = targets[i] - targets[i - 1], before = targets[i - 1] - targets[i - 2];
    EXPECT_GE(step, -0.5) << i;
    EXPECT_LE(step, most_step + 1) << i;
    EXPECT_LE(std::abs(step - before), most_bend + 2) << i;
    farthest_step = std::max(farthest_step, step);
  }
  EXPECT_NEAR(farthest_step, most_step, most_step / 100);
  EXPECT_EQ(targets.back(), way);
}

// Red when the power goes while the drive still runs.
TEST_F(DriveTrials, TakeThePowerOnlyAtRest) {
  for (const DriveMode mode : {DriveMode::CyclicSyncVelocity, DriveMode::CyclicSyncTorque}) {
    double fastest = 0;
    std::optional<double> without_power;
    watch_ = [&] {
      const PowerStates::State state = node_.axis().state();
      const bool power = state == PowerStates::OperationEnabled || state == PowerStates::QuickStop;
      if (power) {
        fastest = std::max(fastest, std::abs(node_.axis().velocity()));
        without_power.reset();
      } else if (fastest > 0 && !without_power) {
        without_power = std::abs(node_.axis().velocity());
      }
    };
    const int amount = mode == DriveMode::CyclicSyncVelocity ? 100000 : 80;
    const auto done = attempt({.mode = mode, .amount = amount, .seconds = 0.2, .most_counts = 500000});
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_GT(fastest, 10000);
    ASSERT_TRUE(without_power.has_value());
    EXPECT_LT(*without_power, 1000);
    watch_ = nullptr;
  }
}

TEST_F(DriveTrials, TellWhereTheyWentAndHowFarAtMost) {
  const auto done =
      attempt({.mode = DriveMode::CyclicSyncPosition, .amount = -30000, .seconds = 0.5, .most_counts = 30100});
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->from_counts, 0);
  EXPECT_NEAR(done->to_counts, -30000, 20);
  EXPECT_GE(done->farthest_counts, -done->to_counts);
  EXPECT_LE(done->farthest_counts, 30100);
  EXPECT_NEAR(done->seconds, 0.7, 0.006) << "the way, and a fifth of a second to settle";
}

TEST_F(DriveTrials, AreRefusedWhereTheyCouldGoNowhereOrTooFar) {
  const auto said = [&](const DriveTrial& trial) {
    const auto done = attempt(trial);
    return done ? "done" : done.error().message;
  };
  EXPECT_EQ(said({.mode = DriveMode::CyclicSyncTorque, .amount = 32768, .most_counts = 1}),
            "a torque is 32767 per mille at most");
  EXPECT_EQ(said({.mode = DriveMode::CyclicSyncTorque, .amount = -32768, .most_counts = 1}),
            "a torque is 32767 per mille at most");
  EXPECT_EQ(said({.mode = DriveMode::ProfileTorque, .amount = 32768, .most_counts = 1}),
            "a torque is 32767 per mille at most");
  EXPECT_NE(said({.mode = DriveMode::CyclicSyncTorque, .amount = 32767, .most_counts = 1}),
            "a torque is 32767 per mille at most");
  EXPECT_EQ(said({.mode = DriveMode::ProfileVelocity, .amount = 40000, .seconds = 0.05, .most_counts = 100000}), "done")
      << "that is no torque";
  const std::string nowhere = "a trial needs a time and a way above 0";
  EXPECT_EQ(said({.mode = DriveMode::CyclicSyncPosition, .amount = 1, .seconds = 0, .most_counts = 10}), nowhere);
  EXPECT_EQ(said({.mode = DriveMode::CyclicSyncPosition, .amount = 1, .seconds = -1, .most_counts = 10}), nowhere);
  EXPECT_EQ(said({.mode = DriveMode::CyclicSyncPosition, .amount = 0, .seconds = 1, .most_counts = 0}), nowhere);
  EXPECT_EQ(said({.mode = DriveMode::CyclicSyncPosition, .amount = -201, .most_counts = 200}),
            "a way of -201 counts is more than the 200 that are allowed");
  EXPECT_EQ(said({.mode = DriveMode::CyclicSyncPosition, .amount = 1, .seconds = 0.02, .most_counts = 1000}), "done");
}

TEST_F(DriveTrials, SayWhatTheDriveDidInstead) {
  node_.axis().set_overheated(true);
  const auto hot = attempt({.mode = DriveMode::ProfilePosition, .amount = 100, .most_counts = 200});
  ASSERT_FALSE(hot);
  EXPECT_NE(hot.error().message.find("4310h"), std::string::npos) << hot.error().message;
}

TEST_F(DriveTrials, AreNotBegunWhereTheyCouldNotEnd) {
  const auto far = attempt({.mode = DriveMode::ProfilePosition, .amount = 300, .most_counts = 200});
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().message, "a way of 300 counts is more than the 200 that are allowed");
  const auto slow =
      attempt({.mode = DriveMode::ProfilePosition, .amount = 500000, .seconds = 0.1, .most_counts = 1000000},
              "6081:00/32=1000");
  ASSERT_FALSE(slow);
  EXPECT_NE(slow.error().message.find("did not say in 5.1 s that it is through"), std::string::npos)
      << slow.error().message;
}

TEST_F(DriveTrials, RefuseADriveThatCannotDoTheMode) {
  node_.dictionary().set(0x6502, 0x3A5);  // neither profile torque nor interpolated position
  const auto refused = attempt({.mode = DriveMode::InterpolatedPosition, .amount = 100, .most_counts = 200});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "node 1 (axis 0) cannot do interpolated position (mode 7): 6502h:00 says that it does the modes 1, 3, 6, "
            "8, 9, 10");
}

}  // namespace
}  // namespace rmac::vdrive::test
