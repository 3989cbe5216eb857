#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>

#include "unit/clients/legacy/fanuc/haas/imported.hpp"

namespace rmac::fanuc::haas {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kPlace_mm = 2e-7;
const std::string kBegun = "G0 X7. Y3.\nG99 G81 Z-3. R1. F100. L0\n";

/// X, Y and depth of all that is drilled: where a line leads down to.
std::vector<std::array<double, 3>> drilled(const std::string& lines) {
  std::vector<std::array<double, 3>> all;
  for (const auto& request : done(lines).requests) {
    if (request["method"] != "RMAC_CAM.MoveAlongLine") continue;
    const auto end = request["params"]["EndPoint"]["p"].get<std::vector<double>>();
    all.push_back({end[0], end[1], end[2]});
  }
  return all;
}

struct Circle {
  std::size_t count = 0;
  double x = 0, y = 0, radius = 0, first = 0, step = 0, depth = -3;
};

/// These holes, and no other.
void expect_circle(const std::vector<std::array<double, 3>>& all, const Circle& circle, std::size_t begin = 0) {
  ASSERT_GE(all.size(), begin + circle.count);
  for (std::size_t i = 0; i < circle.count; ++i) {
    const double angle = (circle.first + static_cast<double>(i) * circle.step) * std::numbers::pi / 180;
    const auto& hole = all[begin + i];
    EXPECT_NEAR(hole[0], circle.x + circle.radius * std::cos(angle), kPlace_mm) << i;
    EXPECT_NEAR(hole[1], circle.y + circle.radius * std::sin(angle), kPlace_mm) << i;
    EXPECT_NEAR(hole[2], circle.depth, kPlace_mm) << i;
  }
}

void expect_only(const std::string& lines, const Circle& circle) {
  SCOPED_TRACE(lines);
  const auto all = drilled(lines);
  EXPECT_EQ(all.size(), circle.count);
  expect_circle(all, circle);
}

TEST(HaasHoles, LieOnTheirCircle) {
  expect_only(kBegun + "G70 I5. J15. L12", {12, 7, 3, 5, 15, 30});
  expect_only(kBegun + "G70 I5. L4", {4, 7, 3, 5, 0, 90});
  expect_only(kBegun + "G71 I5. J30. K-20. L3", {3, 7, 3, 5, 30, -20});
  expect_only(kBegun + "G70 X1. Y2. I5. L5", {5, 1, 2, 5, 0, 72});
  expect_only(kBegun + "G91\nG70 X1. Y2. I5. L5", {5, 8, 5, 5, 0, 72});
  expect_only("G0 X7. Y3.\nG99 G83 G70 Z-3. R1. Q9. F100. I5. J90. L3", {3, 7, 3, 5, 90, 120});
  const auto two = drilled(kBegun + "G70 I5. L6\nG70 X20. Y0 I2. L6");
  ASSERT_EQ(two.size(), 12U);
  expect_circle(two, {6, 7, 3, 5, 0, 60});
  expect_circle(two, {6, 20, 0, 2, 0, 60}, 6);
}

TEST(HaasHoles, HaveNoneInTheMiddleWhereTheirBlockChangesTheDepth) {
  expect_only(kBegun + "G70 I10. J0 L2 Z-5.", {2, 7, 3, 10, 0, 180, -5});
  expect_only(kBegun + "G70 I10. J0 L2 Z-5. R2.", {2, 7, 3, 10, 0, 180, -5});
  expect_only(kBegun + "G91\nG71 I10. J0 K90. L2 Z-8.", {2, 7, 3, 10, 0, 90, -7});
  EXPECT_THAT(refusal(kBegun + "G70 I10. L2 A90."), StartsWith("7:13: A beside G70"));
}

TEST(HaasHoles, TakeNoPolarPlaceForTheirMiddle) {
  EXPECT_THAT(refusal(kBegun + "G16\nG70 X10. Y30. I10. J0 L2"), StartsWith("8:5: X and Y under G16 beside G70"));
  EXPECT_THAT(refusal(kBegun + "G16\nG71 Y30. I10. J0 K1. L2"), HasSubstr("write G15 before"));
  expect_only(kBegun + "G16\nG70 I10. J0 L2", {2, 7, 3, 10, 0, 180});
}

TEST(HaasHoles, AreRefusedWithoutACycleOrTheirWords) {
  const std::string cycle = "G99 G81 Z-3. R1. F100. L0\n";
  EXPECT_THAT(refusal("G70 I5. L4"), StartsWith("5:1: G70 says where holes are"));
  EXPECT_THAT(refusal(cycle + "G80\nG70 I5. L4"), StartsWith("7:1: G70 says where holes are"));
  EXPECT_THAT(refusal(cycle + "G70 L4"), HasSubstr("needs I"));
  EXPECT_THAT(refusal(cycle + "G70 I5."), HasSubstr("needs L"));
  EXPECT_THAT(refusal(cycle + "G70 I5. L0"), HasSubstr("1 to 10000"));
  EXPECT_THAT(refusal(cycle + "G70 I5. L4 K3."), HasSubstr("K belongs to G71"));
  EXPECT_THAT(refusal(cycle + "G71 I5. L4 J0"), HasSubstr("needs K"));
  EXPECT_THAT(refusal(cycle + "G71 I5. L4 K3."), HasSubstr("needs J"));
  EXPECT_THAT(refusal(cycle + "G70 I-5. L4"), HasSubstr("more than 0"));
  EXPECT_THAT(refusal(cycle + "G70 I5. L4 M9"), HasSubstr("block of its own"));
}

/// Where the tool is behind them, manuals leave open.
TEST(HaasHoles, LeaveWhatComesNextToNameItsPlace) {
  const std::string holes = kBegun + "G70 I5. L4\n";
  for (const std::string next :
       {"G70 I9. L3", "G71 I9. J0 K5. L3", "X1.", "Y1.", "G80\nG0 X1.", "G80\nG91 G0 X1. Y1.", "G91 X1. Y1.", "Z-4.",
        "G80\nG13 I5. Z-1. D0", "G2 X1. Y1. I1.", "G80\nG1 Z-4.", "G91 G70 X1. Y1. I5. L3", "G92 X0", "G80\nG68 R90.",
        "G80\nG41 D0 G1 X1.", "G80\n#1=#5041", "G16 X5."})
    EXPECT_THAT(refusal(holes + next), AllOf(HasSubstr("behind the holes of G70 and G71"), HasSubstr("X and Y")))
        << next;
  for (const std::string next : {"X1. Y1.", "G70 X1. Y1. I5. L3", "G80\nG0 Z50.\nX1. Y1.", "G80\nG1 Z10.\nG0 X1. Y1.",
                                 "Z-4. L0\nX1. Y1.", "G80\nG0 X1. Y1.\nX5.", "G80\nM9", "G80\nG13 X1. Y1. I5. Z-1. D0",
                                 "G70 X1. Y1. Z-5. I5. L3", "G16 X5. Y30.", "G80\nG68 X0 Y0 R90.\nG0 X1. Y1."})
    EXPECT_EQ(refusal(holes + next), "taken") << next;
  Options options;
  options.reference_mm = {{0, 0, 100}};
  EXPECT_EQ(refusal(holes + "G80\nG91 G28 Z0\nG28 X0 Y0\nG90 G0 X1. Y1. Z1.", options), "taken");
  options.approach_mm = {{0, 0, 50}};
  EXPECT_EQ(refusal(holes + "G80\nT1 M6\nG43 H1\nG0 Z20.\nX5.", options), "taken")
      << "a change of tool has its own place";
}

// Red where a stranger's way home from the last hole is refused, or a way down where nobody knows the place is not.
TEST(HaasHoles, LetTheWayHomeGoOn) {
  Options options;
  options.reference_mm = {{0, 0, 100}};
  const std::string holes = kBegun + "G70 I5. L2\nG80\n";
  for (const std::string next : {"G53 G0 Z0\nG53 Y0", "G53 G0 Z0\nG53 X0 Y0\nG0 X5.", "G0 Z50.\nG28\nG90 G0 X5.",
                                 "G91 G28 Z0\nG28 X0 Y0\nG90 G0 X5.", "G91 G28 Z0\nG28 Y0\nG90 X5. Y5.",
                                 "G91 G28 Z0\nG28 Y0\nG90 X5.", "G53 G0 Y0\nG0 X5."})
    EXPECT_EQ(refusal(holes + next, options), "taken") << next;
  for (const std::string next :
       {"G90 G28 Z-4.", "G91 G28 Z-1.", "G91 G28 Z0\nG28 Y0\nG90 Y5.", "G53 G0 Y0\nG0 Y5.", "G53 G0 X0\nG91 X5."})
    EXPECT_THAT(refusal(holes + next, options), HasSubstr("behind the holes of G70 and G71")) << next;
}

TEST(HaasHoles, AreAboutNoPlaceThatATurnLeavesInDoubt) {
  EXPECT_THAT(refusal(kBegun + "G68 X0 Y0 R90.\nG70 I5. L2"), HasSubstr("behind G68, G69"));
  EXPECT_EQ(refusal(kBegun + "G68 X0 Y0 R90.\nG70 X1. Y1. I5. L2"), "taken");
  Options options;
  options.approach_mm = {{0, 0, 50}};
  for (const std::string holes : {"", "G70 I5. L2\n"})
    EXPECT_THAT(refusal(kBegun + holes + "G80\nG0 Z50.\nG68 X0 Y0 R90.\nT2 M6\nG43 H2\nG0 Z20.\nX5.", options),
                HasSubstr("behind G68, G69"))
        << "with holes before it as without";
}

TEST(HaasHoles, TakeAWayUpThatIsNoneButForRounding) {
  EXPECT_EQ(refusal("G0 X7. Y3. Z1.1\nG91 G99 G81 Z-3. R-.8 F100. L0\nG90 G70 X0 Y0 I5. L2\nG80\nG0 Z.3"), "taken");
}

/// K is how often G73 comes up to R there, or the least peck beside I and J.
TEST(HaasDrilling, IsRepeatedByLAlone) {
  EXPECT_EQ(drilled("G99 G81 Z-3. R1. F100. L0\nG91 X5. L3").size(), 3U);
  for (const std::string cycle : {"G73 X0 Y0 Z-20. R1. Q3. K2. F100.", "G83 X0 Y0 Z-20. R1. I3. J1. K1. F100.",
                                  "G81 X0 Y0 Z-20. R1. K2 F100.", "G73 X0 Y0 Z-20. R1. I3. J1. K1. F100."})
    EXPECT_THAT(refusal(cycle), AllOf(HasSubstr("beside a hole"), HasSubstr("write L"), HasSubstr("Q"))) << cycle;
  EXPECT_EQ(refusal_of(program_of("G73 X0 Y0 Z-20. R1. Q3. K2. F100.")), "taken") << "a Fanuc repeats by K";
}

}  // namespace
}  // namespace rmac::fanuc::haas
