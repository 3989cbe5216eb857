// What only whoever imports the program knows: reference points, and names of inputs and outputs.
#include <gmock/gmock.h>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

// As headers and tool changes of posts have it: G53 G0 Z0.
TEST(Rs274Reference, IsWhereTheMachinesZeroIsWhoseZIsOfNoTool) {
  Options options;
  options.reference_mm = {{100, 200, 300}};
  EXPECT_THAT(ends_of("G53 G0 Z0\nG0 G53 X0 Y0", options),
              ElementsAre(std::vector<double>{0, 0, 300}, std::vector<double>{100, 200, 300}));
  EXPECT_THAT(refusal_of(program_of("G53 G0 Z-5"), options), HasSubstr("give --offset"));
  options.offsets[0] = {10, 20, 30};
  EXPECT_EQ(ends_of("G53 G0 X0 Y0 Z0", options).back(), (std::vector<double>{-10, -20, 300}));
  EXPECT_THAT(refusal_of(program_of("G53 G0 Z-5"), options), HasSubstr("Z0 and give --reference-point"));
  EXPECT_THAT(refusal_of(program_of("G91 G53 G0 Z0"), options), HasSubstr("G53 under G91"));
}

TEST(Rs274Reference, IsReachedByWayOfTheProgrammedPlace) {
  Options options;
  options.reference_mm = {{100, 200, 300}};
  EXPECT_EQ(ends_of("G28", options).back(), (std::vector<double>{100, 200, 300}));
  EXPECT_THAT(ends_of("G91 G28 Z5", options),
              ElementsAre(std::vector<double>{0, 0, 15}, std::vector<double>{0, 0, 300}));
  EXPECT_THAT(ends_of("G91 G28 Z0", options), ElementsAre(std::vector<double>{0, 0, 300}));
  EXPECT_THAT(ends_of("G28 X1 Y1", options),
              ElementsAre(std::vector<double>{1, 1, 10}, std::vector<double>{100, 200, 10}));
  EXPECT_THAT(ends_of("G49\nG28", options), testing::SizeIs(1)) << "it is the tip's place, whatever the tool";
  EXPECT_THAT(refusal_of(program_of("G30"), options), HasSubstr("--second-reference-point"));
  EXPECT_THAT(refusal_of(program_of("G28 Z1")), HasSubstr("--reference-point"));
  EXPECT_THAT(refusal_of(program_of("G1 G28 Z1"), options), HasSubstr("would both use the axis words"));
}

TEST(Rs274Names, AreGivenToNumbersOfInputsAndOutputs) {
  Options options;
  options.outputs[3] = "Clamp \"A\"";
  options.inputs[1] = "Door";
  const auto done = imported(program_of("M62 P3\nM65 P3\nM66 P1 L4 Q2.5"), options);
  EXPECT_EQ(done.requests[1]["params"]["Calls"][0]["params"], json({{"Name", "Clamp \"A\""}, {"On", true}}));
  EXPECT_EQ(done.requests[2]["params"]["Calls"][0]["params"]["On"], false);
  EXPECT_EQ(done.requests[3]["params"], json({{"MoveID", 5}, {"Name", "Door"}, {"On", false}, {"TimeOut", 2.5}}));
  EXPECT_THAT(refusal_of(program_of("M62 P4"), options), HasSubstr("--output 4=NAME"));
  EXPECT_THAT(refusal_of(program_of("M66 P4 L3 Q1"), options), HasSubstr("--input 4=NAME"));
  EXPECT_THAT(refusal_of(program_of("M66 P1 L0 Q1"), options), HasSubstr("L3 and L4"));
  EXPECT_THAT(refusal_of(program_of("M66 P1 L3"), options), HasSubstr("needs Q"));
  EXPECT_THAT(refusal_of(program_of("M62"), options), HasSubstr("needs P"));
}

TEST(Rs274Boring, StopsTheSpindleAtTheBottomOrComesUpAtFeed) {
  EXPECT_THAT(imported(program_of("M3 S9\nG86 X0 Y0 R1 Z-1 P1")).methods,
              ElementsAre("MoveToPathTarget", "InTurn", "MoveToPathTarget", "SetFeedrate", "MoveAlongLine", "Dwell",
                          "InTurn", "MoveToPathTarget", "InTurn", "InTurn"));
  EXPECT_THAT(refusal_of(program_of("G86 X0 Y0 R1 Z-1 P1")), HasSubstr("does not turn"));
  EXPECT_THAT(
      imported(program_of("G89 X0 Y0 R1 Z-1 P1")).methods,
      ElementsAre("MoveToPathTarget", "MoveToPathTarget", "SetFeedrate", "MoveAlongLine", "Dwell", "MoveAlongLine"));
  EXPECT_THAT(ends_of("G98 G85 X0 Y0 R1 Z-1"),
              ElementsAre(std::vector<double>{0, 0, 1}, std::vector<double>{0, 0, -1}, std::vector<double>{0, 0, 1},
                          std::vector<double>{0, 0, 10}));
}

TEST(Rs274Boring, BreaksChipsWithoutLeavingTheHole) {
  EXPECT_THAT(
      ends_of("G73 X0 Y0 R2 Z-3 Q3"),
      ElementsAre(std::vector<double>{0, 0, 2}, std::vector<double>{0, 0, -1}, std::vector<double>{0, 0, -0.746},
                  std::vector<double>{0, 0, -3}, std::vector<double>{0, 0, 10}));
}

}  // namespace
}  // namespace rmac::rs274
