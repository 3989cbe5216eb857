#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "rmac/fieldbus/simulated_interface.hpp"
#include "rmac/motion/drive_power.hpp"

namespace {

using namespace rmac;
using namespace rmac::fieldbus;

/// DMACXYZ's X with what docs/simulated-bus.md assumes of it.
AxisPlantParameters honest() {
  AxisPlantParameters axis;
  axis.stiffness_nm_rad = 15.83;
  axis.load_inertia_kg_m2 = 1.267e-5;
  axis.presliding_rad = 0.0126;
  axis.cogging = 0.02;
  return axis;
}

class HonestAxis : public testing::Test {
 protected:
  explicit HonestAxis(const AxisPlantParameters& axis = honest()) : bus_({axis}, 0.001) {}
  void cycle(DriveWish wish, std::int16_t torque_permille = 0, double rpm = 0) {
    command_.controlword = next_controlword(feedback_.statusword, wish, false, command_.controlword);
    command_.mode = bus_.mode(0);
    command_.target_torque_permille = torque_permille;
    command_.target_velocity_rpm = rpm;
    ASSERT_TRUE(bus_.exchange({&command_, 1}, {&feedback_, 1}));
  }
  void enable() {
    for (int i = 0; i < 10; ++i) cycle(DriveWish::Operational);
    ASSERT_EQ(drive_state(feedback_.statusword), DriveState::OperationEnabled);
  }
  [[nodiscard]] double counts(double rad) const { return rad * 131072 / (2 * std::numbers::pi); }

  SimulatedInterface bus_;
  DriveCommand command_;
  DriveFeedback feedback_;
};

/// A head that hangs on its motor, as DMACXYZ's.
class HonestAxisThatHangs : public HonestAxis {
 protected:
  static AxisPlantParameters hanging(double play_rad = 0) {
    AxisPlantParameters axis = honest();
    axis.gravity_nm = 0.0937;
    axis.play_rad = play_rad;
    return axis;
  }
  explicit HonestAxisThatHangs(const AxisPlantParameters& axis = hanging()) : HonestAxis(axis) {}
  /// Where the load is beside the motor, once it stands.
  [[nodiscard]] double load_beside_motor_rad() {
    for (int i = 0; i < 1000; ++i) cycle(DriveWish::Off);
    return bus_.plant(0).load_rad() - bus_.plant(0).angle_rad();
  }
};

class HonestAxisThatHangsWithPlay : public HonestAxisThatHangs {
 protected:
  HonestAxisThatHangsWithPlay() : HonestAxisThatHangs(hanging(kPlay)) {}
  static constexpr double kPlay = 0.02;
};

class HonestAxisSeenAtTheLoad : public HonestAxis {
 protected:
  static AxisPlantParameters at_load() {
    AxisPlantParameters axis = honest();
    axis.encoder.at_load = true;
    return axis;
  }
  HonestAxisSeenAtTheLoad() : HonestAxis(at_load()) {}
};

class HonestAxisOnVelocity : public HonestAxis {
 protected:
  static AxisPlantParameters velocity() {
    AxisPlantParameters axis = honest();
    axis.mode = DriveMode::CyclicSyncVelocity;
    return axis;
  }
  HonestAxisOnVelocity() : HonestAxis(velocity()) {}
};

TEST_F(HonestAxis, TellsTheMotorsPlaceAndTheLoadsApart) {
  enable();
  bus_.push(0, -0.2);  // at the load
  for (int i = 0; i < 30; ++i) cycle(DriveWish::Operational, 600);
  const double motor = counts(bus_.plant(0).angle_rad()), load = counts(bus_.plant(0).load_rad());
  cycle(DriveWish::Operational, 600);
  EXPECT_NEAR(feedback_.position_counts, motor, 1);
  EXPECT_NEAR(feedback_.load_counts, load, 1);
  EXPECT_GT(motor - load, 100) << "some 0.19 N·m wind the spring up by 0.7 degrees";
}

TEST_F(HonestAxis, TellsTheTruthOfTheLoadWhateverItsEncoderSays) {
  enable();
  for (int i = 0; i < 30; ++i) cycle(DriveWish::Operational, 300);
  bus_.freeze_encoder(0, true);
  cycle(DriveWish::Operational, 300);
  const std::int32_t told = feedback_.position_counts, load = feedback_.load_counts;
  bus_.shift_encoder(0, 5000);
  for (int i = 0; i < 30; ++i) cycle(DriveWish::Operational, 300);
  EXPECT_EQ(feedback_.position_counts, told);
  EXPECT_GT(feedback_.load_counts, load + 1000);
  const double before = counts(bus_.plant(0).load_rad());
  cycle(DriveWish::Operational, 300);
  EXPECT_NEAR(feedback_.load_counts, before, 1);
}

// Red when the truth stays where it was while a drive that nobody hears comes to rest.
TEST_F(HonestAxis, TellsTheTruthOfTheLoadWhileItsDriveIsAway) {
  enable();
  for (int i = 0; i < 30; ++i) cycle(DriveWish::Operational, 300);
  bus_.set_online(0, false);
  const double far = counts(bus_.plant(0).load_rad());
  for (int i = 0; i < 50; ++i) {
    const double before = counts(bus_.plant(0).load_rad());
    cycle(DriveWish::Operational, 300);
    EXPECT_NEAR(feedback_.load_counts, before, 1);
  }
  EXPECT_FALSE(feedback_.online);
  EXPECT_GT(feedback_.load_counts, far + 100) << "it runs on a little";
}

TEST_F(HonestAxis, TellsTheTruthFromTheFirstAnswerOnHoweverLate) {
  bus_.plant(0).put_at(30);
  bus_.set_answer_delay(3);
  for (int i = 0; i < 5; ++i) {
    cycle(DriveWish::Operational, 0);
    EXPECT_NEAR(feedback_.load_counts, counts(30), 1) << i;
  }
}

TEST_F(HonestAxis, SaysThatItTellsWhereItsLoadIs) {
  const SimulatedInterface bus({honest(), SpindlePlantParameters{}}, 0.001);
  EXPECT_TRUE(bus.tells_load(0));
  EXPECT_FALSE(bus.tells_load(1)) << "a spindle's drive tells no position";
}

TEST_F(HonestAxisSeenAtTheLoad, TellsTheLoadsPlace) {
  enable();
  bus_.push(0, -0.2);
  for (int i = 0; i < 30; ++i) cycle(DriveWish::Operational, 600);
  cycle(DriveWish::Operational, 600);
  EXPECT_EQ(feedback_.position_counts, feedback_.load_counts);
}

// Red where the zero of a load is that of a machine without weight: it would hang 123 counts below.
TEST_F(HonestAxisThatHangs, HasItsZeroWhereTheLoadStandsWithItsWeightOnIt) {
  EXPECT_EQ(bus_.plant(0).load_rad(), 0);
  EXPECT_NEAR(load_beside_motor_rad(), 0, 2e-5);
  EXPECT_NEAR(feedback_.load_counts, feedback_.position_counts, 2);
  for (const double angle : {-7.0, 40.0}) {
    bus_.plant(0).put_at(angle);
    EXPECT_NEAR(bus_.plant(0).load_rad(), angle, 1e-12);
    EXPECT_NEAR(load_beside_motor_rad(), 0, 2e-5);
  }
}

// A spring with friction of the guides beside it, which gives way too: both hold what is pushed with.
TEST_F(HonestAxisThatHangs, ShowsWhatIsHungOnItBesideItsOwnWeight) {
  for (const double more_nm : {-0.005, 0.004}) {
    bus_.push(0, 0);
    bus_.plant(0).put_at(0);
    bus_.push(0, more_nm);
    EXPECT_NEAR(load_beside_motor_rad(), more_nm / 15.83, 0.1 * std::abs(more_nm) / 15.83) << more_nm;
  }
}

TEST_F(HonestAxisThatHangsWithPlay, HangsOnTheFlankThatItsZeroWasSetOn) {
  EXPECT_NEAR(load_beside_motor_rad(), 0, 2e-5);
  bus_.push(0, 0.0937 - 0.03);  // less weight, and on the same flank
  EXPECT_NEAR(load_beside_motor_rad(), (0.0937 - 0.03) / 15.83, 7e-4);
  bus_.push(0, 2 * 0.0937);  // as heavy upwards
  EXPECT_NEAR(load_beside_motor_rad(), kPlay + 2 * 0.0937 / 15.83, 7e-4);
}

TEST_F(HonestAxis, ComesToRestByItsDriveAloneAndIsHeldByTheBrake) {
  enable();
  for (int i = 0; i < 60; ++i) cycle(DriveWish::Operational, 1000);
  ASSERT_GT(bus_.plant(0).speed_rad_s(), 300);
  for (int i = 0; i < 400; ++i) cycle(DriveWish::QuickStop);
  EXPECT_LT(std::abs(bus_.plant(0).speed_rad_s()), 0.01);
  const double angle = bus_.plant(0).angle_rad();
  bus_.push(0, 0.12);
  for (int i = 0; i < 1000; ++i) cycle(DriveWish::QuickStop);
  EXPECT_NEAR(bus_.plant(0).angle_rad(), angle, 2e-3);
  EXPECT_NEAR(bus_.plant(0).load_rad() - angle, 0.12 / 15.83, 0.002);
}

TEST_F(HonestAxisOnVelocity, IsHeldByTheDrivesOwnLoopsWithoutSwinging) {
  enable();
  for (int i = 0; i < 500; ++i) cycle(DriveWish::Operational, 0, 600);
  double least = 1e9, most = 0;
  for (int i = 0; i < 200; ++i) {
    cycle(DriveWish::Operational, 0, 600);
    least = std::min(least, bus_.plant(0).load_rad_s());
    most = std::max(most, bus_.plant(0).load_rad_s());
  }
  EXPECT_GT(least, 0.95 * 600 * std::numbers::pi / 30);
  EXPECT_LT(most, 1.05 * 600 * std::numbers::pi / 30);
}

}  // namespace
