#include "servo/watch/joint_watch.hpp"

#include <cmath>
#include <numbers>

#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using Kind = ServoFault::Kind;
using testing::ElementsAre, testing::IsEmpty;

/// Joint 4: 1 mm, 100 mm/s, 0.1 mm, -20 to 30 mm; 200 N and 5 mm of search under force control.
class WatchedJoint : public testing::Test {
 protected:
  ServoJoint joint_ = [] {
    ServoJoint made;
    made.max_following_error = 1;
    made.bounds = {.velocity = 100, .jump = 0.1, .min_position = -20, .max_position = 30};
    made.force.max_force = 200;
    made.force.max_search = 5;
    return made;
  }();
  JointWatch watch_{joint_, 4, 0.001};
  RecordedFaults faults_;
  static auto fault(Kind kind, double value, double bound) {
    return is_fault(kind, ServoFault::Part::Joint, 4, value, bound);
  }
};

TEST_F(WatchedJoint, IsFineWithinAllBounds) {
  for (int i = 0; i < 10; ++i) {
    watch_.step({.position = {.jump = -0.1},
                 .velocity = -100,
                 .following_error = 1,
                 .position_set = 90,
                 .velocity_set = 1,
                 .force = 900},
                faults_);
  }
  EXPECT_THAT(faults_.raised, IsEmpty()) << "ends and forces are watched under force control";
}

TEST_F(WatchedJoint, JumpsInOneCycle) {
  watch_.step({.position = {.jump = -0.11}}, faults_);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::EncoderJump, -0.11, 0.1)));
}

// Its effort turns round at each corner: that is no swing, in which more may be.
TEST_F(WatchedJoint, JumpsOnAZigzagToo) {
  joint_.max_effort = 800;
  for (int i = 0; i < 400; ++i) {
    const double to_and_fro = i / 20 % 2 == 0 ? 1 : -1;
    watch_.step({.loop = {.effort = 300 * to_and_fro, .effort_measured = true, .acceleration_set = 3000 * to_and_fro}},
                faults_);
  }
  EXPECT_THAT(faults_.raised, IsEmpty());
  watch_.step({.position = {.jump = 0.15}}, faults_);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::EncoderJump, 0.15, 0.1)));
}

// It goes at 200 mm/s and stops within some cycles: what it met is told, and not that it is behind.
TEST_F(WatchedJoint, IsBlockedWhereItStaysBehindAtSpeed) {
  joint_.max_effort = 800;
  joint_.bounds.velocity = 0;
  double set = 0, position = 0;
  for (int i = 0; i < 60 && faults_.raised.empty(); ++i) {
    set += 0.2;
    position += i < 30 ? 0.2 : 0.01;
    watch_.step(
        {.following_error = set - position, .loop = {.effort = 300, .effort_measured = true, .position = position}},
        faults_);
  }
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::StandsStill);
}

// Its effort grows by little before it is behind, as with soft gains.
TEST_F(WatchedJoint, GoesTheWrongWayWhereItRunsAwayFromItsSetpointAgainstALittleEffort) {
  joint_.max_effort = 8000;
  joint_.bounds.velocity = 0;
  double position = 0.001;
  for (int i = 0; i < 200 && faults_.raised.empty(); ++i) {
    position *= 1.1;
    watch_.step({.following_error = -position,
                 .loop = {.effort = -300 * position, .effort_measured = true, .position = position}},
                faults_);
  }
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::WrongDirection);
}

/// Its loop swings at 100 Hz by 300 N of 2000, for 29 ms.
class WatchedSwing : public WatchedJoint {
 protected:
  WatchedSwing() {
    joint_.max_effort = 2000;
    for (int i = 0; i < 29; ++i) swing(i, 0);
    EXPECT_THAT(faults_.raised, IsEmpty()) << "it is too early to tell";
  }
  void swing(int i, double jump, bool refused = false, double velocity = 0) {
    const double wave = std::sin(2 * std::numbers::pi * i / 10);
    watch_.step({.position = {.jump = jump, .refused = refused},
                 .velocity = velocity,
                 .loop = {.effort = 300 * wave, .effort_measured = true, .position = 0.02 * wave}},
                faults_);
  }
};

TEST_F(WatchedSwing, IsWhyItsPositionJumpsByALittle) {
  for (const int i : {29, 30, 31}) swing(i, 0);
  swing(32, 0.15);
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::Oscillation);
  EXPECT_TRUE(watch_.doubts_position()) << "it is not known all the same";
}

TEST_F(WatchedSwing, IsNotWhyItsPositionJumpsFar) {
  for (const int i : {29, 30, 31}) swing(i, 0);
  swing(32, 0.25);
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::EncoderJump);
}

TEST_F(WatchedSwing, IsWhyItBecomesTooFast) {
  for (int i = 29; i < 32; ++i) swing(i, 0, false, 101);
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_EQ(faults_.raised[0].kind, Kind::Oscillation);
}

TEST_F(WatchedJoint, WithoutABoundMayJumpAndRun) {
  joint_.bounds.jump = joint_.bounds.velocity = 0;
  for (int i = 0; i < 5; ++i) watch_.step({.position = {.jump = 50}, .velocity = 1e6}, faults_);
  EXPECT_THAT(faults_.raised, IsEmpty());
}

TEST_F(WatchedJoint, IsBehindInOneCycleEitherWayAndWithoutANumber) {
  watch_.step({.following_error = -1.01}, faults_);
  watch_.step({.following_error = 1.01}, faults_);
  watch_.step({.following_error = std::nan("")}, faults_);
  ASSERT_EQ(faults_.raised.size(), 3U);
  EXPECT_THAT(faults_.raised[0], fault(Kind::FollowingError, -1.01, 1));
  EXPECT_THAT(faults_.raised[1], fault(Kind::FollowingError, 1.01, 1));
  EXPECT_EQ(faults_.raised[2].kind, Kind::FollowingError);
}

TEST_F(WatchedJoint, IsTooFastAfterThreeCyclesOnEnd) {
  watch_.step({.velocity = -101}, faults_);
  watch_.step({.velocity = -101}, faults_);
  watch_.step({.velocity = -99}, faults_);
  watch_.step({.velocity = -101}, faults_);
  watch_.step({.velocity = -101}, faults_);
  EXPECT_THAT(faults_.raised, IsEmpty());
  watch_.step({.velocity = -101}, faults_);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::VelocityBound, -101, 100)));
}

TEST_F(WatchedJoint, CyclesBeyondDoNotOutlastItsControl) {
  watch_.step({.velocity = 101}, faults_);
  watch_.step({.velocity = 101}, faults_);
  watch_.rest();
  watch_.step({.velocity = 101}, faults_);
  EXPECT_THAT(faults_.raised, IsEmpty());
}

TEST_F(WatchedJoint, NeedsAValueOfItsForceSensor) {
  const auto bus = std::make_shared<ServoBus>(std::make_shared<FakeBus>(2));
  joint_.force_sensor = ServoForceSensor{bus, 1, 1, 0};
  for (const auto& [online, valid] : {std::pair{true, true}, {true, false}, {false, true}}) {
    faults_.raised.clear();
    bus->feedback[1].online = online;
    bus->feedback[1].sensor_valid = valid;
    watch_.step({}, faults_);
    if (online && valid) {
      EXPECT_THAT(faults_.raised, IsEmpty());
    } else {
      EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::SensorLost, 0, 0)));
    }
  }
}

TEST_F(WatchedJoint, UnderForceControlHasALargestForce) {
  joint_.method = ControlMethod::Force;
  watch_.step({.force = -200}, faults_);
  EXPECT_THAT(faults_.raised, IsEmpty());
  watch_.step({.force = -201}, faults_);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::ForceLimit, -201, 200)));
}

TEST_F(WatchedJoint, HasItsLargestForceUnderPositionControlTooWhereItHasASensor) {
  watch_.step({.force = -201}, faults_);
  EXPECT_THAT(faults_.raised, IsEmpty()) << "nobody measures it";
  const auto bus = std::make_shared<ServoBus>(std::make_shared<FakeBus>(2));
  bus->feedback[1].online = bus->feedback[1].sensor_valid = true;
  joint_.force_sensor = ServoForceSensor{bus, 1, 1, 0};
  watch_.step({.force = -200}, faults_);
  EXPECT_THAT(faults_.raised, IsEmpty());
  watch_.step({.force = -201}, faults_);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::ForceLimit, -201, 200)));
  joint_.force.max_force = 0;
  faults_.raised.clear();
  watch_.step({.force = -1000}, faults_);
  EXPECT_THAT(faults_.raised, IsEmpty()) << "none is declared";
}

TEST_F(WatchedJoint, UnderForceControlHasASensorThatHangs) {
  joint_.method = ControlMethod::Force;
  watch_.step({.force = -20, .force_hangs = true}, faults_);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::SensorLost, -20, 0)));
}

TEST_F(WatchedJoint, UnderForceControlSearchesNoFurtherThanItMay) {
  joint_.method = ControlMethod::Force;
  watch_.step({.contact = ContactState::Approaching, .searched = 5}, faults_);
  watch_.step({.contact = ContactState::Touching, .searched = 6}, faults_);
  EXPECT_THAT(faults_.raised, IsEmpty());
  watch_.step({.contact = ContactState::Approaching, .searched = 6}, faults_);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::ContactLost, 6, 5)));
}

TEST_F(WatchedJoint, UnderForceControlGoesNoFurtherBeyondItsTravel) {
  joint_.method = ControlMethod::Force;
  watch_.step({.position_set = 31, .velocity_set = -1}, faults_);
  watch_.step({.position_set = -21, .velocity_set = 1}, faults_);
  watch_.step({.position_set = 29, .velocity_set = 1}, faults_);
  EXPECT_THAT(faults_.raised, IsEmpty());
  watch_.step({.position_set = 31, .velocity_set = 1}, faults_);
  watch_.step({.position_set = -21, .velocity_set = -1}, faults_);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::ContactLost, 0, 5), fault(Kind::ContactLost, 0, 5)));
}

TEST_F(WatchedJoint, TellsAJumpBeforeTheFollowingErrorThatItMakes) {
  watch_.step({.position = {.jump = 5}, .following_error = -5}, faults_);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::EncoderJump, 5, 0.1), fault(Kind::FollowingError, -5, 1)));
}

}  // namespace
}  // namespace rmac::servo_test
