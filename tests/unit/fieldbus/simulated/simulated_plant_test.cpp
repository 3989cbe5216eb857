#include "rmac/fieldbus/simulated_plant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace rmac::fieldbus;

constexpr double kCycle = 0.001;

AxisPlantParameters without_friction() {
  AxisPlantParameters parameters;
  parameters.coulomb_nm = parameters.static_nm = parameters.viscous_nm_s = 0;
  return parameters;
}

TEST(AxisPlantParameters, ReflectTheTableThroughTheScrew) {
  AxisPlantParameters parameters;
  parameters.rotor_inertia_kg_m2 = parameters.screw_inertia_kg_m2 = 0;
  parameters.table_mass_kg = 20;
  parameters.pitch_mm = 5;
  EXPECT_NEAR(parameters.inertia_kg_m2(), 20 * std::pow(0.005 / (2 * M_PI), 2), 1e-12);
}

TEST(AxisPlant, AcceleratesAsTorqueOverInertia) {
  const AxisPlantParameters parameters = without_friction();
  AxisPlant plant(parameters);
  for (int i = 0; i < 100; ++i) plant.advance(0.1, false, kCycle);
  // The current loop's lag holds back its time constant's worth of acceleration.
  const double expected = 0.1 / parameters.inertia_kg_m2() * (0.1 - parameters.torque_lag_s);
  EXPECT_NEAR(plant.speed_rad_s(), expected, 1e-3 * expected);
}

TEST(AxisPlant, SticksBelowTheStaticFrictionAndBreaksAwayAboveIt) {
  const AxisPlantParameters parameters;
  AxisPlant plant(parameters);
  for (int i = 0; i < 1000; ++i) plant.advance(0.99 * parameters.static_nm, false, kCycle);
  EXPECT_EQ(plant.angle_rad(), 0);
  for (int i = 0; i < 1000; ++i) plant.advance(1.02 * parameters.static_nm, false, kCycle);
  EXPECT_GT(plant.angle_rad(), 0);
}

TEST(AxisPlant, ComesToRestByFrictionAndStaysThere) {
  AxisPlant plant{AxisPlantParameters{}};
  for (int i = 0; i < 100; ++i) plant.advance(0.1, false, kCycle);
  ASSERT_GT(plant.speed_rad_s(), 0);
  for (int i = 0; i < 5000; ++i) plant.advance(0, false, kCycle);
  EXPECT_EQ(plant.speed_rad_s(), 0);
  const double angle = plant.angle_rad();
  for (int i = 0; i < 1000; ++i) plant.advance(0, false, kCycle);
  EXPECT_EQ(plant.angle_rad(), angle);
}

TEST(AxisPlant, LosesToFrictionExactlyTheEnergyThatItHad) {
  AxisPlantParameters parameters;
  parameters.viscous_nm_s = 0;
  AxisPlant plant(parameters);
  for (int i = 0; i < 100; ++i) plant.advance(0.1, false, kCycle);
  for (int i = 0; i < 5; ++i) plant.advance(0, false, kCycle);  // the current loop settles
  const double speed = plant.speed_rad_s();
  const double start = plant.angle_rad();
  for (int i = 0; i < 5000; ++i) plant.advance(0, false, kCycle);
  const double energy = parameters.inertia_kg_m2() * speed * speed / 2;
  EXPECT_NEAR((plant.angle_rad() - start) * parameters.coulomb_nm, energy, 1e-3 * energy);
}

TEST(AxisPlant, GivesNoMoreThanThePeakTorque) {
  const AxisPlantParameters parameters;
  AxisPlant plant(parameters);
  for (int i = 0; i < 20; ++i) plant.advance(100, false, kCycle);
  EXPECT_NEAR(plant.motor_nm(), parameters.peak_torque_nm, 1e-6);
}

TEST(AxisPlant, FallsUnderGravityUnlessTheBrakeHolds) {
  AxisPlantParameters parameters;
  parameters.gravity_nm = 0.1;
  AxisPlant plant(parameters);
  for (int i = 0; i < 1000; ++i) plant.advance(0, true, kCycle);
  EXPECT_EQ(plant.angle_rad(), 0);
  for (int i = 0; i < 1000; ++i) plant.advance(0, false, kCycle);
  EXPECT_LT(plant.angle_rad(), 0);
}

AxisPlantParameters giving_way() {
  AxisPlantParameters parameters = without_friction();
  parameters.stiffness_nm_rad = 15.83;
  parameters.load_inertia_kg_m2 = 1.267e-5;
  return parameters;
}

TEST(AxisPlant, CogsAsOftenATurnAsItIsSaidAndByAsMuch) {
  for (const bool gives_way : {false, true}) {
    AxisPlantParameters parameters = gives_way ? giving_way() : without_friction();
    parameters.cogging = 0.02;
    parameters.cogging_periods = 12;
    AxisPlant plant(parameters);
    plant.put_at(2.5 / 12);
    // Let go between two of its places, it swings about the nearer one: so much stiffness, at rest there.
    double least = plant.angle_rad(), most = least;
    for (int i = 0; i < 2000; ++i) {
      plant.advance(0, false, kCycle);
      least = std::min(least, plant.angle_rad());
      most = std::max(most, plant.angle_rad());
    }
    const double middle = M_PI / 12;
    EXPECT_NEAR((least + most) / 2, middle, 2e-3);
    EXPECT_NEAR((most - least) / 2, middle - 2.5 / 12, 5e-3);
    // What carries it over is its amplitude.
    AxisPlant held(parameters);
    held.put_at(M_PI / 12);
    for (int i = 0; i < 3000; ++i) held.advance(0.9 * 0.02 * parameters.rated_torque_nm * i / 3000, false, kCycle);
    EXPECT_LT(held.angle_rad(), 2 * M_PI / 12);
    for (int i = 0; i < 1000; ++i) held.advance(1.1 * 0.02 * parameters.rated_torque_nm, false, kCycle);
    EXPECT_GT(held.angle_rad(), 4 * M_PI / 12);
  }
}

TEST(AxisPlant, RipplesWithTheTorqueItGives) {
  AxisPlantParameters parameters = without_friction();
  parameters.torque_ripple = 0.1;
  parameters.torque_ripple_periods = 6;
  AxisPlant plant(parameters);
  std::vector<double> speeds;
  for (int i = 0; i < 200; ++i) {
    plant.advance(0.05, false, kCycle);
    speeds.push_back(plant.speed_rad_s());
  }
  // Work over a whole period of the ripple is that of the torque without it.
  const double way = 60 * 2 * M_PI / 6;
  AxisPlant again(parameters);
  while (again.angle_rad() < way) again.advance(0.05, false, 1e-4);
  const double energy = again.speed_rad_s() * again.speed_rad_s() * parameters.inertia_kg_m2() / 2;
  EXPECT_NEAR(energy, 0.05 * again.angle_rad(), 0.01 * energy);
  double least = 1e9, most = 0;
  for (std::size_t i = 1; i < 20; ++i) {
    least = std::min(least, speeds[i] - speeds[i - 1]);
    most = std::max(most, speeds[i] - speeds[i - 1]);
  }
  EXPECT_GT(most / least, 1.08);
}

TEST(AxisPlant, TellsWhereTheLoadIsApartFromTheMotor) {
  AxisPlantParameters parameters = giving_way();
  parameters.coulomb_nm = parameters.static_nm = 0.02;
  AxisPlant plant(parameters);
  EXPECT_EQ(plant.load_rad(), plant.angle_rad());
  plant.push(-0.1);  // hung on since its zero was set
  for (int i = 0; i < 2000; ++i) plant.advance(0, true, kCycle);
  // Friction at the load may hold a tenth of it.
  EXPECT_NEAR(plant.angle_rad() - plant.load_rad(), 0.1 / 15.83, 0.011 / 15.83);
  EXPECT_LT(plant.angle_rad(), 0) << "the brake gives way a little";
  EXPECT_GT(plant.angle_rad(), -1e-3);
}

TEST(AxisPlant, IsOnTheWholeTheRigidOne) {
  AxisPlantParameters parameters;
  AxisPlant rigid(parameters);
  parameters.stiffness_nm_rad = 15.83;
  parameters.load_inertia_kg_m2 = 1.267e-5;
  AxisPlant plant(parameters);
  for (int i = 0; i < 300; ++i) {
    const double nm = 0.1 * std::sin(2 * M_PI * i / 150);
    rigid.advance(nm, false, kCycle);
    plant.advance(nm, false, kCycle);
    ASSERT_NEAR(plant.load_rad(), rigid.angle_rad(), 0.01 * std::abs(rigid.angle_rad()) + 0.02) << i;
  }
  EXPECT_GT(rigid.angle_rad(), 5);
}

TEST(SpindlePlant, ApproachesItsSpeedWithinItsTorque) {
  const SpindlePlantParameters parameters;
  SpindlePlant plant(parameters);
  double before = 0;
  for (int i = 0; i < 2000; ++i) {
    plant.advance(800, true, kCycle);
    const double torque = (plant.speed_rpm() - before) * M_PI / 30 / kCycle * parameters.inertia_kg_m2;
    ASSERT_LE(torque, parameters.max_torque_nm * (1 + 1e-9));
    before = plant.speed_rpm();
  }
  EXPECT_NEAR(plant.speed_rpm(), 800, 1);
}

TEST(SpindlePlant, GivesWhatALoadTakesAndIsStoppedByMoreThanItHas) {
  SpindlePlant plant{SpindlePlantParameters{}};
  for (int i = 0; i < 2000; ++i) plant.advance(-800, true, kCycle);
  plant.load(3);
  for (int i = 0; i < 2000; ++i) plant.advance(-800, true, kCycle);
  EXPECT_NEAR(plant.speed_rpm(), -800, 1e-6);
  EXPECT_NEAR(plant.torque_nm(), -3, 1e-6);
  EXPECT_NEAR(plant.torque_permille(), -600, 1e-3);
  plant.load(6);
  for (int i = 0; i < 2000; ++i) {
    plant.advance(-800, true, kCycle);
    ASSERT_LE(plant.speed_rpm(), 0) << "nothing turns it round";
  }
  EXPECT_GT(plant.speed_rpm(), -800 * 0.05);
  EXPECT_NEAR(std::abs(plant.torque_nm()), 5, 1e-9);
}

TEST(SpindlePlant, StandsInTheEnd) {
  for (const bool powered : {true, false}) {
    SpindlePlant plant{SpindlePlantParameters{}};
    for (int i = 0; i < 2000; ++i) plant.advance(800, true, kCycle);
    for (int i = 0; i < 20'000; ++i) plant.advance(0, powered, kCycle);
    EXPECT_EQ(plant.speed_rpm(), 0) << "not nearly";
    EXPECT_EQ(plant.torque_nm(), 0);
  }
}

TEST(SpindlePlant, NeverTurnsFasterThanItsBoundAndRunsDownWithoutPower) {
  SpindlePlant plant{SpindlePlantParameters{}};
  for (int i = 0; i < 5000; ++i) plant.advance(1e6, true, kCycle);
  EXPECT_NEAR(plant.speed_rpm(), 1000, 1);
  for (int i = 0; i < 10000; ++i) plant.advance(1000, false, kCycle);
  EXPECT_NEAR(plant.speed_rpm(), 0, 1);
}

}  // namespace
