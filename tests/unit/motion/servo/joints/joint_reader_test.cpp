#include "servo/joints/joint_reader.hpp"

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

/// Three joints, one motor each, 1 rad a mm; the last one has a force sensor.
class JointReading : public testing::Test {
 protected:
  JointReading() {
    parts_.actuator_map = map_;
    parts_.joints.resize(3);
    for (std::uint32_t i = 0; i < 3; ++i) parts_.actuators.push_back({bus_, i, {1000, 1, 1, 0}});
    parts_.joints[2].force_sensor = ServoForceSensor{bus_, 1, -0.5, 10};
  }
  void make() {
    wiring_.emplace(*map_, 3, parts_.actuators);
    transmission_.emplace(*map_, parts_.joints);
    reader_.emplace(parts_, *wiring_, *transmission_);
  }
  void read(double position, double velocity = 0, IndexSet live = 0b111, IndexSet steady = 0b111,
            double velocity_set = 0) {
    reader_->read(std::array{position, 2.0, 3.0}, std::array{velocity, 0.0, 0.0}, live, steady,
                  std::array{velocity_set, 0.0, 0.0});
  }
  std::shared_ptr<FakeBus> fake_ = std::make_shared<FakeBus>(3);
  std::shared_ptr<ServoBus> bus_ = std::make_shared<ServoBus>(fake_);
  std::shared_ptr<const ActuatorMap> map_ = std::make_shared<DirectMap>();
  ServoLoopParts parts_;
  std::optional<Wiring> wiring_;
  std::optional<Transmission> transmission_;
  std::optional<JointReader> reader_;
};

TEST_F(JointReading, TakesPositionsAndVelocitiesThroughTheMap) {
  make();
  read(5, 40);
  EXPECT_EQ(reader_->position()[0], 5);
  EXPECT_EQ(reader_->position()[2], 3);
  EXPECT_EQ(reader_->velocity()[0], 40);
  EXPECT_EQ(reader_->positions().size(), 3U);
}

TEST_F(JointReading, CorrectsBothByThePitchOfTheScrew) {
  parts_.joints[0].mechanics.pitch = {0, 10, {0, 0.5}};
  make();
  read(4, 40);
  EXPECT_NEAR(reader_->position()[0], 4.2, 1e-12);
  EXPECT_NEAR(reader_->velocity()[0], 42, 1e-9);
}

TEST_F(JointReading, CrossesTheBacklashOfALiveJointOnly) {
  parts_.joints[0].mechanics.backlash = 0.2;
  for (const IndexSet live : {0b110U, 0b111U}) {
    make();
    for (int i = 0; i < 20; ++i) read(4, 0, live, live, -5);
    EXPECT_NEAR(reader_->position()[0], live == 0b111U ? 4.1 : 4, 1e-9);
  }
}

TEST_F(JointReading, JumpIsTheChangeOfTheStep) {
  make();
  for (const double at : {1.0, 2.0, 4.5}) read(at);
  EXPECT_NEAR(reader_->jump(0), 1.5, 1e-12);
  EXPECT_EQ(reader_->jump(1), 0);
}

TEST_F(JointReading, JumpNeedsTwoPositionsOfASteadyJointBeforeIt) {
  make();
  for (const double at : {1.0, 2.0, 3.0}) read(at);
  read(90);
  EXPECT_NEAR(reader_->jump(0), 86, 1e-12) << "it is found in the cycle in which it shows";
  read(90, 0, 0b111, 0b110);
  EXPECT_EQ(reader_->jump(0), 0) << "of a joint whose drive does not answer nobody knows a step";
  EXPECT_FALSE(reader_->step(0));
  read(70);
  EXPECT_EQ(reader_->jump(0), 0);
  EXPECT_FALSE(reader_->step(0));
  read(95);
  EXPECT_EQ(reader_->jump(0), 0);
  EXPECT_EQ(reader_->step(0), 25);
  read(96);
  EXPECT_NEAR(reader_->jump(0), -24, 1e-12);
}

TEST_F(JointReading, AStopIsNoFasterThanItWasLately) {
  make();
  double at = 0;
  const auto go = [&](double step) { read(at += step); };
  for (int i = 0; i < 5; ++i) go(1);
  for (const double step : {0.0, -0.5, -0.7, 0.2}) {
    go(step);
    EXPECT_TRUE(reader_->may_stop(0)) << step;
  }
  go(-1.2);
  EXPECT_FALSE(reader_->may_stop(0)) << "it came with less";
  for (int i = 0; i < 100; ++i) go(0);
  go(0.1);
  EXPECT_FALSE(reader_->may_stop(0)) << "long ago";
}

TEST_F(JointReading, ALateCyclesStepIsNone) {
  make();
  for (const double at : {1.0, 2.0, 3.0}) read(at);
  reader_->forget_steps();
  read(5);
  EXPECT_EQ(reader_->jump(0), 0);
  EXPECT_FALSE(reader_->step(0));
  read(6);
  EXPECT_EQ(reader_->step(0), 1);
}

TEST_F(JointReading, ForceIsCountsFromZeroInTheSensorsSense) {
  make();
  bus_->feedback[1].sensor_counts = 30;
  read(0);
  EXPECT_EQ(reader_->force()[2], -10);
  EXPECT_EQ(reader_->force()[1], 0) << "it has no sensor, whatever stands beside its drive's words";
}

TEST_F(JointReading, TellsAMeasuredEffortWhereTheDriveTellsItsTorque) {
  fake_->torque_told = 0b001;
  make();
  bus_->feedback[0].torque_permille = 500;
  read(0);
  EXPECT_EQ(reader_->measured_effort(0), 0.5);
  EXPECT_EQ(reader_->measured_effort(1), std::nullopt);
}

TEST_F(JointReading, WithoutDrivesReflectsWhatIsWanted) {
  make();
  reader_->reflect(std::array{7.0, 8.0, 9.0}, std::array{1.0, 2.0, 3.0});
  EXPECT_EQ(reader_->position()[1], 8);
  EXPECT_EQ(reader_->velocity()[2], 3);
}

}  // namespace
}  // namespace rmac::servo_test
