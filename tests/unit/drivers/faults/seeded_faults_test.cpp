#include <gtest/gtest.h>

#include "seeded_fault.hpp"

namespace rmac::fault_test {
namespace {

const TreeMachine& machine_of(unsigned seed) {
  static const std::array<TreeMachine, 4> machines{
      TreeMachine("mill/3-axis/DMACXYZ"), TreeMachine("mill/4-axis/DMACXYZA"), TreeMachine("mill/5-axis/SuginoXYZAC"),
      TreeMachine("bench/5-axis/TarusXYZCATwin")};
  return machines.at(seed / kBrokenCount % machines.size());
}

class SeededFaults : public testing::TestWithParam<Broken> {};

// Ten of each kind; ./bench.sh servo runs ten thousand.
TEST_P(SeededFaults, AreNamedByTheirCauseAndHeld) {
  for (unsigned k = 0; k < 10; ++k) {
    const unsigned seed = k * kBrokenCount + static_cast<unsigned>(GetParam());
    const Outcome outcome = SeededFault(machine_of(seed), GetParam(), seed).run();
    EXPECT_TRUE(outcome.right_cause) << outcome.told;
    EXPECT_TRUE(outcome.in_time) << outcome.told;
    EXPECT_TRUE(outcome.held) << outcome.told;
  }
}

INSTANTIATE_TEST_SUITE_P(OfEveryKind, SeededFaults,
                         testing::Values(Broken::Nothing, Broken::FrozenEncoder, Broken::ReversedSign,
                                         Broken::Oscillation, Broken::BlockedAxis, Broken::Contact,
                                         Broken::LostAnswers),
                         [](const auto& kind) { return to_string(kind.param); });

Outcome seeded(unsigned seed) {
  const auto broken = static_cast<Broken>(seed % kBrokenCount);
  return SeededFault(machine_of(seed), broken, seed).run();
}

// At 1 mm/min an integral part drove these on by 2 to 6 m before anything was found.
TEST(SeededFault, AnEncoderThatFreezesAtACreepIsFoundBeforeTheJointHasGoneFar) {
  for (const unsigned seed : {134U, 169U, 176U, 190U}) {
    const Outcome outcome = seeded(seed);
    EXPECT_STREQ(to_string(outcome.fault.kind), "EncoderFrozen") << outcome.told;
    EXPECT_LT(outcome.gone, 10) << outcome.told;
  }
}

// At 280 mm/s a loop that took it for a standstill gave 70 % of its effort against it, and then all, and swung of that.
TEST(SeededFault, AnAnswerThatIsMissingAtSpeedLeavesALoopInPeace) {
  const Outcome outcome = seeded(102053);
  EXPECT_TRUE(outcome.right_cause) << outcome.told;
  EXPECT_STREQ(to_string(outcome.fault.kind), "None") << outcome.told;
}

// Nobody drives them but the loop, and by little more than friction takes.
TEST(SeededFault, ALoopThatSwingsByLittleMoreThanFrictionTakesIsFoundInTime) {
  for (const unsigned seed : {339U, 801U, 1207U}) {
    const Outcome outcome = seeded(seed);
    EXPECT_STREQ(to_string(outcome.fault.kind), "Oscillation") << outcome.told;
    EXPECT_TRUE(outcome.in_time) << outcome.told;
  }
}

}  // namespace
}  // namespace rmac::fault_test
