#include "servo/setpoint/force_loop.hpp"

#include <cmath>
#include <random>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

constexpr double kSurface = -1;  // mm

ForceControl control() {
  ForceControl made;
  made.approach_speed = 5;
  made.contact_force = 10;
  made.gain = 0.02;
  made.reset_time_s = 0.2;
  made.max_speed = 20;
  made.max_force = 500;
  made.max_search = 4;
  made.max_acceleration = 1000;
  return made;
}

/// Joint 1 under force control, above a spring, with a drive that follows positions itself: exactly.
class ForceControlled : public ServoLoopTest {
 protected:
  void start(const ForceControl& force = control(), double stiffness_n_mm = 500, const JointBounds& bounds = {}) {
    stiffness_ = stiffness_n_mm;
    ServoLoopParts made = parts();
    made.actuators[1].mode = DriveMode::CyclicSyncPosition;
    made.joints[1].law = nullptr;
    made.joints[1].method = ControlMethod::Force;
    made.joints[1].force = force;
    made.joints[1].bounds = bounds;
    made.joints[1].force_sensor = ServoForceSensor{bus, 4, 0.001, 0};
    fake->drives[4].words.sensor_valid = true;
    build(std::move(made));
    engage();
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      const double at = report.position_set[1];
      put_at(1, at);
      push_ = std::min(0.0, stiffness_ * (at - surface_));
      fake->drives[4].words.sensor_counts = static_cast<std::int32_t>(std::lround(push_ * 1000));
      // What the plan says of this joint is nobody's business.
      command.setpoint.position[1] = 30;
      command.setpoint.velocity[1] = 7;
      cycle();
      largest_step_ = std::max(largest_step_, std::abs(report.velocity_set[1] - velocity_));
      velocity_ = report.velocity_set[1];
    }
  }
  double surface_ = kSurface;
  double stiffness_ = 0;
  double push_ = 0;
  double velocity_ = 0;
  double largest_step_ = 0;
};

TEST_F(ForceControlled, HoldsItsPositionWhileNoForceIsWanted) {
  start();
  run(200);
  EXPECT_EQ(report.contact[1], ContactState::Holding);
  EXPECT_EQ(report.contact[0], ContactState::None);
  EXPECT_NEAR(report.position_set[1], 0, 1e-9);
}

TEST_F(ForceControlled, ApproachesAtItsBoundedSpeedAndSettlesOnTheWantedForce) {
  start();
  command.force[1] = -100;
  run(100);
  EXPECT_EQ(report.contact[1], ContactState::Approaching);
  EXPECT_DOUBLE_EQ(report.velocity_set[1], -5);
  run(1500);
  EXPECT_EQ(report.contact[1], ContactState::Touching);
  EXPECT_NEAR(report.force[1], -100, 0.5);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::None);
  EXPECT_LE(largest_step_, 1000 * kPeriod * 1.0001) << "mm/s from cycle to cycle: the acceleration is bounded";
}

TEST_F(ForceControlled, LetsGoOfTheForceWithoutAJump) {
  start();
  command.force[1] = -100;
  run(1500);
  const double before = report.position_set[1];
  command.force[1] = 0;
  run(500);
  EXPECT_EQ(report.contact[1], ContactState::Holding);
  EXPECT_NEAR(report.position_set[1], before, 0.01);
  EXPECT_LE(largest_step_, 1000 * kPeriod * 1.0001);
}

TEST_F(ForceControlled, FindsContactAgainWhenItIsLost) {
  start();
  command.force[1] = -100;
  run(1500);
  surface_ -= 2;
  run(2);
  EXPECT_EQ(report.contact[1], ContactState::Approaching);
  run(1500);
  EXPECT_EQ(report.contact[1], ContactState::Touching);
  EXPECT_NEAR(report.force[1], -100, 0.5);
}

TEST_F(ForceControlled, StopsAfterTheWayItMaySearch) {
  start();
  surface_ = -100;
  command.force[1] = -100;
  run(2000);
  EXPECT_EQ(report.state, ServoState::Faulted);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::ContactLost);
  EXPECT_EQ(report.fault.stop, StopCategory::StopKeepPower);
  EXPECT_NEAR(report.position_set[1], -4, 0.1);
}

TEST_F(ForceControlled, StopsAtTheEndOfItsTravel) {
  start(control(), 500, {.min_position = -0.5});
  command.force[1] = -100;
  run(2000);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::ContactLost);
  EXPECT_NEAR(report.position_set[1], -0.5, 0.05);
}

TEST_F(ForceControlled, StopsBeyondItsLargestForce) {
  start();
  command.force[1] = -100;
  run(1500);
  surface_ += 1;  // something gets under the tool
  run(1);
  EXPECT_EQ(report.state, ServoState::Faulted);
  EXPECT_EQ(report.fault.kind, ServoFault::Kind::ForceLimit);
  EXPECT_EQ(report.fault.bound, 500);
}

// Settles within 2 % whatever the stiffness, up to the one that its gain is made for.
TEST_F(ForceControlled, SettlesOverSeededStiffnesses) {
  std::mt19937 random(7);
  for (int i = 0; i < 50; ++i) {
    const double stiffness = std::uniform_real_distribution(400.0, 2000.0)(random);
    const double wanted = -std::uniform_real_distribution(30.0, 300.0)(random);
    surface_ = kSurface;
    fake = std::make_shared<FakeBus>(5);
    bus = std::make_shared<ServoBus>(fake);
    command = {};
    report = {};
    start(control(), stiffness);
    command.force[1] = wanted;
    double largest = 0;
    for (int cycles = 0; cycles < 4000; ++cycles) {
      run(1);
      largest = std::max(largest, -report.force[1]);
      if (cycles <= 2500) continue;
      ASSERT_NEAR(report.force[1], wanted, 0.02 * -wanted) << stiffness << " N/mm";
    }
    EXPECT_LT(largest, -wanted * 1.5) << stiffness << " N/mm, " << wanted << " N";
  }
}

// Nothing must press ever more because its sensor says the same for ever.
TEST(PushedJoint, IsToldToHaveASensorThatHangsBeforeItPressesMuchMore) {
  ForceLoop loop(control(), kPeriod, 1);
  ForceLoop::Seen seen{.wanted = -60, .measured = -20};
  int cycles = 0;
  while (!loop.sensor_hangs() && cycles < 5000) {
    loop.step(seen);
    ++cycles;
  }
  EXPECT_TRUE(loop.sensor_hangs());
  EXPECT_TRUE(loop.pushes());
  EXPECT_NEAR(loop.effort(), -125, 5) << "a quarter of the largest force";
  EXPECT_LT(cycles, 500);
  seen.measured = -20.001;
  loop.step(seen);
  EXPECT_FALSE(loop.sensor_hangs()) << "a digit that changes is an answer";
}

TEST(PushedJoint, IsPushedNoMoreTheOldWayOnceItIsToPull) {
  ForceLoop loop(control(), kPeriod, 1);
  for (int i = 0; i < 100; ++i) loop.step({.wanted = -60, .measured = -20 - 0.001 * i});
  EXPECT_TRUE(loop.pushes());
  loop.step({.wanted = 60, .measured = -20});
  EXPECT_FALSE(loop.pushes());
  loop.step({.wanted = 60, .measured = -20});
  EXPECT_GT(loop.velocity(), 0) << "away from what it touched";
}

// Nothing brakes what moves before the force is seen: v √(k m).
TEST(ForceControlParts, AreRefusedWhereTheApproachWouldPressTooHard) {
  ForceControl fast = control();
  fast.approach_speed = 50;
  EXPECT_TRUE(check_force_control(fast, "joint Z")) << "nobody knows what it weighs";
  fast.mass = 0.0268;
  auto refused = check_force_control(fast, "joint Z");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "servo loop: joint Z approaches at 50, and would press its part with 1830 at a stiffness of 50000, beyond "
            "its largest force of 500; let it approach at 13.7 or slower, or say what stiffness its parts have");
  fast.approach_speed = 13.6;
  EXPECT_TRUE(check_force_control(fast, "joint Z"));
  fast.approach_speed = 50;
  fast.stiffness = 3700;
  EXPECT_TRUE(check_force_control(fast, "joint Z"));
}

// Without a gain it settles on what no gain was made for.
TEST_F(ForceControlled, FindsItsGainOverSeededStiffnesses) {
  std::mt19937 random(11);
  for (int i = 0; i < 30; ++i) {
    const double stiffness = std::exp(std::uniform_real_distribution(std::log(100.0), std::log(50'000.0))(random));
    const double wanted = -std::uniform_real_distribution(30.0, 300.0)(random);
    surface_ = kSurface;
    fake = std::make_shared<FakeBus>(5);
    bus = std::make_shared<ServoBus>(fake);
    command = {};
    report = {};
    ForceControl without = control();
    without.gain = without.reset_time_s = 0;
    without.approach_speed = 0.5;
    start(without, stiffness);
    command.force[1] = wanted;
    run(4500);
    for (int cycles = 0; cycles < 1000; ++cycles) {
      run(1);
      ASSERT_NEAR(report.force[1], wanted, 0.02 * -wanted) << stiffness << " N/mm";
    }
  }
}

TEST(ForceControlParts, AreRefusedWithoutASensorOrNumbers) {
  auto simulated = std::make_shared<FakeBus>(5);
  const auto bus = std::make_shared<ServoBus>(simulated);
  ServoLoopParts made;
  made.kinematics = std::make_shared<PlaneKinematics>();
  made.actuator_map = std::make_shared<DirectMap>();
  for (std::uint32_t j = 0; j < 3; ++j) {
    made.joints.push_back({std::make_shared<RecordingLaw>(), ControlMethod::Position, 1, 5});
    made.actuators.push_back({bus, j, {1000, 1, 1, 0}});
  }
  made.joints[1].method = ControlMethod::Force;
  made.joints[1].force = control();
  auto without_sensor = ServoLoop::create(made);
  ASSERT_FALSE(without_sensor);
  EXPECT_EQ(without_sensor.error().message, "servo loop: joint 1 is under force control and has no force sensor");
  made.joints[1].force_sensor = ServoForceSensor{bus, 4, 0.001, 0};
  made.joints[1].force.approach_speed = 0;
  auto without_speed = ServoLoop::create(made);
  ASSERT_FALSE(without_speed);
  EXPECT_EQ(without_speed.error().message,
            "servo loop: joint 1 is under force control, which needs an approach speed above 0");
}

}  // namespace
}  // namespace rmac::servo_test
