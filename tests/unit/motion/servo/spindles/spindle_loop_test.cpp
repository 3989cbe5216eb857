// Spindles: what words their drives get, by a law of their own or without one, and what stops the machine.
#include <gmock/gmock.h>

#include <random>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using testing::HasSubstr;

constexpr std::size_t kAxis = 3;
constexpr double kCountsPerTurn = 131072;
constexpr double kRatedSpindleNm = 2;
constexpr double kAcceleration = 20000;  // rpm/s, so 20 rpm a cycle

class ServoSpindles : public ServoLoopTest {
 protected:
  ServoLoopParts with(DriveMode mode, ControlMethod method = ControlMethod::Velocity) {
    ServoLoopParts made = parts();
    ServoSpindle& spindle = made.spindles[0];
    spindle.mode = mode;
    spindle.method = method;
    if (mode == DriveMode::CyclicSyncTorque) spindle.law = law;
    spindle.scale = {kCountsPerTurn, kRatedSpindleNm, 1, 0};
    spindle.max_acceleration_rpm_s = kAcceleration;
    spindle.max_following_error_deg = 90;
    spindle.max_torque_nm = 4;
    spindle.speed_tolerance_rpm = 10;
    spindle.speed_timeout_s = 1;
    return made;
  }
  /// A cycle in which the spindle turned at `rpm`.
  void turn(double rpm, int cycles = 1) {
    for (int i = 0; i < cycles; ++i) {
      turned_ += rpm / 60 * 0.001 * kCountsPerTurn;
      const auto wide = static_cast<std::uint64_t>(std::llround(turned_));
      words().position_counts = static_cast<std::int32_t>(static_cast<std::uint32_t>(wide));
      words().velocity_rpm = static_cast<std::int32_t>(std::lround(rpm));
      cycle();
    }
  }
  /// The drive turns as it is told, while the drive measures `torque_nm`.
  void obey(double torque_nm, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      words().torque_permille = static_cast<std::int16_t>(std::lround(torque_nm / kRatedSpindleNm * 1000));
      turn(bus->commands[kAxis].target_velocity_rpm);
    }
  }
  DriveFeedback& words() { return fake->drives[kAxis].words; }
  [[nodiscard]] double torque_nm() const {
    return bus->commands[kAxis].target_torque_permille * kRatedSpindleNm / 1000;
  }
  std::string refusal_of(ServoLoopParts made) {
    const auto built = ServoLoop::create(std::move(made));
    return built ? std::string() : built.error().message;
  }

  std::shared_ptr<RecordingLaw> law = std::make_shared<RecordingLaw>();
  double turned_ = 0;
};

TEST_F(ServoSpindles, DriveThatTakesATorqueGetsWhatTheLawMakesOfSpeeds) {
  build(with(DriveMode::CyclicSyncTorque));
  engage();
  EXPECT_EQ(bus->commands[kAxis].mode, DriveMode::CyclicSyncTorque);
  EXPECT_EQ(torque_nm(), 0);
  law->gain = 0.01;
  command.spindle_rpm[0] = 100;
  turn(30, 10);
  EXPECT_EQ(law->limit, 4);
  EXPECT_EQ(law->last.position_setpoint, 100);
  EXPECT_NEAR(law->last.position, 30, 1) << "a count a cycle is half a rpm";
  EXPECT_NEAR(torque_nm(), 0.01 * (100 - law->last.position), 1e-3);
  EXPECT_EQ(report.spindle_rpm[0], law->last.position);
}

TEST_F(ServoSpindles, SpeedWantedNeverChangesFasterThanItMayAndArrives) {
  for (const DriveMode mode : {DriveMode::CyclicSyncTorque, DriveMode::CyclicSyncVelocity}) {
    build(with(mode));
    report = {};
    command = {};
    words() = {.statusword = 0x40, .online = true};
    engage();
    std::mt19937 random(20261122);
    double before = 0;
    const auto set = [&] {
      return mode == DriveMode::CyclicSyncTorque ? law->last.position_setpoint
                                                 : bus->commands[kAxis].target_velocity_rpm;
    };
    for (int i = 0; i < 50; ++i) {
      command.spindle_rpm[0] = std::uniform_real_distribution<>(-1000, 1000)(random);
      for (int k = 0; k < 105; ++k) {
        turn(before);
        ASSERT_LE(std::abs(set() - before), kAcceleration * 0.001 + 1e-9) << "command " << i << " cycle " << k;
        before = set();
      }
      ASSERT_EQ(set(), command.spindle_rpm[0]);
    }
  }
}

TEST_F(ServoSpindles, IsTakenOverWhileItTurnsWithoutAStepOfTorque) {
  build(with(DriveMode::CyclicSyncTorque));
  engage();
  law->gain = 0.01;
  law->bias = 0.5;  // what a cut takes
  command.spindle_rpm[0] = 600;
  turn(600, 200);
  const double before = torque_nm();
  ASSERT_NEAR(before, 0.5, 0.02);
  auto old = std::move(loop);
  law = std::make_shared<RecordingLaw>();
  law->gain = 0.02;
  build(with(DriveMode::CyclicSyncTorque));
  loop->engage(old->handover());
  for (int i = 0; i < 20; ++i) {
    turn(600);
    ASSERT_NEAR(torque_nm(), 0.5, 0.03) << "cycle " << i;
  }
  EXPECT_EQ(law->engaged, 1);
}

TEST_F(ServoSpindles, EncoderThatWrapsIsNoJump) {
  build(with(DriveMode::CyclicSyncTorque));
  turned_ = 2147483647.0 - 500;
  turn(0, 3);
  engage();
  turn(900, 30);
  EXPECT_NEAR(report.spindle_rpm[0], 900, 1);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
}

TEST_F(ServoSpindles, UnderPositionControlTheAngleTurnsWithTheSpeedAndStandsWithIt) {
  build(with(DriveMode::CyclicSyncTorque, ControlMethod::Position));
  engage();
  law->gain = 0.01;
  command.spindle_rpm[0] = 10;
  turn(0, 1 + 500);
  EXPECT_NEAR(law->last.position_setpoint - law->last.position, 10 * 6 * 0.5, 0.5) << "half a second at 60 degrees/s";
  turn(0, 1100);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::FollowingError) << "more than 90 degrees";
  EXPECT_EQ(report.fault.part, ServoFault::Part::Spindle);
}

TEST_F(ServoSpindles, OverloadStopsTheMachineAtSpeedAndAfterATenthOfASecond) {
  build(with(DriveMode::ProfileVelocity));
  engage();
  command.spindle_rpm[0] = 500;
  words().torque_permille = 2000;  // 4 N·m
  turn(100, 400);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None) << "it gains speed";
  obey(4, 99);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
  obey(3.9, 1);
  obey(4, 98);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None) << "a tenth of a second on end";
  obey(4, 3);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::TorqueBound);
  EXPECT_EQ(report.fault.part, ServoFault::Part::Spindle);
  EXPECT_NEAR(report.fault.value, 4, 1e-9);
  EXPECT_EQ(report.fault.bound, 4);
  EXPECT_EQ(report.fault.stop, StopCategory::StopKeepPower);
  EXPECT_EQ(bus->commands[kAxis].target_velocity_rpm, 0) << "and the spindle";
  EXPECT_NE(bus->commands[0].controlword & controlword::kEnableOperation, 0);
}

TEST_F(ServoSpindles, ToolThatBearsLessIsWatchedAndTheCategoryIsConfigured) {
  ServoLoopParts made = with(DriveMode::ProfileVelocity);
  made.stop_categories.spindle_overload = StopCategory::StopThenRemovePower;
  build(std::move(made));
  engage();
  command.spindle_rpm[0] = 500;
  obey(0, 5);
  obey(1.5, 300);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
  command.tool_torque_nm = 1.2;
  obey(1.5, 101);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::TorqueBound);
  EXPECT_EQ(report.fault.bound, 1.2);
  EXPECT_EQ(report.fault.stop, StopCategory::StopThenRemovePower);
  cycle();
  expect_all_quick_stopped();
}

TEST_F(ServoSpindles, SpindleThatNeverArrivesIsWatchedAfterItsTime) {
  build(with(DriveMode::ProfileVelocity));
  engage();
  command.spindle_rpm[0] = 500;
  words().torque_permille = 2000;
  turn(20, 990);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
  turn(20, 120);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::TorqueBound);
}

TEST_F(ServoSpindles, SpindleThatRunsAwayOrWhoseLawGivesNoNumberStopsTheMachine) {
  build(with(DriveMode::CyclicSyncTorque));
  engage();
  turn(1190, 10);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None) << "a fifth more than 1000 rpm is allowed for";
  turn(1300, 10);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::VelocityBound);

  command = {};
  report = {};
  turned_ = 0;
  for (auto& drive : fake->drives) drive = {};
  build(with(DriveMode::CyclicSyncTorque));
  engage();
  law->answer_nan = true;
  cycle();
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::NotANumber);
  EXPECT_EQ(report.fault.part, ServoFault::Part::Spindle);
  cycle();
  expect_all_quick_stopped();
}

TEST_F(ServoSpindles, PowerIsKeptUntilAnEncoderSaysThatItStands) {
  build(with(DriveMode::CyclicSyncTorque));
  engage();
  command.spindle_rpm[0] = 500;
  turn(500, 50);
  words().statusword = 0x08;  // it tripped
  turn(500, 100);
  ASSERT_EQ(report.state, ServoState::Faulted);
  words().statusword = 0x07;
  fake->drives[kAxis].stuck = true;
  turn(500, 100);
  EXPECT_NE(bus->commands[kAxis].controlword & controlword::kEnableVoltage, 0) << "it still turns";
  turn(0, 40);
  EXPECT_EQ(bus->commands[kAxis].controlword & controlword::kEnableVoltage, 0);
}

TEST_F(ServoSpindles, WhatADriveCannotDoIsRefusedWithTheReason) {
  const auto changed = [&](DriveMode mode, void (*change)(ServoSpindle&)) {
    ServoLoopParts made = with(mode);
    change(made.spindles[0]);
    return refusal_of(std::move(made));
  };
  constexpr auto kTorque = DriveMode::CyclicSyncTorque, kSpeed = DriveMode::ProfileVelocity;
  EXPECT_EQ(changed(kTorque, [](ServoSpindle&) {}), "");
  EXPECT_EQ(changed(kSpeed, [](ServoSpindle&) {}), "");
  EXPECT_THAT(changed(DriveMode::CyclicSyncPosition, [](ServoSpindle&) {}),
              HasSubstr("spindle 0: its drive is in mode 8"));
  EXPECT_THAT(changed(kTorque, [](ServoSpindle& s) { s.law = nullptr; }), HasSubstr("no servo law to make it"));
  EXPECT_THAT(changed(kSpeed, [](ServoSpindle& s) { s.law = std::make_shared<RecordingLaw>(); }),
              HasSubstr("closes its speed loop itself (mode 3)"));
  EXPECT_THAT(changed(kSpeed, [](ServoSpindle& s) { s.method = ControlMethod::Position; }),
              HasSubstr("cannot be held to an angle"));
  EXPECT_THAT(changed(kTorque, [](ServoSpindle& s) { s.method = ControlMethod::Force; }), HasSubstr("for a force"));
  EXPECT_THAT(changed(kTorque, [](ServoSpindle& s) { s.max_torque_nm = 0; }), HasSubstr("MaxTorque"));
  EXPECT_THAT(changed(DriveMode::CyclicSyncVelocity, [](ServoSpindle& s) { s.max_acceleration_rpm_s = 0; }),
              HasSubstr("MaxAcceleration"));
  EXPECT_THAT(changed(kTorque,
                      [](ServoSpindle& s) {
                        s.method = ControlMethod::Position;
                        s.max_following_error_deg = 0;
                      }),
              HasSubstr("MaxFollowingError"));
}

}  // namespace
}  // namespace rmac::servo_test
