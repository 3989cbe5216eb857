#include "rmac/fieldbus/simulated_plant.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(SpindlePlant, NeverTurnsFasterThanItsBoundAndRunsDownWithoutPower) {
  SpindlePlant plant{SpindlePlantParameters{}};
  for (int i = 0; i < 5000; ++i) plant.advance(1e6, true, kCycle);
  EXPECT_NEAR(plant.speed_rpm(), 1000, 1);
  for (int i = 0; i < 10000; ++i) plant.advance(1000, false, kCycle);
  EXPECT_NEAR(plant.speed_rpm(), 0, 1);
}

}  // namespace
