// A, B and C of LinuxCNC's machines, and the codes that their owners made.
#include <gmock/gmock.h>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Rs274Rotary, MeansNothingAtZeroWhereNobodySaysWhatItTurns) {
  EXPECT_THAT(ends_of("G0 X1 A0 B0 C0"), ElementsAre(ElementsAre(1, 0, 10)));
  EXPECT_THAT(refusal_of(program_of("G1 X1 A9")), StartsWith("3:7: which way axis A turns the tool is not known here"));
  EXPECT_THAT(refusal_of(program_of("G1 X1 U0")), HasSubstr("axis U is not taken"));
}

TEST(Rs274Rotary, LeavesXYZToTheMachineUntilItIsTurnedBack) {
  const Options options{.rotary = {{'A', 1}}};
  EXPECT_THAT(refusal_of(program_of("G0 A90\nG0 X1 Y1 Z1"), options), HasSubstr("X, Y and Z are those of the machine"));
  EXPECT_THAT(ends_of("G0 A90\nA0\nG0 X1 Y1 Z1", options), ElementsAre(ElementsAre(1, 1, 1)));
  EXPECT_THAT(refusal_of(program_of("G1 X1 A90"), options), HasSubstr("A, B and C beside X, Y and Z"));
}

TEST(Rs274Rotary, GoesToItsReferenceWithG28AloneToo) {
  const Options options{.reference_mm = {{0, 0, 99}}, .rotary = {{'A', 1}}};
  EXPECT_THAT(refusal_of(program_of("G28\nG0 X1"), options), StartsWith("4:1: where axis A stands behind G28"));
  EXPECT_EQ(refusal_of(program_of("G28 Z20\nG0 X1"), options), "taken");
  EXPECT_THAT(ends_of("G28\nG0 X1 A0", options), ElementsAre(ElementsAre(0, 0, 99), ElementsAre(1, 0, 99)));
}

TEST(Rs274OwnCode, IsPassedOverOnlyWhereItIsToldSo) {
  EXPECT_THAT(refusal_of(program_of("M111 P2 Q3")), StartsWith("3:1: M111 is a code of the machine's own"));
  const Options options{.passed_m = {3, 61, 111}};
  EXPECT_EQ(imported(program_of("M111 P2 Q3\nM61 Q5"), options).requests.size(), 1U);
  EXPECT_EQ(imported(program_of("M3 S5"), options).requests.size(), 3U) << "what is known is done";
  EXPECT_THAT(refusal_of(program_of("M111 R2"), options), StartsWith("3:6: "));
  EXPECT_THAT(refusal_of(program_of("P2"), options), StartsWith("3:1: "));
}

}  // namespace
}  // namespace rmac::rs274
