// Beams are held to the closed forms of slender ones, and to what shear makes of a short one.
#include "gateway/chatter/tool_bending.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace rmac::gateway {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

constexpr double kYoung = 580e3, kDensity = 14.45e-9;  // of carbide; N, mm, s

/// Of one diameter all along, though as flutes are as thick as 0.8 of DC.
Tool rod(double diameter, double sticks_out, double in_holder = 40) {
  const double dc = diameter / 0.8, half = sticks_out / 2;
  ToolShape shape{.dc = dc,
                  .re = 0,
                  .apmx = half,
                  .lcf = half,
                  .oal = sticks_out + in_holder,
                  .zefp = 2,
                  .fha = 30,
                  .shank = {{diameter / 2, diameter / 2, half + in_holder}},
                  .holder = {{20, 20, 60}},
                  .bmc = BodyMaterial::Carbide};
  return {.number = 7, .length_mm = sticks_out + 60, .radius_mm = dc / 2, .shape = shape};
}

TEST(ToolBending, OfASlenderRodIsThatOfTheTextbook) {
  const double d = 4, l = 120, inertia = pi * std::pow(d, 4) / 64, area = pi * d * d / 4;
  const ToolBending bending = bending_of(rod(d, l)).value();
  EXPECT_NEAR(bending.compliance_mm_n, l * l * l / (3 * kYoung * inertia), 0.003 * bending.compliance_mm_n);
  ASSERT_EQ(bending.modes.size(), 3u);
  const double unit_hz = std::sqrt(kYoung * inertia / (kDensity * area * std::pow(l, 4))) / (2 * pi);
  const std::array roots{3.5160, 22.0345, 61.6972};
  for (std::size_t i = 0; i < roots.size(); ++i) {
    EXPECT_NEAR(bending.modes[i].frequency_hz / (roots[i] * unit_hz), 1, 0.02) << i;
    // All modes of a clamped beam that are of the same mass swing the same way at the tip: a quarter of it.
    const double omega = 2 * pi * bending.modes[i].frequency_hz;
    EXPECT_NEAR(bending.modes[i].stiffness_n_mm / (omega * omega * kDensity * area * l / 4), 1, 0.03) << i;
  }
}

// Timoshenko's: P·L³/3EI + P·L/κAG.
TEST(ToolBending, OfAShortRodHasItsShear) {
  const double d = 10, l = 20, inertia = pi * std::pow(d, 4) / 64, area = pi * d * d / 4;
  const double poisson = 0.22, shear_modulus = kYoung / (2 * (1 + poisson)),
               shape = 6 * (1 + poisson) / (7 + 6 * poisson);
  const double wanted = l * l * l / (3 * kYoung * inertia) + l / (shape * area * shear_modulus);
  EXPECT_NEAR(bending_of(rod(d, l)).value().compliance_mm_n / wanted, 1, 1e-6);
}

// Two rods in a row, by the work of the force: ∫ x²/EI.
TEST(ToolBending, GoesByTheThicknessOfEachSection) {
  Tool tool = rod(4, 120);
  tool.shape->shank = {{6, 6, 100}};
  const double thin = pi * std::pow(4.0, 4) / 64, thick = pi * std::pow(12.0, 4) / 64;
  const double wanted = (std::pow(60, 3) / thin + (std::pow(120, 3) - std::pow(60, 3)) / thick) / (3 * kYoung);
  EXPECT_NEAR(bending_of(tool).value().compliance_mm_n / wanted, 1, 0.005);
}

TEST(ToolBending, IsSofterOfSteel) {
  Tool tool = rod(6, 50);
  const double carbide = bending_of(tool).value().compliance_mm_n;
  tool.shape->bmc = BodyMaterial::HighSpeedSteel;
  EXPECT_NEAR(bending_of(tool).value().compliance_mm_n / carbide, 580.0 / 220, 0.02);
}

TEST(ToolBending, OfWhatWasMeasuredIsWhatWasMeasured) {
  Tool tool = rod(6, 50);
  tool.shape->modes = {{.frequency_hz = 800, .damping_ratio = 0.03, .stiffness_n_mm = 5e3},
                       {.frequency_hz = 2100, .damping_ratio = 0.02, .stiffness_n_mm = 2e4}};
  const ToolBending bending = bending_of(tool).value();
  EXPECT_DOUBLE_EQ(bending.compliance_mm_n, 1 / 5e3 + 1 / 2e4);
  EXPECT_EQ(bending.modes.size(), 2u);
  EXPECT_EQ(bending.modes[1].frequency_hz, 2100);
}

TEST(ToolBending, IsRefusedWhereNobodyKnows) {
  Tool tool = rod(6, 50);
  tool.shape->bmc = BodyMaterial::Unknown;
  EXPECT_THAT(bending_of(tool).error().message, HasSubstr("give BMC in the tool table, or the Modes of its tip"));
  tool.shape.reset();
  EXPECT_THAT(bending_of(tool).error().message, HasSubstr("no Shape"));
}

TEST(ToolBending, IsRefusedWhereNothingSticksOut) {
  Tool tool = rod(6, 50);
  tool.shape->holder = {{20, 20, tool.length_mm}};
  EXPECT_THAT(bending_of(tool).error().message, HasSubstr("nothing of it sticks out"));
}

}  // namespace
}  // namespace rmac::gateway
