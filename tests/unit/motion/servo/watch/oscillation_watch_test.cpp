#include "servo/watch/oscillation_watch.hpp"

#include <array>
#include <functional>
#include <numbers>
#include <random>
#include <utility>

#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using testing::IsEmpty;

constexpr double kCycle = 0.001;
constexpr double kTurn = 2 * std::numbers::pi;

/// A mass of 35 kg at joint 4, whose effort is told as the drives measure it; 800 N at most.
class SwingingJoint : public testing::Test {
 protected:
  SwingingJoint() { joint_.max_effort = 800; }

  /// Cycles until it is found, or -1 within `cycles`.
  int run(
      int cycles, const std::function<double(double t)>& effort, const std::function<double(double t)>& outside,
      const std::function<double(double t)>& wanted_acceleration = [](double) { return 0.0; }) {
    faults_.raised.clear();
    watch_.rest();
    velocity_ = 0;
    constexpr double kMass = 0.035;  // N·s²/mm
    for (int i = 0; i < cycles; ++i, t_ += kCycle) {
      const double acted = effort(t_);
      // Exact for a force that is held over the cycle.
      const double acceleration = (acted + outside(t_)) / kMass;
      position_ += velocity_ * kCycle + acceleration * kCycle * kCycle / 2;
      velocity_ += acceleration * kCycle;
      watch_.step({.effort = acted,
                   .effort_measured = true,
                   .answer_delay = 0,
                   .position = position_,
                   .acceleration_set = wanted_acceleration(t_)},
                  faults_);
      if (!faults_.raised.empty()) return i + 1;
    }
    return -1;
  }
  static double nothing(double /*t*/) { return 0; }

  ServoJoint joint_;
  OscillationWatch watch_{joint_, 4, kCycle};
  RecordedFaults faults_;
  double t_ = 0, position_ = 0, velocity_ = 0;
};

TEST_F(SwingingJoint, IsFoundWithin50MsOrThreePeriodsWhateverTheFrequency) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < 300; ++k) {
    const bool slow = k % 4 == 0;  // which has to grow
    const double hz = slow ? 12 + 25 * share(random) : 45 + 370 * share(random), from = share(random);
    const double grows = slow ? 3 : 3 * share(random);
    const double began = t_;
    // It drives its motion against a damper; amplitude from the threshold up.
    const auto effort = [&](double t) {
      return std::min(700.0, 150 * std::exp(grows * (t - began) * hz / 10)) *
             std::sin(kTurn * (hz * (t - began) + from));
    };
    const int found = run(1000, effort, [&](double) { return -10 * velocity_; });
    ASSERT_GT(found, 0) << hz << " Hz";
    // Half a period until the first turn, three periods of swings, and the cycles that tell the last.
    EXPECT_LE(found * kCycle, std::max(0.05, 4 / hz) + 0.01) << hz << " Hz, " << grows;
    EXPECT_NEAR(faults_.raised[0].value, hz, 0.15 * hz + 2);
  }
}

TEST_F(SwingingJoint, IsFoundBeforeItIsHalfAsLargeAgainHoweverSlowlyItGrows) {
  for (const double hz : {12.0, 20.0, 37.0}) {
    for (const double a_period : {0.02, 0.05}) {
      const double began = t_;
      const auto size = [&](double t) { return 150 * std::exp(a_period * hz * (t - began)); };
      const int found = run(
          5000, [&](double t) { return size(t) * std::sin(kTurn * hz * (t - began)); },
          [&](double) { return -10 * velocity_; });
      ASSERT_GT(found, 0) << hz << " Hz, " << a_period;
      EXPECT_LT(size(t_), 1.5 * 150) << hz << " Hz, " << a_period;
    }
  }
}

TEST_F(SwingingJoint, IsNoneWhileItsEffortTakesEnergyOutThatAForceFromOutsidePutsIn) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < 200; ++k) {
    const double hz = 12 + 200 * share(random), force = 300 * share(random), damping = 5 + 20 * share(random);
    const double began = t_;
    EXPECT_EQ(run(
                  500, [&](double) { return -damping * velocity_; },
                  [&](double t) { return force * std::sin(kTurn * hz * (t - began)); }),
              -1)
        << hz << " Hz, " << force << " N";
  }
}

TEST_F(SwingingJoint, IsNoneWhileThePathTurnsRoundAsOften) {
  for (const double hz : {5.0, 12.0, 20.0, 40.0}) {
    const auto wave = [hz](double t) { return std::sin(kTurn * hz * t); };
    EXPECT_EQ(run(
                  2000, [&](double t) { return 300 * wave(t) + 20; }, nothing,
                  [&](double t) { return 300 / 0.035 * wave(t); }),
              -1)
        << hz;
  }
}

TEST_F(SwingingJoint, IsNoneOnceItDecays) {
  for (const double ratio : {0.03, 0.1, 0.3}) {
    for (const double hz : {15.0, 60.0, 150.0}) {
      const double began = t_;
      EXPECT_EQ(run(
                    1000,
                    [&](double t) {
                      return 600 * std::exp(-ratio * kTurn * hz * (t - began)) * std::sin(kTurn * hz * (t - began));
                    },
                    nothing),
                -1)
          << ratio << ", " << hz << " Hz";
    }
  }
}

TEST_F(SwingingJoint, IsNoneByAStepAndARampAndNoise) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 20);
  EXPECT_EQ(run(
                500, [](double t) { return t < 0.1 ? 0.0 : 500.0; }, nothing),
            -1);
  EXPECT_EQ(run(
                500, [](double t) { return 500 - 1000 * (t - 0.5); }, nothing),
            -1);
  EXPECT_EQ(run(
                5000, [&](double) { return noise(random); }, nothing),
            -1);
}

/// A joint of a scale whose drive tells no torque, and lets it come by a current loop of 0.2 ms.
class LaggingDrive : public SwingingJoint {
 protected:
  /// As `run`, over 500 cycles; `command` from where it stood a cycle ago.
  int follow(const std::function<double(double t)>& command, const std::function<double(double t)>& outside) {
    constexpr double kMass = 0.035, kLagS = 0.0002;
    constexpr int kSteps = 20;
    faults_.raised.clear();
    watch_.rest();
    velocity_ = 0;
    shown_ = 0;
    places_ = {position_, position_};
    double torque = 0;
    for (int i = 0; i < 500; ++i, t_ += kCycle) {
      const double commanded = command(t_);
      for (int k = 0; k < kSteps; ++k) {
        torque += (commanded - torque) * (1 - std::exp(-kCycle / kSteps / kLagS));
        velocity_ += (torque + outside(t_ + k * kCycle / kSteps)) / kMass * kCycle / kSteps;
        position_ += velocity_ * kCycle / kSteps;
      }
      // The watch sees what was commanded a cycle ago, and where the joint was a cycle before that.
      watch_.step({.effort = std::exchange(shown_, commanded), .answer_delay = 1, .position = places_[1]}, faults_);
      places_ = {position_, places_[0]};
      if (!faults_.raised.empty()) return i + 1;
    }
    return -1;
  }
  double shown_ = 0;
  std::array<double, 2> places_{};
};

TEST_F(LaggingDrive, SwingsThoughNoTorqueIsTold) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < 200; ++k) {
    const double hz = 60 + 160 * share(random), from = share(random), began = t_;
    const double amplitude = 100 + 200 * share(random);
    const int found = follow([&](double t) { return amplitude * std::sin(kTurn * (hz * (t - began) + from)); },
                             [&](double) { return -10 * velocity_; });
    ASSERT_GT(found, 0) << hz << " Hz, " << amplitude << " N";
    EXPECT_LE(found, std::max(50.0, 4000 / hz) + 12) << hz << " Hz, " << amplitude << " N";
    EXPECT_EQ(faults_.raised[0].kind, ServoFault::Kind::Oscillation);
  }
}

// Gains that are changed begin it with efforts that brake.
TEST_F(SwingingJoint, IsFoundThoughABlowBeganIt) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < 100; ++k) {
    const double hz = 45 + 100 * share(random), blow = 500 + 1000 * share(random), began = t_;
    const int found = run(
        500,
        [&](double t) { return 200 * std::sin(kTurn * hz * (t - began)) - (t - began < 0.012 ? 12 * velocity_ : 0); },
        [&](double t) { return (t - began < 0.004 ? blow : 0) - 10 * velocity_; });
    ASSERT_GT(found, 0) << hz << " Hz, " << blow << " N";
    EXPECT_LE(found * kCycle, std::max(0.05, 4 / hz) + 0.012) << hz << " Hz, " << blow << " N";
  }
}

// A position that comes twice is a speed of nothing, and then of twice as much, to a loop.
TEST_F(SwingingJoint, IsNoneWhereAWordThatComesTwiceShakesItBehindAPush) {
  const auto effort = [](double t) {
    const int cycle = static_cast<int>(std::lround(1000 * t));
    constexpr std::array kShakes{700.0, -790.0, 600.0, -400.0, 250.0, -200.0, 100.0};
    const int shaken = cycle - 40;
    return 300 * std::sin(kTurn * std::min(t, 0.04) / 0.03) +
           (shaken >= 0 && shaken < 7 ? kShakes.at(static_cast<std::size_t>(shaken)) : 0);
  };
  t_ = 0;
  EXPECT_EQ(run(200, effort, nothing), -1);
}

TEST_F(SwingingJoint, WithoutABoundOfItsEffortIsNotWatched) {
  joint_.max_effort = 0;
  EXPECT_EQ(run(500, nothing, nothing), -1);
}

}  // namespace
}  // namespace rmac::servo_test
