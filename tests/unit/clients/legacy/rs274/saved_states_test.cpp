// M70 to M73: what holds is saved and restored, as LinuxCNC does it.
#include <gmock/gmock.h>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// Feeds, tolerances, frames and spindle speeds that a program sets, in their order.
std::vector<std::string> settings_of(const std::string& lines, const Options& options = {}) {
  std::vector<std::string> settings;
  for (const auto& request : imported(program_of(lines), options).requests) {
    const auto method = request["method"].get<std::string>();
    const auto& params = request["params"];
    if (method == "RMAC_CAM.SetFeedrate") settings.push_back(fmt::format("F{}", params["Feedrate"].get<double>()));
    if (method == "RMAC_CAM.SetPathTolerance")
      settings.push_back(fmt::format("P{}", params["Tolerance"].get<double>()));
    if (method == "RMAC_CAM.SetPartFrame") settings.push_back("frame" + params["PartFrame"]["p"].dump());
    if (method == "RMAC_CAM.InTurn") settings.push_back(params["Calls"].dump());
  }
  return settings;
}

TEST(Rs274SavedState, HoldsAgainBehindM72) {
  EXPECT_EQ(ends_of("M70\nG20 G91\nG1 X1\nM72\nX2\nX3"),
            (std::vector<std::vector<double>>{{25.4, 0, 10}, {2, 0, 10}, {3, 0, 10}}))
      << "the unit and G90; the motion stays as it is";
  EXPECT_EQ(ends_of("M70\nG18\nM72\nG2 X2 I1").back(), (std::vector<double>{2, 0, 10})) << "the plane";
  EXPECT_THAT(settings_of("M70\nF100\nG1 X1\nM72\nX2"), ElementsAre("F100", "F600"));
  EXPECT_THAT(settings_of("G64 P0.1\nM70\nG61\nM72\nM72"), ElementsAre("P0.1", "P0", "P0.1"))
      << "what holds anyway is not written again";
}

TEST(Rs274SavedState, HoldsSpindleCoolantAndWorkSystem) {
  const Options options{.offsets = {{0, {0, 0, 0}}, {1, {100, 0, 0}}}};
  EXPECT_THAT(settings_of("M70\nG55\nG1 X1\nM72\nX2", options),
              ElementsAre("frame[0,0,0]", "frame[100,0,0]", "F600", "frame[0,0,0]"));
  const auto switched = settings_of("M3 S500 M8\nM70\nM5 M9\nS100\nM72");
  ASSERT_EQ(switched.size(), 4U) << "and the program's end";
  EXPECT_THAT(switched[2], HasSubstr("500"));
  EXPECT_THAT(switched[2], HasSubstr("TurnCoolantOn"));
}

TEST(Rs274SavedState, HoldsAgainWhereASubWithM73Ends) {
  const std::string sub = "o1 sub\nM73\nG20 G91\nG1 X1\no2 if [#1 eq 1]\no1 return\no2 endif\nY1\no1 endsub\n";
  EXPECT_EQ(ends_of(sub + "o1 call [0]\nX2\no1 call [1]\nX3"),
            (std::vector<std::vector<double>>{
                {25.4, 0, 10}, {25.4, 25.4, 10}, {2, 25.4, 10}, {27.4, 25.4, 10}, {3, 25.4, 10}}));
  EXPECT_EQ(ends_of("o1 sub\nM73\nG91\no1 endsub [#<_absolute>]\no1 call\nG1 X1\nX[#<_value> + 1]").back(),
            (std::vector<double>{1, 0, 10}))
      << "what it gives back is computed before";
  EXPECT_EQ(ends_of("M98 P7 L2\nX9\nM2\nO7\nM73\nG1 X[4 + #<_absolute>]\nG91\nM99").back(),
            (std::vector<double>{9, 0, 10}))
      << "each time that a numbered program ends";
}

TEST(Rs274SavedState, IsOfTheSubThatSavedIt) {
  EXPECT_EQ(ends_of("M70\no1 sub\nM70\nG91\nM72\no1 endsub\nG91\no1 call\nG1 X1\nX1").back(),
            (std::vector<double>{2, 0, 10}));
  EXPECT_THAT(refusal_of(program_of("M70\no1 sub\nM72\no1 endsub\no1 call")),
              StartsWith("5:1: M72 without an M70 or M73 before it"));
  EXPECT_THAT(refusal_of(program_of("o1 sub\nM70\no1 endsub\no2 sub\nM72\no2 endsub\no1 call\no2 call")),
              StartsWith("7:1: M72 without"))
      << "what a sub saved is gone with it";
  EXPECT_THAT(refusal_of(program_of("M70\nM71\nM72")), StartsWith("5:1: M72 without"));
  EXPECT_EQ(ends_of("o1 sub\nM73\nG91\nM71\no1 endsub\no1 call\nG1 X1\nX1").back(), (std::vector<double>{2, 0, 10}));
}

TEST(Rs274SavedState, IsRefusedWhereItIsNotKnown) {
  EXPECT_THAT(refusal_of(program_of("M70\nG64 P0.1\nM72")), StartsWith("5:1: how far the path may be"));
  EXPECT_THAT(refusal_of(program_of("M70 G91")), StartsWith("3:1: M70 has a block of its own"));
  EXPECT_THAT(refusal_of(program_of("M70 X1")), StartsWith("3:5: "));
  EXPECT_THAT(refusal_of(program_of("G41.1 D1\nM70")), HasSubstr("cutter radius compensation is on"));
  EXPECT_THAT(refusal_of(program_of("o1 sub\nM73\nG41.1 D1\nG1 X9\no1 endsub\no1 call\nX20\nG40\nX30")),
              StartsWith("7:1: cutter radius compensation is on"));
  EXPECT_THAT(refusal_of("G90 G0 X0 Y0 Z10\n", {.unit_mm = 1}), HasSubstr("may be cut off"));
  EXPECT_THAT(refusal_of("M70\nG21\nG0 X0 Y0 Z10\nM72\nX1\nM2"), StartsWith("5:1: no G20 or G21 says"));
}

TEST(Rs274SavedState, DoesNotHaveTheToolsLengthCountThatNobodySaidIt) {
  EXPECT_THAT(refusal_of(program_of("M70\nT1 M6\nG43\nM72\nG0 X0 Y0 Z10")), StartsWith("7:1: "));
  EXPECT_EQ(refusal_of(program_of("T1 M6\nG43\nM70\nT2 M6\nM72\nG0 X0 Y0 Z10")), "taken");
}

}  // namespace
}  // namespace rmac::rs274
