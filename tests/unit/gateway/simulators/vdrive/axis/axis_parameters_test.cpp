#include "gateway/simulators/vdrive/axis/axis_parameters.hpp"

#include "unit/gateway/simulators/vdrive/node_bench.hpp"

namespace rmac::vdrive::test {
namespace {

struct Sheet {
  Dictionary dictionary{sheet(), 5};
  AxisUnits units{dictionary};
  fieldbus::AxisPlantParameters mechanics;

  Sheet() {
    dictionary.set({0x608F, 1}, 1000);  // counts
    dictionary.set({0x608F, 2}, 1);     // a turn of the motor
  }
  AxisParameters read() const { return read_parameters(dictionary, units, mechanics); }
};

TEST(AxisUnits, AreFeedTimesGearsThroughCounts) {
  Sheet bench;
  bench.dictionary.set({0x6092, 1}, 5000);  // units
  bench.dictionary.set({0x6092, 2}, 1);
  bench.dictionary.set({0x6091, 1}, 2);  // turns of the motor
  bench.dictionary.set({0x6091, 2}, 1);  // a turn behind the gear
  EXPECT_DOUBLE_EQ(bench.units.per_count(), 2.5);
}

TEST(AxisUnits, AreTurnedRoundOneByOne) {
  Sheet bench;
  const double unit = bench.units.per_count();
  bench.dictionary.set(0x607E, 0x80);
  EXPECT_EQ(bench.units.of_position(), -unit);
  EXPECT_EQ(bench.units.of_velocity(), unit);
  bench.dictionary.set(0x607E, 0x40);
  EXPECT_EQ(bench.units.of_position(), unit);
  EXPECT_EQ(bench.units.of_velocity(), -unit);
}

TEST(AxisParameters, OrderTheSoftwareLimitsWhicheverWayPositionsGo) {
  Sheet bench;
  bench.dictionary.set({0x607D, 1}, -100);
  bench.dictionary.set({0x607D, 2}, 300);
  const double unit = bench.units.per_count();
  EXPECT_DOUBLE_EQ(bench.read().least_position, -100 / unit);
  EXPECT_DOUBLE_EQ(bench.read().most_position, 300 / unit);
  bench.dictionary.set(0x607E, 0x80);
  EXPECT_DOUBLE_EQ(bench.read().least_position, -300 / unit);
  EXPECT_DOUBLE_EQ(bench.read().most_position, 100 / unit);
  bench.dictionary.set({0x607D, 2}, -100);
  EXPECT_LT(bench.read().least_position, -2e9) << "equal limits are none";
}

TEST(AxisParameters, BoundTorqueByWhatTheMotorCan) {
  Sheet bench;
  bench.dictionary.set(0x6072, 1000);
  EXPECT_DOUBLE_EQ(bench.read().most_torque, bench.mechanics.rated_torque_nm);
  bench.dictionary.set(0x6072, 65535);
  EXPECT_DOUBLE_EQ(bench.read().most_torque, bench.mechanics.peak_torque_nm);
}

TEST(AxisParameters, BoundVelocitiesByTheTopVelocity) {
  Sheet bench;
  bench.dictionary.set(0x607F, 500);
  bench.dictionary.set(0x6081, 900);
  bench.dictionary.set(0x60FF, -900);
  const double unit = bench.units.per_count();
  EXPECT_DOUBLE_EQ(bench.read().velocity, 500 / unit);
  EXPECT_DOUBLE_EQ(bench.read().target_velocity, -500 / unit);
}

}  // namespace
}  // namespace rmac::vdrive::test
