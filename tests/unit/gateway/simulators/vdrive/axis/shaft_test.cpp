#include "gateway/simulators/vdrive/axis/shaft.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rmac::vdrive {
namespace {

constexpr double kTurn = 131072;

/// Turned by a torque for so long.
Shaft turned(double nm, double seconds) {
  Shaft shaft{fieldbus::AxisPlantParameters()};
  for (double t = 0; t < seconds; t += 1e-4) shaft.advance(nm, false, 1e-4);
  return shaft;
}

TEST(Shaft, TurnsTheWayThatItIsPushedUnlessItsBrakeHoldsIt) {
  EXPECT_GT(turned(0.1, 0.1).angle(), 1000);
  EXPECT_LT(turned(-0.1, 0.1).angle(), -1000);
  Shaft held{fieldbus::AxisPlantParameters()};
  held.advance(0.1, true, 0.1);
  EXPECT_EQ(held.angle(), 0);
}

TEST(Shaft, TellsWholeCountsAndBothShiftsAndForgetsThem) {
  Shaft shaft{fieldbus::AxisPlantParameters()};
  EXPECT_EQ(shaft.position_at(10.9), 10);
  EXPECT_EQ(shaft.position_at(-10.1), -11) << "an encoder counts down to the next line";
  shaft.shift_zero(100);
  shaft.shift_zero(-30);
  shaft.shift_encoder(5);
  EXPECT_EQ(shaft.position_at(10.9), 85);
  EXPECT_EQ(shaft.angle(), 0) << "the shaft itself has not moved";
  shaft.forget_shifts();
  EXPECT_EQ(shaft.position(), 0);
}

TEST(Shaft, CountsTurnsFromTheIndexPulse) {
  const Shaft shaft{fieldbus::AxisPlantParameters()};
  EXPECT_EQ(shaft.turn_of(100, 200), -1);
  EXPECT_EQ(shaft.turn_of(200, 200), 0);
  EXPECT_EQ(shaft.turn_of(200 + kTurn, 200), 1);
}

TEST(Shaft, StandsBelowAFiftiethOfATurnASecond) {
  EXPECT_TRUE(Shaft{fieldbus::AxisPlantParameters()}.stands());
  EXPECT_FALSE(turned(0.1, 0.1).stands());
}

TEST(Shaft, IsBroughtToRestByTheTorqueThatItTells) {
  Shaft shaft = turned(0.1, 0.05);
  const double nm = shaft.nm_to_rest(0.01);
  EXPECT_LT(nm, 0);
  // The velocity in counts/s goes by nm / nm_per_count a second.
  EXPECT_NEAR(shaft.velocity() + nm / shaft.nm_per_count() * 0.01, 0, 1e-6 * shaft.velocity());
}

TEST(Shaft, SlowsDownByTheRampThatIsAskedForAndNoFasterThanItCan) {
  const Shaft shaft{fieldbus::AxisPlantParameters()};
  const double possible = shaft.deceleration(Braking::Torque, 1, 2);
  EXPECT_NEAR(possible, shaft.mechanics().rated_torque_nm / shaft.nm_per_count(), 1e-6 * possible);
  EXPECT_EQ(shaft.deceleration(Braking::SlowDown, 1, 2), 1);
  EXPECT_EQ(shaft.deceleration(Braking::QuickStop, 1, 2), 2);
  EXPECT_EQ(shaft.deceleration(Braking::QuickStop, 1, 2 * possible), possible);
}

}  // namespace
}  // namespace rmac::vdrive
