// What the posts of CAM systems write that LinuxCNC itself does not have: for Mach, PathPilot and GRBL.
#include <gmock/gmock.h>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Rs274Post, OfVectricForMachSaysTheUnitTwice) {
  const auto made =
      imported("N10G00G20G17G90G40G80\nN20G70G91.1\nN30G00Z0.8X0Y0\nN40G94\nN50X1.0F60.0\nN60G1X2.0\nN70M30\n");
  EXPECT_THAT(legacy::ends_in(made).back(), ElementsAre(50.8, 0, 20.32));
  EXPECT_THAT(ends_of("G71\nG1 X1"), ElementsAre(ElementsAre(1, 0, 10)));
  EXPECT_THAT(refusal_of(program_of("G70\nG1 X1")),
              StartsWith("3:1: G70 is a unit on some controls and a cycle of lathes on others; write G20 before it"));
  EXPECT_THAT(refusal_of("G71\nG0 X0 Y0 Z10\nM2\n"), StartsWith("1:1: G71 is a unit")) << "nothing said it before";
  EXPECT_EQ(refusal_of("G71\nG0 X0 Y0 Z10\nM2\n", {.unit_mm = 1}), "taken");
  EXPECT_THAT(refusal_of(program_of("G21 G71")), HasSubstr("G71"));
}

TEST(Rs274Post, EndsInItsHeaderWhatNeverBegins) {
  EXPECT_THAT(ends_of("G90 G54 G64 P0.1 G50 G69 G15 G17 G40 G80\nG1 X1"), ElementsAre(ElementsAre(1, 0, 10)));
  EXPECT_THAT(refusal_of(program_of("G16")), HasSubstr("polar coordinates"));
  EXPECT_THAT(refusal_of(program_of("G51 X2")), HasSubstr("there is no G51"));
  EXPECT_THAT(refusal_of(program_of("G68 X0 Y0 R9")), HasSubstr("there is no G68"));
}

TEST(Rs274Post, WritesACentreBesideThePlaneAsZero) {
  EXPECT_EQ(ends_of("G3 X0 Y20 I0 J10 K0.000"), ends_of("G3 X0 Y20 I0 J10"));
  EXPECT_EQ(ends_of("G18\nG3 X20 I10 J0 K0"), ends_of("G18\nG3 X20 I10 K0"));
  EXPECT_THAT(refusal_of(program_of("G3 X0 Y20 I0 J10 K5")), StartsWith("3:18: K in a plane that it is beside of"));
  EXPECT_THAT(refusal_of(program_of("G90.1\nG3 X0 Y20 I0 J10 K0")), HasSubstr("nothing in this block uses K"))
      << "a place, which is not where the arc is";
  EXPECT_THAT(refusal_of(program_of("G3 X0 Y20 K0")), HasSubstr("write I and J, or R"));
  EXPECT_THAT(refusal_of(program_of("G3 X0 Y20 R10 K0")), HasSubstr("not both"));
}

TEST(Rs274Post, ForGrblEndsWithItsFileWhereItIsToldSo) {
  const std::string program = "G21 G90 F600\nM3 S1000\nG0 X0 Y0 Z10\nG1 X1\n";
  EXPECT_THAT(refusal_of(program), StartsWith("4:6: the program ends without M30 or M2"));
  EXPECT_THAT(refusal_of(program), HasSubstr("give --assume-end"));
  const auto made = imported(program, {.assume_end = true});
  EXPECT_EQ(made.requests.back()["params"]["Calls"][0]["params"]["RPM"], 0) << "spindle and coolant off, as by M2";
  EXPECT_EQ(refusal_of("%\n" + program, {.assume_end = true}), "taken");
  EXPECT_THAT(refusal_of(program + "M98 P1\nM2\nO1\nX5\n", {.assume_end = true}), HasSubstr("ends within o1"));
}

}  // namespace
}  // namespace rmac::rs274
