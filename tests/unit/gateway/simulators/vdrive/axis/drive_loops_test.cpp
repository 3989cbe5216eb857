#include "gateway/simulators/vdrive/axis/drive_loops.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rmac::vdrive {
namespace {

TEST(DriveLoops, BringTheShaftToAPositionAndHoldItThereAsFarAsFrictionLets) {
  for (const double load_nm : {0.0, 0.05}) {
    SCOPED_TRACE(load_nm);
    fieldbus::AxisPlantParameters hanging;
    hanging.gravity_nm = load_nm;
    Shaft shaft{hanging};
    DriveLoops loops;
    loops.start(load_nm);
    for (int step = 0; step < 24'000; ++step) {
      shaft.advance(loops.torque({.position = 5000}, shaft, 0.3, 125e-6), false, 125e-6);
      // It sticks, and the integral part moves it on: within 20 counts, a twentieth of a degree.
      if (step > 2000) {
        ASSERT_NEAR(shaft.position(), 5000, 25) << "step " << step;
      }
    }
  }
}

TEST(DriveLoops, BeginWithTheTorqueThatHoldsTheLoad) {
  DriveLoops loops;
  loops.start(0.05);
  EXPECT_NEAR(loops.torque({}, Shaft{fieldbus::AxisPlantParameters()}, 0.3, 125e-6), 0.05, 1e-9);
}

TEST(DriveLoops, DoNotWindUpBeyondTheTorqueThatTheyMayUse) {
  const Shaft blocked{fieldbus::AxisPlantParameters()};
  DriveLoops loops;
  Demand demand{.position = 1000};
  for (int step = 0; step < 100'000; ++step) static_cast<void>(loops.torque(demand, blocked, 0.3, 125e-6));
  EXPECT_NEAR(loops.torque({}, blocked, 0.3, 125e-6), 0.3, 1e-9) << "what is left when the error is gone";
}

}  // namespace
}  // namespace rmac::vdrive
