#include <gmock/gmock.h>

#include <numbers>

#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// Distance and angle of the holes of a program's lines, which are at Z-5.
std::vector<std::array<double, 2>> holes_of(const std::string& lines) {
  std::vector<std::array<double, 2>> holes;
  for (const auto& end : ends_of(lines)) {
    const double degrees = std::atan2(end[1], end[0]) * 180 / std::numbers::pi;
    if (end[2] == -5) holes.push_back({std::hypot(end[0], end[1]), degrees < -1e-6 ? degrees + 360 : degrees});
  }
  return holes;
}

auto at(double distance, double degrees) {
  return ElementsAre(DoubleNear(distance, 1e-6), DoubleNear(degrees, 1e-6));
}

TEST(FanucPolar, IsWhatXAndYMeanUntilG15) {
  EXPECT_THAT(holes_of("G17 G90 G16\nG99 G81 X100. Y30. Z-5. R2. F200.\nY150.\nX50. Y270.\nG15 G80\nG0 X1. Y2. Z-5."),
              ElementsAre(at(100, 30), at(100, 150), at(50, 270), at(std::sqrt(5), 63.4349488)));
  EXPECT_THAT(holes_of("G16 G1 X10. Y90. Z-5.\nX20."), ElementsAre(at(10, 90), at(20, 90)));
}

TEST(FanucPolar, GoesRoundUnderG91) {
  EXPECT_THAT(holes_of("G16 G99 G81 X100. Y30. Z-5. R2. F200.\nG91 Y20. K3\nG15 G80"),
              ElementsAre(at(100, 30), at(100, 50), at(100, 70), at(100, 90)));
}

TEST(FanucPolar, CountsInTheUnitThatIsInForce) {
  EXPECT_THAT(ends_of("G20 G16 F9.\nG1 X1. Y90.").back(), ElementsAre(DoubleNear(0, 1e-6), DoubleNear(25.4, 1e-6), 10));
  EXPECT_THAT(refusal_of(program_of("G16 G0 X10 Y90.")), HasSubstr("no decimal point"));
  Options options;
  options.whole_numbers = gcode::WholeNumbers::Increments;
  EXPECT_THAT(ends_of("G16 G0 X1000 Y90000", options).back(),
              ElementsAre(DoubleNear(0, 1e-6), DoubleNear(1, 1e-6), 10));
}

TEST(FanucPolar, IsNotOfWhatSetsCoordinatesOrTimes) {
  EXPECT_THAT(ends_of("G16\nG52 X5. Y1.\nG4 X1.\nG0 X10. Y0").back(), ElementsAre(DoubleNear(15, 1e-6), 1, 10));
}

TEST(FanucPolar, IsRefusedWhereItsMeaningIsOpen) {
  EXPECT_THAT(refusal_of(program_of("G16 G91 G0 X5. Y3.")), StartsWith("5:12: X under G16 and G91"));
  EXPECT_THAT(refusal_of(program_of("G18 G16 G0 X5.")), StartsWith("5:12: G16 is taken in the plane of X and Y"));
  EXPECT_THAT(refusal_of(program_of("G16 G0 X5.")), HasSubstr("it has no angle"));
  EXPECT_THAT(refusal_of(program_of("T1 M6\nG16 G0 X5.")), HasSubstr("write both distance and angle"));
  EXPECT_THAT(refusal_of(program_of("G12.1")), HasSubstr("polar coordinates"));
}

TEST(FanucPolar, CallsWhatG66Calls) {
  EXPECT_THAT(ends_of("G66 P9\nG16 G0 X5. Y0\nG67", {}, "O9\nG91 G0 Z1.\nG90\nM99\n").back(),
              ElementsAre(DoubleNear(5, 1e-6), DoubleNear(0, 1e-6), 11));
}

}  // namespace
}  // namespace rmac::fanuc
