#include "rmac/fieldbus/simulated_io_interface.hpp"

#include <gtest/gtest.h>

#include "conformance/digital_io_conformance.hpp"

namespace rmac::fieldbus {
namespace {

constexpr double kPeriod_s = 0.001;
constexpr std::uint64_t kValve = 1U << 3, kOpen = 1U << 5, kShut = 1U << 6;

std::uint64_t inputs_with(SimulatedIoInterface& io, std::uint64_t outputs) {
  std::uint64_t inputs = 0;
  EXPECT_TRUE(io.exchange(outputs, inputs));
  return inputs;
}

TEST(SimulatedIo, ConformsToThePort) {
  SimulatedIoInterface io;
  conformance::DigitalIoConformance(io, {.input = 7,
                                         .output = 9,
                                         .turn_input = [&io](bool on) { io.set_inputs(on ? 1U << 7 : 0); },
                                         .output_is_on = [&io] { return (io.outputs() >> 9 & 1U) != 0; }})
      .check();
}

TEST(SimulatedValve, SwitchesItsInputsSomeTimeAfterItsOutput) {
  SimulatedIoInterface io({{3, 5, false, 0.010}, {3, 6, true, 0.004}}, kPeriod_s);
  EXPECT_EQ(inputs_with(io, 0), kShut);
  for (int cycle = 0; cycle < 4; ++cycle) EXPECT_EQ(inputs_with(io, kValve), kShut) << cycle;
  for (int cycle = 4; cycle < 10; ++cycle) EXPECT_EQ(inputs_with(io, kValve), 0U) << "between its ends, " << cycle;
  EXPECT_EQ(inputs_with(io, kValve), kOpen);
}

TEST(SimulatedValve, StaysWhereItIsWhenItsOutputComesBackInTime) {
  SimulatedIoInterface io({{3, 5, false, 0.010}}, kPeriod_s);
  for (int round = 0; round < 3; ++round) {
    for (int cycle = 0; cycle < 10; ++cycle) EXPECT_EQ(inputs_with(io, kValve), 0U);
    EXPECT_EQ(inputs_with(io, 0), 0U) << "the time begins anew";
  }
}

TEST(SimulatedValve, LeavesTheInputsOfTestsAsTheyAre) {
  SimulatedIoInterface io({{3, 5, false, 0}}, kPeriod_s);
  io.set_inputs(kShut);
  EXPECT_EQ(inputs_with(io, kValve), kShut | kOpen);
}

}  // namespace
}  // namespace rmac::fieldbus
