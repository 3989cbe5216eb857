#include "servo/probe/probe.hpp"

#include <gtest/gtest.h>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

constexpr std::uint64_t kTouch = 0x10, kReady = 0x20;

class Contact : public testing::Test {
 protected:
  const ProbeReport& read(std::uint64_t inputs, double on_for_s = 0, bool latched = false) {
    signal_.read(probe_, inputs, on_for_s, latched, kPeriod);
    return signal_.report();
  }
  ServoProbe probe_{kTouch, kReady, 0.003};
  ProbeSignal signal_;
};

TEST_F(Contact, IsReadyWhileItHasPowerAsFarAsItTells) {
  EXPECT_FALSE(read(0).ready);
  EXPECT_TRUE(read(kReady).ready);
  probe_.ready_input = 0;
  EXPECT_TRUE(read(0).ready);
  probe_.touch_input = 0;
  EXPECT_FALSE(read(0).ready) << "there is none";
}

TEST_F(Contact, BouncesAreOneHit) {
  EXPECT_EQ(read(kTouch).hits, 1U);
  for (const bool closed : {false, true, false, false, true}) {
    EXPECT_TRUE(read(closed ? kTouch : 0).touching);
  }
  EXPECT_EQ(signal_.report().hits, 1U);
  EXPECT_TRUE(read(0).touching);
  EXPECT_TRUE(read(0).touching);
  EXPECT_FALSE(read(0).touching) << "open for its settling time";
  EXPECT_EQ(read(kTouch).hits, 2U);
}

TEST_F(Contact, TellsHowLongBeforeTheCycleItClosedAndNoLongerThanTwoCycles) {
  EXPECT_EQ(read(kTouch, 0.0004).hit_before_s, 0.0004);
  EXPECT_EQ(read(kTouch, 0.0014).hit_before_s, 0) << "this cycle counts none";
  for (int i = 0; i < 5; ++i) read(0);
  EXPECT_EQ(read(kTouch, 0.5).hit_before_s, 0.002);
}

TEST_F(Contact, HitThatOnlyADriveSawCountsWithoutATime) {
  EXPECT_EQ(read(0, 0.0004, true).hits, 1U);
  EXPECT_TRUE(signal_.report().touching);
  EXPECT_EQ(signal_.report().hit_before_s, 0);
  EXPECT_EQ(read(kTouch, 0.0001).hits, 1U) << "it is the same one";
}

class Latch : public testing::Test {
 protected:
  bool read(bool stored, bool touching, std::int32_t counts = 0, bool online = true) {
    DriveFeedback words{.online = online};
    if (stored) words.touch_probe = touch_probe::latched(TouchProbeEdge::SecondFalling);
    words.latched_counts = {-1, -2, -3, counts};
    return latch_.read(words, touching);
  }
  ProbeLatch latch_{TouchProbeEdge::SecondFalling};
};

TEST_F(Latch, IsArmedUntilItHasLatchedAndTakesThePositionACycleAfter) {
  EXPECT_EQ(latch_.function(), 0);
  EXPECT_FALSE(read(false, false));
  EXPECT_TRUE(latch_.armed());
  EXPECT_EQ(latch_.function(), touch_probe::latch_once(TouchProbeEdge::SecondFalling));
  EXPECT_TRUE(read(true, false, 5));
  EXPECT_FALSE(latch_.latched());
  EXPECT_FALSE(read(true, true, 77));
  EXPECT_TRUE(latch_.latched());
  EXPECT_EQ(latch_.counts(), 77);
  EXPECT_FALSE(read(true, true, 99));
  EXPECT_EQ(latch_.counts(), 77);
}

TEST_F(Latch, IsArmedAnewOnceTheProbeAndTheDriveHaveLetGo) {
  (void)read(false, false);
  (void)read(true, false, 5);
  (void)read(true, true, 5);
  (void)read(true, false, 5);
  EXPECT_FALSE(latch_.armed());
  EXPECT_FALSE(latch_.latched());
  (void)read(true, false, 5);
  EXPECT_FALSE(latch_.armed()) << "the drive still tells of the last one";
  (void)read(false, false);
  EXPECT_TRUE(latch_.armed());
}

TEST_F(Latch, DriveThatIsAwayIsNotArmed) {
  (void)read(false, false);
  (void)read(false, false, 0, false);
  EXPECT_FALSE(latch_.armed());
}

/// A joint with two motors of which both drives latch, and one with a drive that does not.
class LatchedProbe : public testing::Test {
 protected:
  LatchedProbe() {
    parts_.actuator_map = std::make_shared<GantryMap>();
    parts_.joints.resize(2);
    parts_.probe = {kTouch, 0, 0.003};
    for (std::uint32_t i = 0; i < 3; ++i) parts_.actuators.push_back({bus_, i, {2 * std::numbers::pi * 1000, 1, 1, 0}});
    parts_.actuators[0].probe_edge = parts_.actuators[2].probe_edge = TouchProbeEdge::FirstRising;
  }
  /// Both drives of joint 0 stand at 4 mm, and have latched at 3.9 mm.
  void cycle(bool second_has_latched) {
    for (DriveFeedback& words : bus_->feedback) words.online = true;
    bus_->feedback[0].position_counts = 8000;
    bus_->feedback[2].position_counts = -8000;
    bus_->feedback[0].touch_probe = touch_probe::latched(TouchProbeEdge::FirstRising);
    if (second_has_latched) bus_->feedback[2].touch_probe = touch_probe::latched(TouchProbeEdge::FirstRising);
    bus_->feedback[0].latched_counts[0] = 7800;
    bus_->feedback[2].latched_counts[0] = -7800;
    shafts_->read();
    probe_->read(kTouch);
  }
  ProbeReport report() { return probe_->report(*shafts_, *transmission_); }
  void make() {
    wiring_.emplace(*parts_.actuator_map, 2, parts_.actuators);
    transmission_.emplace(*parts_.actuator_map, parts_.joints);
    shafts_.emplace(parts_.actuators, kPeriod);
    probe_.emplace(parts_, *wiring_);
    for (DriveFeedback& words : bus_->feedback) words.online = true;
    shafts_->read();
    probe_->read(0);
  }
  std::shared_ptr<ServoBus> bus_ = std::make_shared<ServoBus>(std::make_shared<FakeBus>(3));
  ServoLoopParts parts_;
  std::optional<Wiring> wiring_;
  std::optional<Transmission> transmission_;
  std::optional<Shafts> shafts_;
  std::optional<Probe> probe_;
};

TEST_F(LatchedProbe, TellsWhichJointsLatch) {
  make();
  EXPECT_EQ(report().latching, 0b01U);
  EXPECT_EQ(report().latched, 0U);
  EXPECT_EQ(probe_->function(0), touch_probe::latch_once(TouchProbeEdge::FirstRising));
  EXPECT_EQ(probe_->function(1), 0);
}

TEST_F(LatchedProbe, JointIsLatchedWhereAllOfItsDrivesAre) {
  make();
  for (int i = 0; i < 3; ++i) cycle(false);
  EXPECT_EQ(report().latched, 0U);
  for (int i = 0; i < 3; ++i) cycle(true);
  EXPECT_EQ(report().latched, 0b01U);
  EXPECT_NEAR(report().latched_position[0], 3.9, 1e-9);
  EXPECT_EQ(report().hits, 1U);
}

TEST_F(LatchedProbe, WithoutDrivesThatLatchOnlyTheContactTells) {
  for (ServoActuator& actuator : parts_.actuators) actuator.probe_edge.reset();
  make();
  cycle(true);
  EXPECT_EQ(report().latching, 0U);
  EXPECT_EQ(report().hits, 1U);
}

}  // namespace
}  // namespace rmac::servo_test
