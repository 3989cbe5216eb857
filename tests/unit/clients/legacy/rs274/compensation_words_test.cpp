// G40, G41 and G42 through the import: whose radius it is, and what may stand between.
#include <gmock/gmock.h>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::ElementsAre;
using testing::StartsWith;
using Place = std::vector<double>;

const Options kTools{.tool_diameters_mm = {{3, 4}}};

TEST(Rs274Compensation, HasTheRadiusOfDOrOfTheToolInTheSpindle) {
  const std::vector<Place> expected{{10, 2, 10}, {20, 2, 10}, {30, 0, 10}};
  EXPECT_EQ(ends_of("G41 D3\nG1 X10\nX20\nG40 X30", kTools), expected);
  EXPECT_EQ(ends_of("G41.1 D4\nG1 X10\nX20\nG40\nX30"), expected);
  Options with_g43 = kTools;
  with_g43.assume_g43 = true;
  with_g43.approach_mm = {{0, 0, 10}};
  EXPECT_EQ(ends_of("T3 M6\nG41 G1 X10\nX20\nG40 X30", with_g43).back(), expected.back());
  EXPECT_THAT(refusal_of(program_of("G41 D4\nG1 X10"), kTools), StartsWith("3:5: the diameter of tool 4 is not known"));
  EXPECT_THAT(refusal_of(program_of("G41\nG1 X10"), kTools), StartsWith("3:1: the program does not say which tool"));
  EXPECT_THAT(refusal_of(program_of("G41 D3.5"), kTools), StartsWith("3:5: D of G41 and G42 is the number"));
  EXPECT_THAT(refusal_of(program_of("G42.1")), StartsWith("3:1: G41.1 and G42.1 need D"));
  EXPECT_THAT(refusal_of(program_of("G42.1 D-4")), StartsWith("3:7: a diameter is 0 to 1000 mm"));
}

TEST(Rs274Compensation, CountsDOfADiameterInTheProgramsUnit) {
  EXPECT_NEAR(ends_of("G20\nG41.1 D1\nG1 X10").back().at(1), 12.7, 1e-6);
}

TEST(Rs274Compensation, GoesOnFromTheContourInIncrements) {
  EXPECT_EQ(ends_of("G41.1 D4\nG91 G1 X10\nX10\nY10\nG40\nX1"),
            (std::vector<Place>{{10, 2, 10}, {18, 2, 10}, {18, 10, 10}, {21, 10, 10}}));
}

TEST(Rs274Compensation, HasEachMoveWithItsLineAndFeed) {
  const auto done = imported(program_of("G41.1 D4\nG1 X10 F100\nF200\nY-10\nG40\nG0 X0"));
  std::vector<std::pair<int, double>> told;
  double feed = 0;
  for (std::size_t i = 0; i < done.requests.size(); ++i) {
    const auto& params = done.requests[i]["params"];
    if (done.methods[i] == "SetFeedrate") feed = params["Feedrate"];
    if (params.contains("EndPoint")) told.emplace_back(params["MoveID"], feed);
  }
  EXPECT_THAT(told, ElementsAre(std::pair(4, 100.0), std::pair(6, 200.0), std::pair(6, 200.0)));
}

TEST(Rs274Compensation, MayBeOnAtTheEnd) {
  EXPECT_EQ(ends_of("G41.1 D4\nG1 X10\nX20").back(), (Place{20, 2, 10}));
  EXPECT_EQ(imported("%\nG21 F9 G0 X0 Y0 Z0\nG41.1 D4 G1 X10\n%\n").requests.back()["params"]["EndPoint"]["p"],
            (nlohmann::json{10, 2, 0}));
}

TEST(Rs274Compensation, TakesMovesAndFeedsAlone) {
  for (const char* line : {"M3 S100", "M8", "T4", "S500", "G4 P1", "G18", "G92 X0", "G55", "G64 P1", "G81 X1 Z1 R2",
                           "M0", "G28", "G41.1 D4", "G43", "G5 X1 Y1 I1 J1 P1 Q1", "G53 G0 X1", "G0 X#5420"}) {
    EXPECT_THAT(refusal_of(program_of(fmt::format("G41.1 D4\nG1 X10\nX20\n{}", line))), StartsWith("6:")) << line;
  }
  EXPECT_THAT(refusal_of(program_of("G81 X0 Y0 Z1 R2\nG41.1 D4\nX10")),
              StartsWith("5:1: a cycle goes by where the tool is"));
  EXPECT_THAT(refusal_of(program_of("G18\nG41.1 D4")), StartsWith("4:1: cutter radius compensation is taken in G17"));
}

TEST(Rs274Compensation, IsLeftByAStraightMove) {
  const std::string contour = "G41.1 D4\nG1 X10\nX20\nG40\n";
  EXPECT_THAT(refusal_of(program_of(contour + "G2 X30 I5")),
              StartsWith("7:1: the first move behind G40 is a straight one"));
  EXPECT_THAT(refusal_of(program_of(contour + "G92 X0")), StartsWith("7:1: the tool is still beside the contour"));
  EXPECT_THAT(refusal_of(program_of(contour + "G42.1 D4")),
              StartsWith("7:1: a straight move stands between G40 and this"));
  EXPECT_EQ(ends_of(contour + "M5\nG0 Z20\nG2 X30 I5").back(), (Place{30, 0, 20}));
}

TEST(Rs274Compensation, GoesThroughLoops) {
  EXPECT_EQ(ends_of("G41.1 D4\nG1 X10\no1 repeat [2]\nG91\nX10\nY10\no1 endrepeat\nG90 G40 X0").size(), 7U);
}

}  // namespace
}  // namespace rmac::rs274
