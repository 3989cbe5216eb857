#include <gmock/gmock.h>

#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<double> zs_of(const std::string& lines) {
  std::vector<double> zs;
  for (const auto& end : ends_of(lines)) zs.push_back(end.at(2));
  return zs;
}

TEST(FanucCycle, KeepsItsWordsUntilG80) {
  EXPECT_THAT(zs_of("G98 G81 X1. Z-2. R2. F100.\nX2.\nG83 X3. Q5.\nG80"),
              ElementsAre(10, 2, -2, 10, 10, 2, -2, 10, 10, 2, -2, 10));
  EXPECT_THAT(refusal_of(program_of("G81 X1. Z-2. R2.\nG80\nG81 X2.")), HasSubstr("needs R"));
}

TEST(FanucCycle, GivesWayToTheMotionBeforeIt) {
  const auto done = imported(program_of("G1 X1.\nG99 G81 Z-2. R2.\nG80 X5."));
  EXPECT_EQ(done.methods.back(), "MoveAlongLine");
  EXPECT_THAT(legacy::end_of(done.requests.back())["p"], ElementsAre(5, 0, 2));
}

TEST(FanucCycle, IsRepeatedKTimesAndMayOnlyBeSet) {
  EXPECT_THAT(ends_of("G91 G99 G81 X1. Z-4. R-8. K2").back(), ElementsAre(2, 0, 2));
  EXPECT_THAT(zs_of("G99 G81 Z-2. R2. K0\nX1.\nG80"), ElementsAre(10, 2, -2, 2));
  EXPECT_THAT(ends_of("G91 G99 G81 X1. Z-4. R-8. L2").back(), ElementsAre(2, 0, 2));  // Haas, and older controls
  EXPECT_THAT(refusal_of(program_of("G81 Z-2. R2. L3 K3")), HasSubstr("nothing in this block uses L"));
}

TEST(FanucCycle, ThatDrillsNoHoleIsRefusedElsewhere) {
  EXPECT_THAT(refusal_of(program_of("G91 G81 X10. Z-5. R-48. K0\nX10.")), HasSubstr("write the way as G0"));
  EXPECT_THAT(zs_of("G99 G81 X0 Y0 Z-2. R2. K0\nX1.\nG80"), ElementsAre(10, 2, -2, 2)) << "it is there";
}

TEST(FanucCycle, HasNoStopBesideAHole) {
  for (const char* code : {"M0", "M1", "M5", "M9"}) {
    EXPECT_THAT(refusal_of(program_of(std::string("G99 G81 X1. Z-2. R2. ") + code)), HasSubstr("beside a hole"));
  }
  EXPECT_THAT(zs_of("G99 G81 X1. Z-2. R2. M8\nG80 M9"), ElementsAre(10, 2, -2, 2));
}

TEST(FanucCycle, DwellsByMilliseconds) {
  const auto done = imported(program_of("G99 G82 X1. Z-2. R2. P300"));
  EXPECT_EQ(done.requests[5]["params"]["Time"], 0.3);
  EXPECT_THAT(imported(program_of("G99 G82 X1. Z-2. R2.")).methods, testing::Not(testing::Contains("Dwell")));
}

TEST(FanucCycle, CrossesToAHoleBeforeItGoesToR) {
  EXPECT_THAT(ends_of("G99 G81 X1. Z-2. R2.\nX5. R4.\nG80"),
              ElementsAre(ElementsAre(1, 0, 10), ElementsAre(1, 0, 2), ElementsAre(1, 0, -2), ElementsAre(1, 0, 2),
                          ElementsAre(5, 0, 2), ElementsAre(5, 0, 4), ElementsAre(5, 0, -2), ElementsAre(5, 0, 4)));
  EXPECT_THAT(refusal_of(program_of("G98 G81 X1. Z-2. R12.")), HasSubstr("under G98 R is not above"));
}

TEST(FanucCycle, BoresUpToR) {
  EXPECT_THAT(imported(program_of("G98 G89 X1. Z-2. R2. P100")).methods,
              ElementsAre("MoveToPathTarget", "MoveToPathTarget", "MoveToPathTarget", "SetFeedrate", "MoveAlongLine",
                          "Dwell", "MoveAlongLine", "MoveToPathTarget"));
}

TEST(FanucCycle, IsRefusedWhereItNeedsTheSpindlesAngle) {
  for (const std::string code : {"G74", "G84", "G84.2", "G76", "G87", "G88"})
    EXPECT_THAT(refusal_of(program_of(code + " X1. Z-2. R2. Q1. P1 F100.")), testing::StartsWith("5:1: G")) << code;
}

TEST(FanucCycle, KeepsItsLevelsAsTheBlockMeantThemThatWroteThem) {
  EXPECT_THAT(
      ends_of("G0 Z12.\nG91 G99 G81 X10. R-10. Z-50. F100\nG90 X50."),
      ElementsAre(ElementsAre(0, 0, 12), ElementsAre(10, 0, 12), ElementsAre(10, 0, 2), ElementsAre(10, 0, -48),
                  ElementsAre(10, 0, 2), ElementsAre(50, 0, 2), ElementsAre(50, 0, -48), ElementsAre(50, 0, 2)));
  EXPECT_THAT(zs_of("G99 G81 X10. Z-1.5 R2. F100\nG91 X10. L3"),
              ElementsAre(10, 2, -1.5, 2, 2, -1.5, 2, 2, -1.5, 2, 2, -1.5, 2));
  EXPECT_THAT(refusal_of(program_of("G91 G99 G81 X10. R-8. Z-5. F100\nX10. R-7.")),
              testing::StartsWith("6:6: Z was counted from the R before"));
}

TEST(FanucCycle, IsWrittenAgainInOtherCoordinates) {
  Options options;
  options.offsets[0] = options.offsets[1] = {0, 0, 0};
  options.offsets[1][0] = 5;
  for (const std::string line : {"G55", "G52 X1.", "G92 X2.", "G10 L2 P1 X1. Y0 Z0", "G18"}) {
    const std::string lines = "G99 G81 X1. Z-2. R2.\n" + line + "\n";
    EXPECT_THAT(refusal_of(program_of(lines + "X2."), options), HasSubstr("write the cycle again")) << line;
    EXPECT_THAT(refusal_of(program_of(lines + "G80\nG17 G0 X2."), options), "taken") << line;
  }
  EXPECT_THAT(refusal_of(program_of("G99 G81 X1. Z-2. R2.\nG68.2 X0 Y0 Z5. I0 J0 K0\nX2.")),
              testing::StartsWith("7:1: a work system, other coordinates"));
  EXPECT_EQ(refusal_of(program_of("G99 G81 X1. Z-2. R2.\nG68 X0 Y0 R90.\nX2. Y0")), "taken");
}

}  // namespace
}  // namespace rmac::fanuc
