#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "conformance/holds.hpp"
#include "conformance/loaded_module.hpp"
#include "gateway/verification/checks/servo_law_check.hpp"
#include "rmac/modules/fuzzy_surface.hpp"
#include "rmac/sdk/servo_law_names.hpp"

namespace {

using namespace rmac;
using conformance::LoadedModule;
using modules::FuzzySurface;
using testing::HasSubstr;

struct LawCase {
  const char* folder;
  const char* module;
  std::vector<double> gains, other_gains;
  std::vector<sdk::Parameter> parameters{};
};
void PrintTo(const LawCase& law, std::ostream* out) {
  *out << law.module;
}

constexpr double kFilter_s = 0.001, kLead_s = 0.0017, kFrictionSpeed = 2, kLoad = 40;
const sdk::Parameter kFiltered{"derivative_filter_s", {&kFilter_s, 1}, nullptr};
const sdk::Parameter kLeading{"lead_s", {&kLead_s, 1}, nullptr};
const sdk::Parameter kSpread{"friction_speed", {&kFrictionSpeed, 1}, nullptr};
constexpr double kPresliding = 0.01, kBreakaway = 1.3, kStribeckSpeed = 2;
const sdk::Parameter kBends{"presliding", {&kPresliding, 1}, nullptr};
const sdk::Parameter kBreaksAway{"breakaway", {&kBreakaway, 1}, nullptr};
const sdk::Parameter kSlides{"stribeck_speed", {&kStribeckSpeed, 1}, nullptr};
const sdk::Parameter kLoaded{"load", {&kLoad, 1}, nullptr};

const std::vector<double> kModelGains{0.16, 0.035, 19, -118};
const std::vector<double> kOtherModelGains{0.3, 0, 40, 0};

class ServoLaws : public testing::TestWithParam<LawCase> {};
INSTANTIATE_TEST_SUITE_P(
    Modules, ServoLaws,
    testing::Values(
        LawCase{
            "mill/3-axis/DMACXYZ", "DMACXYZPIDServoControlLaw", {1500, 100000, 11}, {300, 0, 40}, {kFiltered, kLoaded}},
        LawCase{"modules", "PIDServoControlLaw", {1500, 100000, 11}, {300, 0, 40}, {kFiltered, kLoaded}},
        LawCase{"modules", "FeedforwardServoControlLaw", kModelGains, kOtherModelGains, {kLeading, kSpread}},
        LawCase{"modules",
                "FeedforwardFeedbackServoControlLaw",
                {1500, 100000, 11, 0.16, 0.035, 19, -118},
                {300, 0, 40, 0.3, 0, 40, 0},
                {kFiltered, kLeading, kBends, kBreaksAway, kSlides}},
        LawCase{"modules", "SweptSineServoControlLaw", {1500, 100000, 11}, {300, 0, 40}, {kFiltered, kLoaded}},
        LawCase{"modules", "FuzzyServoControlLaw", {0.1, 15, 80, 100000}, {0.02, 100, 300, 0}, {kFiltered, kLoaded}}),
    [](const testing::TestParamInfo<LawCase>& law) { return std::string(law.param.module); });

TEST_P(ServoLaws, Conforms) {
  LoadedModule module(GetParam().folder, GetParam().module);
  const auto law = module.create<ServoLaw>();
  ASSERT_TRUE(law) << module.error();
  EXPECT_TRUE(conformance::holds(verifier::check_servo_law(*law, {GetParam().gains, GetParam().other_gains})));
}

TEST_P(ServoLaws, RefuseAGainBelowZero) {
  LoadedModule module(GetParam().folder, GetParam().module);
  const auto law = module.create<ServoLaw>();
  ASSERT_TRUE(law) << module.error();
  std::vector<double> gains = GetParam().gains;
  gains.front() = -1;
  EXPECT_FALSE(law->set_gains(gains));
}

TEST_P(ServoLaws, ConformsWithFilterLeadAndLoad) {
  LoadedModule module(GetParam().folder, GetParam().module);
  const auto law = module.create<ServoLaw>(GetParam().parameters);
  ASSERT_TRUE(law) << module.error();
  EXPECT_TRUE(conformance::holds(verifier::check_servo_law(*law, {GetParam().gains, GetParam().other_gains})));
}

TEST_P(ServoLaws, RefuseParametersThatTheyDoNotKnow) {
  LoadedModule module(GetParam().folder, GetParam().module);
  const double value = 0.001;
  for (const char* name : {"rest_bnd", "Load", "", "lead_s_"}) {
    EXPECT_FALSE(module.create<ServoLaw>(std::array{sdk::Parameter{name, {&value, 1}, nullptr}})) << name;
    EXPECT_THAT(module.error(), HasSubstr(std::string("parameter ") + name + " is not understood; there are "));
  }
  EXPECT_FALSE(module.create<ServoLaw>(std::array{sdk::Parameter{GetParam().parameters[0].name, {}, "0.001"}}));
  EXPECT_THAT(module.error(), HasSubstr("must be a number, and is a text"));
}

TEST(ServoLawNames, EachConstantOfAppendixIVIsAModule) {
  for (const auto& [constant, name] : sdk::kServoLawNames) {
    EXPECT_EQ(sdk::servo_law_module(constant), name);
    LoadedModule module("modules", std::string(name));
    ASSERT_NE(module.descriptor(), nullptr) << module.path();
    EXPECT_EQ(module.descriptor()->name, name);
    EXPECT_TRUE(module.create<ServoLaw>()) << module.error();
  }
  EXPECT_EQ(sdk::servo_law_module("DMACXYZPIDServoControlLaw"), "DMACXYZPIDServoControlLaw");
}

class LawsWithFeedback : public ServoLaws {};
INSTANTIATE_TEST_SUITE_P(
    Modules, LawsWithFeedback,
    testing::Values(LawCase{"modules", "PIDServoControlLaw", {1000, 50000, 5}, {}},
                    LawCase{
                        "modules", "FeedforwardFeedbackServoControlLaw", {1000, 50000, 5, 0.16, 0.035, 19, -20}, {}},
                    LawCase{"modules", "FuzzyServoControlLaw", {0.1, 15, 80, 50000}, {}}),
    [](const testing::TestParamInfo<LawCase>& law) { return std::string(law.param.module); });

TEST_P(LawsWithFeedback, LeaveTheirLimitAtOnceAfterALongSaturation) {
  LoadedModule module(GetParam().folder, GetParam().module);
  const auto law = module.create<ServoLaw>();
  ASSERT_TRUE(law) << module.error();
  ASSERT_TRUE(law->set_gains(GetParam().gains));
  law->set_effort_limit(100);
  law->engage({}, 0);
  for (int i = 0; i < 10000; ++i) (void)law->update({.position_setpoint = 1});
  EXPECT_EQ(law->update({.position_setpoint = 1}), 100);
  EXPECT_LT(law->update({.position_setpoint = -0.1}), 100);
}

TEST_P(LawsWithFeedback, TakeUpASteadyLoad) {
  LoadedModule module(GetParam().folder, GetParam().module);
  const auto law = module.create<ServoLaw>();
  ASSERT_TRUE(law) << module.error();
  ASSERT_TRUE(law->set_gains(GetParam().gains));
  law->set_effort_limit(800);
  law->engage({}, 0);
  // A load of 60 N on a mass of 50 kg, with more damping than the law has to bring.
  double position = 0, velocity = 0;
  for (int i = 0; i < 20000; ++i) {
    const double effort = law->update({.position = position, .velocity = velocity});
    velocity += (effort - 60 - 5 * velocity) / 50 * 1e3 * 1e-3;
    position += velocity * 1e-3;
  }
  EXPECT_NEAR(position, 0, 1e-5);
}

TEST(LawParameters, AreRefusedOutOfRange) {
  const double bad = -1;
  for (const auto& [name, parameter] :
       std::vector<std::pair<const char*, const char*>>{{"PIDServoControlLaw", "derivative_filter_s"},
                                                        {"FuzzyServoControlLaw", "derivative_filter_s"},
                                                        {"FeedforwardServoControlLaw", "lead_s"},
                                                        {"FeedforwardFeedbackServoControlLaw", "friction_speed"}}) {
    LoadedModule module("modules", name);
    const std::array<sdk::Parameter, 1> parameters{{{parameter, {&bad, 1}, nullptr}}};
    EXPECT_FALSE(module.create<ServoLaw>(parameters)) << name;
    EXPECT_THAT(module.error(), HasSubstr(std::string(parameter) + " must be one number from "));
  }
}

TEST(FeedforwardLaw, GivesTheEffortOfItsModelOnceTheOffsetHasFaded) {
  LoadedModule module("modules", "FeedforwardServoControlLaw");
  const auto law = module.create<ServoLaw>();
  ASSERT_TRUE(law) << module.error();
  ASSERT_TRUE(law->set_gains(kModelGains));
  law->set_effort_limit(800);
  const ServoInput input{.velocity_setpoint = 100, .acceleration_setpoint = -2000, .position = 3};
  law->engage(input, 500);
  double effort = law->update(input);
  EXPECT_NEAR(effort, 500, 1e-9);
  for (int i = 0; i < 20000; ++i) effort = law->update(input);
  EXPECT_NEAR(effort, 0.16 * 100 - 0.035 * 2000 + 19 - 118, 1e-6);
}

TEST(FeedforwardLaw, TurnsFrictionRoundEarlierByItsLead) {
  LoadedModule module("modules", "FeedforwardServoControlLaw");
  const double lead_s = 0.002;
  const std::array<sdk::Parameter, 1> parameters{{{"lead_s", {&lead_s, 1}, nullptr}}};
  const auto law = module.create<ServoLaw>(parameters);
  ASSERT_TRUE(law) << module.error();
  ASSERT_TRUE(law->set_gains(std::array{0.0, 0.0, 20.0, 0.0}));
  law->set_effort_limit(100);
  law->engage({}, 0);
  constexpr double kDeceleration = -500;
  const auto effort = [&](double before_reversal_s) {
    return law->update(
        {.velocity_setpoint = -kDeceleration * before_reversal_s, .acceleration_setpoint = kDeceleration});
  };
  EXPECT_GT(effort(0.003), 15);
  EXPECT_NEAR(effort(0.002), 0, 1e-9);
  EXPECT_LT(effort(0.001), -15);
}

/// Friction alone, 20 N, as bristles have it, with this much to break away.
class BendingFriction : public testing::TestWithParam<double> {
 protected:
  /// What the law adds to its first effort after ways of `step` mm a cycle, cycle by cycle.
  std::vector<double> efforts(const std::vector<double>& steps, double presliding = kPresliding) {
    LoadedModule module("modules", "FeedforwardServoControlLaw");
    const double breakaway = GetParam(), slow = 0.5;
    const std::array<sdk::Parameter, 3> parameters{{{"presliding", {&presliding, 1}, nullptr},
                                                    {"breakaway", {&breakaway, 1}, nullptr},
                                                    {"stribeck_speed", {&slow, 1}, nullptr}}};
    const auto law = module.create<ServoLaw>(parameters);
    EXPECT_TRUE(law) << module.error();
    EXPECT_TRUE(law->set_gains(std::array{0.0, 0.0, kCoulomb, 0.0}));
    law->set_effort_limit(100);
    law->engage({}, 0);
    std::vector<double> result;
    for (const double step : steps) result.push_back(law->update({.velocity_setpoint = 1000 * step}));
    return result;
  }
  static constexpr double kCoulomb = 20;
};
INSTANTIATE_TEST_SUITE_P(Ratios, BendingFriction, testing::Values(1.0, 1.2, 2.0));

TEST_P(BendingFriction, BuildsUpOverItsWayWhateverTheSpeed) {
  const double slow = efforts(std::vector<double>(100, 1e-5)).back();  // 1 µm in all
  EXPECT_NEAR(slow, kCoulomb * 0.001 / kPresliding, 0.02) << "a tenth of the way, like a spring";
  EXPECT_NEAR(efforts(std::vector<double>(5, 2e-4)).back(), slow, 0.02) << "20 times as fast";
}

TEST_P(BendingFriction, EndsAsSlidingFrictionAndTurnsRoundWithTheWay) {
  EXPECT_NEAR(efforts(std::vector<double>(50, 0.1)).back(), kCoulomb, 1e-6) << "fast: nothing is left to break away";
  std::vector<double> there_and_back(8000, 5e-5);
  there_and_back.insert(there_and_back.end(), 8000, -5e-5);
  const std::vector<double> found = efforts(there_and_back);
  EXPECT_NEAR(found[7999], kCoulomb * (1 + (GetParam() - 1) * std::exp(-0.01)), 1e-3) << "slow: it has to break away";
  EXPECT_NEAR(found.back(), -found[7999], 1e-3);
  EXPECT_GT(found[8040], 0) << "2 µm after it turned round the bristles still push";
}

TEST_P(BendingFriction, IsANumberHoweverSmallItsWayIs) {
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_NEAR(efforts({0, 0.1, 0.1, 0, 0.1}, least).back(), kCoulomb, 1e-6);
  EXPECT_NEAR(efforts({0, 0.1, -0.1}, least).back(), -kCoulomb, 1e-6);
}

TEST_P(BendingFriction, StaysWhereItIsAtRest) {
  std::vector<double> steps(300, 1e-4);
  steps.insert(steps.end(), 500, 0.0);
  const std::vector<double> found = efforts(steps);
  // What is left over from engaging fades, and nothing else changes.
  EXPECT_NEAR(found[299], found.back(), 0.2 * kCoulomb * (GetParam() - 1) + 1e-6);
}

TEST_P(BendingFriction, IsNeverMoreThanWhatBreaksAwayWhateverTheSteps) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> exponent(-7, 1);
  std::vector<double> steps;
  for (int i = 0; i < 20000; ++i) steps.push_back((random() % 2 == 0 ? 1 : -1) * std::pow(10, exponent(random)));
  for (const double effort : efforts(steps)) ASSERT_LE(std::abs(effort), GetParam() * kCoulomb + 1e-9);
}

TEST(FuzzySurface, GivesEachRulesConsequenceWhereItsTermsPeak) {
  for (std::size_t i = 0; i < FuzzySurface::kTerms; ++i) {
    for (std::size_t j = 0; j < FuzzySurface::kTerms; ++j) {
      EXPECT_DOUBLE_EQ(FuzzySurface::at(FuzzySurface::kPeaks[i], FuzzySurface::kPeaks[j]),
                       FuzzySurface::kLevels[FuzzySurface::kRules[i][j]]);
    }
  }
}

TEST(FuzzySurface, IsOddRisesWithBothInputsAndIsSteepestAtItsCentre) {
  constexpr double kStep = 0.01;
  for (double e = -1.2; e <= 1.2; e += kStep) {
    for (double r = -1.2; r <= 1.2; r += kStep) {
      const double here = FuzzySurface::at(e, r);
      ASSERT_LE(std::abs(here), 1);
      ASSERT_NEAR(FuzzySurface::at(-e, -r), -here, 1e-12);
      for (const double up : {FuzzySurface::at(e + kStep, r) - here, FuzzySurface::at(e, r + kStep) - here}) {
        ASSERT_GE(up, -1e-12) << "at " << e << ", " << r;
        ASSERT_LE(up, FuzzySurface::kCentreSlope * kStep + 1e-12) << "at " << e << ", " << r;
      }
    }
  }
  EXPECT_NEAR(FuzzySurface::at(kStep, 0), FuzzySurface::kCentreSlope * kStep, 1e-12);
  EXPECT_NEAR(FuzzySurface::at(0, kStep), FuzzySurface::kCentreSlope * kStep, 1e-12);
}

}  // namespace
