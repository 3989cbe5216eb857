#include "gateway/simulators/vdrive/axis/touch_probes.hpp"

#include <gtest/gtest.h>

namespace rmac::vdrive {
namespace {

constexpr unsigned kEnable = 0x01, kIndexPulse = 0x04, kBothEdges = 0x30;

/// No switch is ever met.
AxisSwitches nothing() {
  return {.negative_limit = -1e9,
          .positive_limit = 1e9,
          .cam_from = 1,
          .cam_to = 0,
          .index = 1e8,
          .touches_from = 1,
          .touches_to = 0};
}

/// A shaft that has turned forward by some thousand counts.
Shaft turned() {
  Shaft shaft{fieldbus::AxisPlantParameters()};
  while (shaft.angle() < 5000) shaft.advance(0.1, false, 1e-4);
  return shaft;
}

TEST(TouchProbes, LatchTheCountAtWhichTheZoneBeginsAndEnds) {
  const Shaft shaft = turned();
  AxisSwitches switches = nothing();
  switches.touches_from = 1000;
  switches.touches_to = 1e6;
  TouchProbes probes;
  probes.set_function(kEnable | kBothEdges);
  probes.see(shaft, 0, switches, 2);
  EXPECT_EQ(probes.probe(0).at_rise(), 2000) << "in units, at the edge and not where the shaft is by now";
  switches.touches_to = 3000;
  probes.see(shaft, 2000, switches, 2);
  EXPECT_EQ(probes.probe(0).at_fall(), 6000);
}

TEST(TouchProbes, TakeTheEdgeThatABackwardMoveMeets) {
  const Shaft shaft{fieldbus::AxisPlantParameters()};
  AxisSwitches switches = nothing();
  switches.touches_from = -500;
  switches.touches_to = 700;
  TouchProbes probes;
  probes.set_function(kEnable | kBothEdges);
  probes.see(shaft, 5000, switches, 1);
  EXPECT_EQ(probes.probe(0).at_rise(), 700);
}

TEST(TouchProbes, CloseWhereSomebodyTouchesThem) {
  const Shaft shaft = turned();
  TouchProbes probes;
  probes.set_function((kEnable | kBothEdges) << 8);
  probes.touch(1, true);
  probes.see(shaft, shaft.angle(), nothing(), 1);
  EXPECT_TRUE(probes.probe(1).closed());
  EXPECT_FALSE(probes.probe(0).closed());
  EXPECT_EQ(probes.probe(1).at_rise(), shaft.position());
  EXPECT_EQ(probes.status() & 0xFFU, 0U);
  EXPECT_EQ(probes.status() >> 8U, 0x03U) << "enabled, and a rise is stored";
  probes.reset();
  EXPECT_EQ(probes.status(), 0U);
}

TEST(TouchProbes, LatchTheIndexPulseInEitherDirection) {
  AxisSwitches switches = nothing();
  switches.index = 1234;
  TouchProbes forward;
  forward.set_function(kEnable | kIndexPulse | kBothEdges);
  forward.see(turned(), 0, switches, 1);
  EXPECT_EQ(forward.probe(0).at_rise(), 1234);
  TouchProbes backward;
  backward.set_function(kEnable | kIndexPulse | kBothEdges);
  backward.see(Shaft{fieldbus::AxisPlantParameters()}, 5000, switches, 1);
  EXPECT_EQ(backward.probe(0).at_rise(), 1234);
}

}  // namespace
}  // namespace rmac::vdrive
