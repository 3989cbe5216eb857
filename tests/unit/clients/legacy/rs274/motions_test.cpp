#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// The one arc of a program.
json arc_of(const std::string& lines) {
  const auto done = imported(program_of(lines));
  for (const auto& request : done.requests) {
    if (request["method"] == "RMAC_CAM.MoveAlongArc") return request["params"];
  }
  ADD_FAILURE() << "no arc in " << lines;
  return {};
}

TEST(Rs274Motion, RapidsArePositioningAndFeedsAreLines) {
  const auto done = imported(program_of("G1 X5 F300\nG0 Z20"));
  EXPECT_THAT(done.methods, ElementsAre("MoveToPathTarget", "SetFeedrate", "MoveAlongLine", "MoveToPathTarget"));
  EXPECT_EQ(done.requests[1]["params"]["Feedrate"], 300);
  EXPECT_EQ(done.requests[2]["params"]["StartPoint"]["p"], json({0, 0, 10}));
  EXPECT_EQ(done.requests[2]["params"]["EndPoint"]["p"], json({5, 0, 10}));
}

TEST(Rs274Motion, HasTheFeedOfRapidsBeforeTheFirstOfThemAndItsOwnBehind) {
  std::string text;
  const auto summary = import_program(program_of("G1 X1\nX2\nG0 X3\nX4\nG1 X5"), {.rapid_mm_min = 2500},
                                      [&text](std::string_view part) { text += part; });
  ASSERT_TRUE(summary);
  std::vector<int> feeds;
  for (std::size_t at = 0; (at = text.find("\"Feedrate\":", at)) != std::string::npos; ++at)
    feeds.push_back(std::stoi(text.substr(at + 11)));
  EXPECT_THAT(feeds, ElementsAre(2500, 600, 2500, 600));
}

TEST(Rs274Motion, RemembersTheLineItComesFrom) {
  const auto done = imported(program_of("\n(nothing)\nG1 X5\nX6"));
  EXPECT_EQ(done.requests[0]["params"]["MoveID"], 2);
  EXPECT_EQ(done.requests[2]["params"]["MoveID"], 5);
  EXPECT_EQ(done.requests[3]["params"]["MoveID"], 6);
}

TEST(Rs274Motion, GoesByIncrementsAndInches) {
  EXPECT_THAT(ends_of("G91 X1 Y2\nX1"), ElementsAre(ElementsAre(1, 2, 10), ElementsAre(2, 2, 10)));
  EXPECT_THAT(ends_of("G20 X1\nG21 Y1"), ElementsAre(ElementsAre(25.4, 0, 10), ElementsAre(25.4, 1, 10)));
}

TEST(Rs274Motion, IsRefusedWhereItsStartIsNotKnown) {
  EXPECT_THAT(refusal_of("G21 G0 X1\nM2\n"), StartsWith("1:5: where the tool is before this move is not known"));
  EXPECT_THAT(refusal_of("G21 F9 G1 X1 Y1 Z1\nM2\n"), HasSubstr("not known"));
  const auto done = imported("G21 G0 X1\nM2\n", {.approach_mm = Point{0, 0, 50}});
  EXPECT_EQ(done.requests[0]["params"]["TargetFrame"]["p"], json({0, 0, 50}));
  EXPECT_EQ(done.requests[1]["params"]["TargetFrame"]["p"], json({1, 0, 50}));
}

TEST(Rs274Motion, TakesTheEndOfACycleBesideAMove) {
  EXPECT_THAT(ends_of("G1 X1\nG0 G80 X2\nX3\nG80 G1 X4\nG17 G40 G80\nG1 X6"),
              ElementsAre(ElementsAre(1, 0, 10), ElementsAre(2, 0, 10), ElementsAre(3, 0, 10), ElementsAre(4, 0, 10),
                          ElementsAre(6, 0, 10)));
}

TEST(Rs274Motion, NeedsAModeAndAFeed) {
  EXPECT_THAT(refusal_of("G21 G0 X0 Y0 Z0\nG80\nX1\nM2\n"), StartsWith("3:1: no G0, G1 or other motion"));
  EXPECT_THAT(refusal_of("G21 G0 X0 Y0 Z0\nG1 X1\nM2\n"), StartsWith("2:1: no feed"));
}

// Held against rs274, which sets the feed before the unit.
TEST(Rs274Motion, CountsAFeedInTheUnitBeforeThatOfItsBlock) {
  const auto feeds_of = [](const std::string& program, const Options& options = {}) {
    std::vector<double> feeds;
    for (const auto& request : imported(program, options).requests) {
      if (request["method"] == "RMAC_CAM.SetFeedrate") feeds.push_back(request["params"]["Feedrate"]);
    }
    return feeds;
  };
  EXPECT_THAT(feeds_of(program_of("G20 F10 G1 X1\nG1 X2 F10")), ElementsAre(10, 254));
  EXPECT_THAT(feeds_of(program_of("G20\nF10 G1 X1\nG21 F20 X1\nX2 F20")), ElementsAre(254, 508, 20));
  EXPECT_THAT(feeds_of("G20 F10\nG0 X0 Y0 Z1\nG1 X1\nG21 X2 F10\nM2\n"), ElementsAre(254))
      << "in the first block there is none before it, and 10 inches are 254 mm";
  const auto of_unit = [&feeds_of](double mm, const std::string& program) {
    return feeds_of(program, {.unit_mm = mm});
  };
  EXPECT_THAT(of_unit(25.4, "G21 F100\nG0 X0 Y0 Z1\nG1 X2\nM2\n"), ElementsAre(100))
      << "--unit says what is not written, and the first unit that is written is";
  EXPECT_THAT(of_unit(1, "F100\nG20 F10\nG0 X0 Y0 Z1\nG1 X2\nG21 F20 X3\nM2\n"), ElementsAre(254, 508));
  EXPECT_THAT(of_unit(25.4, "G0 X0 Y0 Z1\nG1 X2 F10\nM2\n"), ElementsAre(254));
}

TEST(Rs274Arc, StaysAnArcInEachPlane) {
  const json xy = arc_of("G3 X10 Y10 I0 J10");
  EXPECT_EQ(xy["RotSign"], 1);
  EXPECT_EQ(xy["Closed"], false);
  EXPECT_EQ(xy["CenterPoint"], json({{"p", {0, 10, 10}}, {"axis", {0, 0, 1}}}));
  EXPECT_EQ(arc_of("G18 G2 X10 Z0 K-10")["CenterPoint"], json({{"p", {0, 0, 0}}, {"axis", {0, 1, 0}}}));
  EXPECT_EQ(arc_of("G19 G2 Y10 Z0 K-10")["CenterPoint"], json({{"p", {0, 0, 0}}, {"axis", {1, 0, 0}}}));
  EXPECT_EQ(arc_of("G90.1 G2 X10 Y10 I10 J0")["CenterPoint"]["p"], json({10, 0, 10}));
}

TEST(Rs274Arc, HasAFullCircleTurnsAndAHelix) {
  const json circle = arc_of("G2 I5 P3 Z4");
  EXPECT_EQ(circle["Closed"], true);
  EXPECT_EQ(circle["Turns"], 2);
  EXPECT_EQ(circle["EndPoint"]["p"], json({0, 0, 4}));
}

/// By the angle of the start and the sweep that a radius of this sign means, seeded.
TEST(Rs274Arc, OfARadiusHasTheCentreOfTheWayThatItsSignMeans) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi), sweep(0.1, 6.1), length(1, 50);
  for (int i = 0; i < 500; ++i) {
    const double radius = length(random), begin = angle(random), turn = sweep(random);
    const bool left = i % 2 == 0;
    const double end = begin + (left ? turn : -turn);
    const double cx = -radius * std::cos(begin), cy = -radius * std::sin(begin);
    const std::string line = fmt::format("G{} X{:.9f} Y{:.9f} R{:.9f}", left ? 3 : 2, cx + radius * std::cos(end),
                                         cy + radius * std::sin(end), turn > std::numbers::pi ? -radius : radius);
    const json arc = arc_of(line);
    // Near half a turn the centre is the less certain the better the digits of the radius fill its square root.
    const double near = std::abs(turn - std::numbers::pi) < 0.01 ? 1e-3 : 1e-5;
    EXPECT_NEAR(arc["CenterPoint"]["p"][0].get<double>(), cx, near) << line;
    EXPECT_NEAR(arc["CenterPoint"]["p"][1].get<double>(), cy, near) << line;
    EXPECT_EQ(arc["RotSign"], left ? 1 : -1);
  }
}

TEST(Rs274Arc, HasItsCentreEvenlyFarFromBothEnds) {
  const json arc = arc_of("G2 X10.004 Y0 I5");
  EXPECT_EQ(arc["CenterPoint"]["p"], json({5.002, 0, 10}));
}

TEST(Rs274Arc, IsRefusedWhereItIsNone) {
  EXPECT_THAT(refusal_of(program_of("G2 X10 Y0 I4")),
              StartsWith("3:1: the arc's centre is 4 mm from its start and 6 mm from its end"));
  EXPECT_THAT(refusal_of(program_of("G2 X10 Y0 R4.9985")),
              StartsWith("3:11: a radius of 4.9985 mm does not reach the end"));
  EXPECT_EQ(arc_of("G2 X10 Y0 R4.999")["CenterPoint"]["p"], json({5, 0, 10}));
  EXPECT_THAT(refusal_of(program_of("G2 X0 Y0 R5")), HasSubstr("the radius alone tells no circle"));
  EXPECT_THAT(refusal_of(program_of("G2 X10")), HasSubstr("without centre and radius"));
  EXPECT_THAT(refusal_of(program_of("G2 X10 I5 R5")), HasSubstr("not both"));
  EXPECT_THAT(refusal_of(program_of("G90.1 G2 X10 I5")), HasSubstr("both I and J"));
  EXPECT_THAT(refusal_of(program_of("G2 X10 I5 K1")), HasSubstr("K in a plane that it is beside of"));
  EXPECT_THAT(refusal_of(program_of("G2 X10 I5 P1.5")), HasSubstr("P of an arc is its turns"));
}

TEST(Rs274Drilling, GoesBackToWhereItsRowBeganUnderG98) {
  EXPECT_THAT(ends_of("G98 G81 X1 Y2 Z-3 R2"),
              ElementsAre(ElementsAre(1, 2, 10), ElementsAre(1, 2, 2), ElementsAre(1, 2, -3), ElementsAre(1, 2, 10)));
  EXPECT_THAT(ends_of("G99 G81 X1 Z-3 R2\nX5"),
              ElementsAre(ElementsAre(1, 0, 10), ElementsAre(1, 0, 2), ElementsAre(1, 0, -3), ElementsAre(1, 0, 2),
                          ElementsAre(5, 0, 2), ElementsAre(5, 0, -3), ElementsAre(5, 0, 2)));
}

TEST(Rs274Drilling, RisesToRFirst) {
  EXPECT_THAT(ends_of("G81 X1 Z-3 R12"),
              ElementsAre(ElementsAre(0, 0, 12), ElementsAre(1, 0, 12), ElementsAre(1, 0, -3), ElementsAre(1, 0, 12)));
}

TEST(Rs274Drilling, PecksAndDwells) {
  EXPECT_THAT(ends_of("G99 G83 Z-3 R2 Q4"),
              ElementsAre(ElementsAre(0, 0, 2), ElementsAre(0, 0, -2), ElementsAre(0, 0, 2), ElementsAre(0, 0, -1.746),
                          ElementsAre(0, 0, -3), ElementsAre(0, 0, 2)));
  EXPECT_THAT(imported(program_of("G82 Z-3 R2 P0.5")).methods, testing::Contains("Dwell"));
}

/// A loop that took the peck off the depth went on for ever.
TEST(Rs274Drilling, EndsThoughAPeckIsTooSmallToChangeItsDepth) {
  const auto done = imported(program_of("G0 Z999999\nG99 G83 R999999 Z999998.9999999 Q.00000000005"));
  EXPECT_EQ(done.requests.back()["params"]["TargetFrame"]["p"], json({0, 0, 999999}));
}

TEST(Rs274Drilling, RepeatsByIncrements) {
  EXPECT_THAT(ends_of("G91 G99 G81 X1 Z-3 R-8 L2"),
              ElementsAre(ElementsAre(1, 0, 10), ElementsAre(1, 0, 2), ElementsAre(1, 0, -1), ElementsAre(1, 0, 2),
                          ElementsAre(2, 0, 2), ElementsAre(2, 0, -1), ElementsAre(2, 0, 2)));
}

TEST(Rs274Drilling, IsRefusedWhereItLacksANumber) {
  EXPECT_THAT(refusal_of(program_of("G81 X1 Z-3")), HasSubstr("needs R"));
  EXPECT_THAT(refusal_of(program_of("G81 Z-3 R2\nG83 X1 Z-3 R2")),
              StartsWith("4:1: the first block of a canned cycle needs Q"));
  EXPECT_THAT(refusal_of(program_of("G81 Z-3 R2\nG81 R1")), StartsWith("4:1: a canned cycle needs X, Y or Z"));
  EXPECT_THAT(refusal_of(program_of("G81 Z-3 R-4")), HasSubstr("above R"));
  EXPECT_THAT(refusal_of(program_of("G83 Z-3 R4 Q0")), HasSubstr("more than 0"));
  EXPECT_THAT(refusal_of(program_of("G83 Z-900 R4 Q.0001")), HasSubstr("pecks"));
}

}  // namespace
}  // namespace rmac::rs274
