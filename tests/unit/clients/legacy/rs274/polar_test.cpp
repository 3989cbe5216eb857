// Polar coordinates, @ and ^, as LinuxCNC has them.
#include <gmock/gmock.h>

#include <numbers>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::ElementsAre;
using testing::SizeIs;
using testing::StartsWith;

MATCHER_P3(IsAt, x, y, z, "") {
  return std::hypot(arg.at(0) - x, arg.at(1) - y, arg.at(2) - z) < 1e-6;
}

TEST(Rs274Polar, IsADistanceFromZeroAndAnAngleFromX) {
  EXPECT_THAT(ends_of("G1 @20 ^30"), ElementsAre(IsAt(20 * std::cos(std::numbers::pi / 6), 10, 10)));
  EXPECT_THAT(ends_of("G1 X5 Y0\n^90\n@[2+1]\n^-180 Z1").back(), IsAt(-3, 0, 1)) << "what is not said stays";
  EXPECT_THAT(ends_of("G20\nG1 F20 @1 ^0").back(), IsAt(25.4, 0, 10));
  EXPECT_THAT(ends_of("G92 X5 Y0\nG1 @5 ^90").back(), IsAt(-5, 5, 10)) << "about the zero of the program";
  EXPECT_THAT(ends_of("G0 X5\nG81 R2 Z-1 ^90\n^180\nG80"), SizeIs(9))
      << "to the hole, to R, in and out; of the first one too";
}

TEST(Rs274Polar, GoesOnFromWhereTheToolIsUnderG91) {
  EXPECT_THAT(ends_of("G1 X5 Y0\nG91 @2 ^90\n@-3\n^-90").back(), IsAt(4, 0, 10));
  EXPECT_THAT(ends_of("G1 X5 Y0\nG91 @1\nG90 @2").back(), IsAt(2, 0, 10)) << "G90 counts in its own block";
}

TEST(Rs274Polar, LeadsFromHoleToHoleUnderG91) {
  const auto holes = [](const std::string& lines) {
    auto ends = ends_of(lines);
    std::erase_if(ends, [](const auto& end) { return end.at(2) > 0; });
    return ends;
  };
  EXPECT_THAT(holes("G0 X10 Y0\nG91 G81 ^90 R0.1 Z-11 L4"),
              ElementsAre(IsAt(0, 10, -0.9), IsAt(-10, 0, -0.9), IsAt(0, -10, -0.9), IsAt(10, 0, -0.9)))
      << "round a circle of bolts";
  EXPECT_THAT(holes("G0 X3 Y4\nG91 G81 @5 R0.1 Z-11 L3\nG80"),
              ElementsAre(IsAt(6, 8, -0.9), IsAt(9, 12, -0.9), IsAt(12, 16, -0.9)))
      << "along a ray";
  EXPECT_THAT(holes("G92 X1 Y0\nG20\nF10\nG91 G81 ^180 R0.1 Z-0.5 L2"),
              ElementsAre(IsAt(-2, 0, -0.16), IsAt(0, 0, -0.16)))
      << "about the zero of the program, in inches";
}

TEST(Rs274Polar, IsRefusedWhereItLeadsNowhere) {
  for (const auto& [lines, message] : std::initializer_list<std::pair<const char*, const char*>>{
           {"G1 @5", "3:4: the tool is at zero"},
           {"G91 G1 @5 ^3", "3:8: the tool is at zero"},
           {"G18\nG1 @5 ^3", "4:4: @ and ^ are in the plane of X and Y"},
           {"G1 @5 ^3 X1", "3:10: X or Y beside @ or ^"},
           {"G1 @5 @3", "3:7: two @ words"},
           {"G1 ^5 ^3", "3:7: two ^ words"},
           {"G53 G0 @5 ^3", "3:8: @ and ^ go with moves and cycles alone"},
           {"G92 @5 ^3", "3:5: @ and ^ go with moves and cycles alone"},
           {"G1 X3\nG91 G81 @-1 R1 Z-2 L4", "4:9: the tool is at zero"},
           {"T1 M6\nG43 G0 @5", "4:8: where the tool is now is not known"},
           {"G1 @ ^3", "3:6: "},
       })
    EXPECT_THAT(refusal_of(program_of(lines)), StartsWith(message)) << lines;
}

}  // namespace
}  // namespace rmac::rs274
