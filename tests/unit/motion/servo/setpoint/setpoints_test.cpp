#include "servo/setpoint/setpoints.hpp"

#include <random>

#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Two kinematic joints and a held one.
class ChosenSetpoints : public testing::Test {
 protected:
  ChosenSetpoints() {
    parts_.kinematics = std::make_shared<PlaneKinematics>();
    parts_.joints.resize(3);
    for (ServoJoint& joint : parts_.joints) {
      joint.max_following_error = 10;
      joint.bounds.stop_deceleration = 1000;
      joint.bounds.stop_jerk = 20'000;
      joint.force = {.approach_speed = 10,
                     .contact_force = 5,
                     .gain = 0.05,
                     .reset_time_s = 0.5,
                     .max_speed = 20,
                     .max_force = 200,
                     .max_search = 100,
                     .max_acceleration = 1e5};
    }
    for (std::size_t j = 0; j < 3; ++j) {
      plan_.position[j] = 1 + static_cast<double>(j);
      plan_.velocity[j] = 10 + static_cast<double>(j);
      plan_.acceleration[j] = 100 + static_cast<double>(j);
    }
  }
  void make(const Wiring::Delays& delays = {}, IndexSet follow_themselves = 0b111) {
    setpoints_.emplace(parts_, delays, follow_themselves);
  }
  [[nodiscard]] Setpoints::Seen seen(bool follows, IndexSet live) const {
    return {.plan = plan_,
            .wanted_force = wanted_force_,
            .position = measured_,
            .velocity = measured_velocity_,
            .force = force_,
            .effort = effort_,
            .live = live,
            .follows = follows};
  }
  void step(bool follows, IndexSet live = 0b111) { setpoints_->step(seen(follows, live), faults_); }
  void brake() { setpoints_->brake(seen(false, 0b111)); }
  ServoLoopParts parts_;
  Setpoint plan_;
  std::array<double, 3> wanted_force_{}, measured_{-7, -8, -9}, measured_velocity_{}, force_{}, effort_{};
  RecordedFaults faults_;
  std::optional<Setpoints> setpoints_;
};

TEST_F(ChosenSetpoints, FollowThePlanWithTheKinematicJointsAndHoldTheOthers) {
  make();
  setpoints_->hold_at(2, 5);
  step(true);
  EXPECT_THAT(setpoints_->positions(), testing::ElementsAre(1, 2, 5));
  EXPECT_EQ(setpoints_->velocity()[1], 11);
  EXPECT_EQ(setpoints_->acceleration()[1], 101);
  EXPECT_EQ(setpoints_->velocity()[2], 0);
}

TEST_F(ChosenSetpoints, HoldWhereTheyWereWhenThePlanIsNotFollowed) {
  make();
  step(true);
  step(false);
  EXPECT_THAT(setpoints_->positions(), testing::ElementsAre(1, 2, 0));
  EXPECT_EQ(setpoints_->velocity()[0], 0);
  EXPECT_EQ(setpoints_->acceleration()[0], 0);
}

TEST_F(ChosenSetpoints, AreWhereTheJointIsWhileItIsNotUnderControl) {
  make();
  step(true);
  step(false, 0b110);
  EXPECT_THAT(setpoints_->positions(), testing::ElementsAre(-7, 2, 0));
}

TEST_F(ChosenSetpoints, StayInVirtualModeWhereNoJointIsEverUnderControl) {
  parts_.virtual_mode = true;
  parts_.virtual_start = {4, 5, 6};
  make();
  step(false, 0);
  EXPECT_THAT(setpoints_->positions(), testing::ElementsAre(4, 5, 6));
}

TEST_F(ChosenSetpoints, PlanWithoutANumberIsAFaultAndFollowedNoFurther) {
  make();
  plan_.acceleration[1] = kNaN;
  plan_.position[1] = 33;
  step(true);
  EXPECT_THAT(setpoints_->positions(), testing::ElementsAre(1, 0, 0));
  EXPECT_THAT(faults_.raised,
              testing::ElementsAre(is_fault(ServoFault::Kind::NotANumber, ServoFault::Part::Joint, 1, 33, 0)));
}

TEST_F(ChosenSetpoints, JointUnderForceControlGoesWhereItsForceSendsIt) {
  parts_.joints[1].method = ControlMethod::Force;
  make();
  wanted_force_[1] = -50;
  step(true);
  EXPECT_NEAR(setpoints_->velocity()[1], -10, 1e-12) << "it approaches";
  EXPECT_NEAR(setpoints_->position()[1], -10 * kPeriod, 1e-12);
  EXPECT_EQ(setpoints_->force_loop(1).state(), ContactState::Approaching);
  force_[1] = -49;
  step(true);
  EXPECT_EQ(setpoints_->force_loop(1).state(), ContactState::Touching);
  step(false);
  EXPECT_EQ(setpoints_->force_loop(1).state(), ContactState::Holding) << "no plan, no force";
}

TEST_F(ChosenSetpoints, JointThatIsPushedIsWantedWhereItIs) {
  parts_.joints[1].method = ControlMethod::Force;
  parts_.joints[1].max_effort = 100;
  make({}, 0);
  wanted_force_[1] = -50;
  force_[1] = -20;
  measured_velocity_[1] = -0.3;
  for (int i = 0; i < 40; ++i) step(true);
  EXPECT_TRUE(setpoints_->pushes(1));
  EXPECT_FALSE(setpoints_->pushes(0));
  EXPECT_EQ(setpoints_->position()[1], measured_[1]);
  EXPECT_EQ(setpoints_->velocity()[1], -0.3);
  const double pushed = setpoints_->force_loop(1).effort();
  EXPECT_LT(pushed, 0);
  effort_[1] = -100;
  step(true);
  EXPECT_EQ(setpoints_->force_loop(1).effort(), pushed) << "it is pushed as hard as it may be";
}

// Red when the way that a part gives way counts as that of a setpoint, which a joint whose drive answers late is held
// against.
TEST_F(ChosenSetpoints, JointThatIsPushedOrLetGoIsWantedWhereItIsHoweverLateItTells) {
  parts_.joints[1].method = ControlMethod::Force;
  parts_.joints[1].max_effort = 100;
  make({3, 3, 3}, 0);
  wanted_force_[1] = -50;
  force_[1] = -20;
  for (int i = 0; i < 40; ++i) {
    setpoints_->begin_cycle();
    measured_[1] -= 0.01;
    measured_[2] += 0.5;
    step(true, 0b011);
  }
  ASSERT_TRUE(setpoints_->pushes(1));
  for (const std::size_t joint : {1U, 2U}) {
    EXPECT_EQ(setpoints_->position()[joint], measured_[joint]);
    EXPECT_EQ(setpoints_->gone_on(joint), 0);
  }
}

TEST_F(ChosenSetpoints, JointThatIsPushedLetsGoOfItsPartAsItStops) {
  parts_.joints[1].method = ControlMethod::Force;
  for (ServoJoint& joint : parts_.joints) joint.force.max_acceleration = 1000;
  make({}, 0);
  wanted_force_[1] = -50;
  force_[1] = -20;
  for (int i = 0; i < 40; ++i) step(true);
  setpoints_->begin_braking();
  double away = 0;
  for (int i = 0; i < 500; ++i) {
    if (i == 100) force_[1] = 0;
    const double before = setpoints_->position()[1];
    brake();
    if (i > 0) away += setpoints_->position()[1] - before;
    ASSERT_TRUE(i >= 100 || !setpoints_->braked());
  }
  EXPECT_TRUE(setpoints_->braked());
  EXPECT_FALSE(setpoints_->pushes(1));
  EXPECT_NEAR(away, 10 * 0.15, 0.1) << "as long as it touched, and for a twentieth of a second more";
}

TEST_F(ChosenSetpoints, WantedForceWithoutANumberIsNone) {
  parts_.joints[1].method = ControlMethod::Force;
  make();
  wanted_force_[1] = kNaN;
  step(true);
  EXPECT_EQ(setpoints_->velocity()[1], 0);
}

TEST_F(ChosenSetpoints, JointUnderVelocityControlSlipsFromWhereItWasHeld) {
  parts_.joints[0].method = ControlMethod::Velocity;
  make();
  setpoints_->hold_at(0, -7.5);
  step(true);
  EXPECT_NEAR(setpoints_->slip(0), -8.5, 1e-12);
  EXPECT_NEAR(setpoints_->position()[0], -7.5, 1e-12);
  plan_.position[0] = 1.01;
  step(true);
  EXPECT_NEAR(setpoints_->position()[0], -7.49, 1e-12);
  parts_.joints[0].method = ControlMethod::Position;
  step(true);
  EXPECT_EQ(setpoints_->slip(0), 0);
  EXPECT_EQ(setpoints_->position()[0], 1.01);
}

TEST_F(ChosenSetpoints, SlipIsTakenAnewWhenThePlanIsFollowedAgain) {
  parts_.joints[0].method = ControlMethod::Velocity;
  make();
  measured_[0] = 0;
  setpoints_->hold_at(0, 0);
  step(true);
  step(false);
  plan_.position[0] = 6;
  step(true);
  EXPECT_NEAR(setpoints_->position()[0], 0, 1e-12);
  EXPECT_NEAR(setpoints_->slip(0), -6, 1e-12);
}

TEST_F(ChosenSetpoints, TellHowFarJointsThatAnswerLateWentInTheCycle) {
  make({1});
  setpoints_->hold_at(0, 0.9);
  step(true);
  EXPECT_NEAR(setpoints_->gone_on(0), 0.1, 1e-12);
  EXPECT_EQ(setpoints_->velocity_gone_on(0), 10);
  EXPECT_EQ(setpoints_->gone_on(1), 0);
  setpoints_->begin_cycle();
  EXPECT_EQ(setpoints_->gone_on(0), 0);
  EXPECT_EQ(setpoints_->velocity_gone_on(0), 0);
}

// Red when the way of a joint whose answers are older is that of one cycle, or of one cycle more or less.
TEST_F(ChosenSetpoints, TellHowFarTheyWentSinceAnswersThatAreOlder) {
  std::mt19937_64 random(5);
  for (const std::uint8_t delay : {std::uint8_t{2}, std::uint8_t{5}, std::uint8_t{kMostAnswerDelay}}) {
    make({delay});
    std::vector<double> positions(delay, plan_.position[0]), velocities(delay, plan_.velocity[0]);
    setpoints_->hold_at(0, plan_.position[0]);
    step(true);
    setpoints_->hold_at(0, plan_.position[0]);  // it begins anew
    velocities.assign(delay, 0);
    for (int cycle = 0; cycle < 100; ++cycle) {
      plan_.position[0] += std::uniform_real_distribution<>(-1, 1)(random);
      plan_.velocity[0] = std::uniform_real_distribution<>(-100, 100)(random);
      setpoints_->begin_cycle();
      step(true);
      positions.push_back(plan_.position[0]);
      velocities.push_back(plan_.velocity[0]);
      ASSERT_NEAR(setpoints_->gone_on(0), positions.back() - positions[positions.size() - 1 - delay], 1e-9) << cycle;
      ASSERT_NEAR(setpoints_->velocity_gone_on(0), velocities.back() - velocities[velocities.size() - 1 - delay], 1e-9);
    }
  }
}

TEST_F(ChosenSetpoints, BrakeFromThePlansStatesEachJointWithinItsLimits) {
  std::mt19937_64 random(3);
  const auto any = [&](double most) { return std::uniform_real_distribution<>(-most, most)(random); };
  for (int run = 0; run < 200; ++run) {
    for (ServoJoint& joint : parts_.joints) {
      joint.bounds.stop_deceleration = 500 + std::abs(any(1000));
      joint.bounds.stop_jerk = 5000 + std::abs(any(50'000));
    }
    for (std::size_t j = 0; j < 2; ++j) {
      plan_.velocity[j] = any(200);
      plan_.acceleration[j] = any(parts_.joints[j].bounds.stop_deceleration);
    }
    make({1});
    step(true);
    setpoints_->begin_braking();
    int cycles = 0;
    for (; !setpoints_->braked(); ++cycles) {
      ASSERT_LT(cycles, 2000);
      const auto position = setpoints_->position();
      const auto velocity = setpoints_->velocity(), acceleration = setpoints_->acceleration();
      setpoints_->begin_cycle();
      brake();
      for (std::size_t j = 0; j < 2; ++j) {
        const auto& bounds = parts_.joints[j].bounds;
        ASSERT_LE(std::abs(setpoints_->acceleration()[j]), bounds.stop_deceleration * 1.000001);
        ASSERT_LE(std::abs(setpoints_->acceleration()[j] - acceleration[j]), bounds.stop_jerk * kPeriod * 1.000001);
        ASSERT_LE(std::abs(setpoints_->velocity()[j] - velocity[j]), bounds.stop_deceleration * kPeriod * 1.000001);
        ASSERT_NEAR(setpoints_->position()[j] - position[j], (setpoints_->velocity()[j] + velocity[j]) / 2 * kPeriod,
                    bounds.stop_jerk * kPeriod * kPeriod * kPeriod);
      }
      EXPECT_EQ(setpoints_->gone_on(0), setpoints_->position()[0] - position[0]);
    }
    for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(setpoints_->velocity()[j], 0);
  }
}

TEST_F(ChosenSetpoints, StandAtOnceWhereNothingBoundsTheirStop) {
  for (ServoJoint& joint : parts_.joints) joint.bounds.stop_jerk = 0;
  make();
  step(true);
  setpoints_->begin_braking();
  EXPECT_TRUE(setpoints_->braked());
  brake();
  EXPECT_EQ(setpoints_->velocity()[0], 0);
  EXPECT_EQ(setpoints_->position()[0], 1);
}

TEST_F(ChosenSetpoints, JointThatIsGivenUpHasNoPartInBraking) {
  make();
  step(true);
  setpoints_->give_up(1);
  setpoints_->begin_braking();
  brake();
  EXPECT_EQ(setpoints_->velocity()[1], 0);
  EXPECT_EQ(setpoints_->position()[1], 2);
  EXPECT_GT(setpoints_->velocity()[0], 0);
}

TEST_F(ChosenSetpoints, ForceIsLetGoWithAllJoints) {
  parts_.joints[1].method = ControlMethod::Force;
  make();
  wanted_force_[1] = -50;
  step(true);
  setpoints_->let_go();
  EXPECT_EQ(setpoints_->force_loop(1).state(), ContactState::Holding);
  EXPECT_EQ(setpoints_->force_loop(1).searched(), 0);
}

}  // namespace
}  // namespace rmac::servo_test
