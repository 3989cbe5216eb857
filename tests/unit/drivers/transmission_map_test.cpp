#include <gmock/gmock.h>

#include <map>
#include <numbers>

#include "conformance/holds.hpp"
#include "conformance/loaded_module.hpp"
#include "gateway/verification/checks/actuator_map_check.hpp"

namespace {

using namespace rmac;
using conformance::LoadedModule;
using testing::HasSubstr;
using verifier::MappedJoint;

constexpr double kLinear = 1e-3;
constexpr double kRotary = std::numbers::pi / 180;

/// A map of the given transmissions, and the module that it comes from.
class Transmissions {
 public:
  Transmissions(const char* names, const std::vector<std::vector<double>>& numbers) {
    std::vector<sdk::Parameter> parameters{{"transmissions", {}, names}};
    std::vector<std::string> keys;
    for (std::size_t i = 0; i < numbers.size(); ++i) keys.push_back("t" + std::to_string(i + 1));
    for (std::size_t i = 0; i < numbers.size(); ++i) parameters.push_back({keys[i].c_str(), numbers[i], nullptr});
    map = module_.create<ActuatorMap>(parameters);
  }
  [[nodiscard]] std::string error() const { return module_.error(); }

 private:
  LoadedModule module_{"modules", "TransmissionMap"};

 public:
  std::shared_ptr<ActuatorMap> map;  // dies before the module
};

const std::vector<double> kPiston{300, 120, 10, 1.5, 80, -50, 60};
const std::vector<double> kFourBar{60, 150, 90, 160, 20, 100, 1, -30, 30};
const std::vector<double> kCrossedFourBar{60, 150, 90, 160, 20, 100, -1, -20, 20};

struct Case {
  const char* name;
  const char* transmissions;
  std::vector<std::vector<double>> numbers;
  std::vector<MappedJoint> joints;
  std::size_t actuators;
};
void PrintTo(const Case& transmission, std::ostream* out) {
  *out << transmission.name;
}

class TransmissionMap : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Kinds, TransmissionMap,
    testing::Values(
        Case{"Screw", "screw", {{5, 2}}, {{-500, 500, kLinear}}, 1},
        Case{"Gear", "gear", {{90}}, {{-360, 360, kRotary}}, 1},
        Case{"GantryPair", "gantry", {{20, 3}}, {{0, 2000, kLinear}}, 2},
        Case{"DifferentialPair", "differential", {{50, 80}}, {{-180, 180, kRotary}, {-90, 90, kRotary}}, 2},
        Case{"CrossedBelts", "belt-differential", {{40, 40}}, {{-200, 200, kLinear}, {-100, 100, kLinear}}, 2},
        Case{"PistonOnALever", "piston", {kPiston}, {{-50, 60, kRotary}}, 1},
        Case{"FourBarLinkage", "four-bar", {kFourBar}, {{-30, 30, kRotary}}, 1},
        Case{"CrossedFourBarLinkage", "four-bar", {kCrossedFourBar}, {{-20, 20, kRotary}}, 1},
        Case{"AllOfThem",
             " gantry screw  differential four-bar piston gear",
             {{20, 3}, {5, 1}, {50, 80}, kFourBar, kPiston, {90}},
             {{0, 2000, kLinear},
              {-500, 500, kLinear},
              {-180, 180, kRotary},
              {-90, 90, kRotary},
              {-30, 30, kRotary},
              {-50, 60, kRotary},
              {-360, 360, kRotary}},
             8}),
    [](const testing::TestParamInfo<Case>& transmission) { return std::string(transmission.param.name); });

TEST_P(TransmissionMap, Conforms) {
  const Transmissions made(GetParam().transmissions, GetParam().numbers);
  ASSERT_TRUE(made.map) << made.error();
  EXPECT_TRUE(
      conformance::holds(verifier::check_actuator_map(*made.map, {GetParam().joints, GetParam().actuators, 1000})));
}

TEST_P(TransmissionMap, HasEachShaftAtZeroWhereItsJointIs) {
  const Transmissions made(GetParam().transmissions, GetParam().numbers);
  ASSERT_TRUE(made.map) << made.error();
  const std::vector<double> joints(made.map->joint_count());
  std::vector<double> shafts(made.map->actuator_count(), 1);
  made.map->actuator_positions(joints, shafts);
  for (const double shaft : shafts) EXPECT_NEAR(shaft, 0, 1e-12);
}

// Crank and rocker of a parallelogram turn alike, so its map is that of the gear before the crank.
TEST(FourBarLinkage, IsAGearWhenItIsAParallelogram) {
  const Transmissions made("four-bar", {{80, 200, 80, 200, 10, 90, 1, -60, 60}});
  ASSERT_TRUE(made.map) << made.error();
  for (const double degrees : {-60.0, -20.0, 0.0, 35.0, 60.0}) {
    double shaft = 0;
    made.map->actuator_positions({&degrees, 1}, {&shaft, 1});
    EXPECT_NEAR(shaft, 10 * degrees * std::numbers::pi / 180, 1e-9);
  }
}

// At a right angle between base and lever of 3 and 4, the piston measures 5, and its arm is 3 · 4 / 5.
TEST(LeverPiston, PullsOnTheArmThatTrigonometryGives) {
  const Transmissions made("piston", {{400, 300, 2 * std::numbers::pi, 1, 90, -30, 30}});  // 1 rad a mm
  ASSERT_TRUE(made.map) << made.error();
  const double at = 0, newton_metres = 240;
  double torque = 0;
  made.map->actuator_efforts({&at, 1}, {&newton_metres, 1}, {&torque, 1});
  EXPECT_NEAR(torque, 240 / 0.240 * 1e-3, 1e-9);  // 1000 N, which is 1 N·m at 1 mm a radian
}

TEST(TransmissionMapParameters, AreRefusedWithWhatIsWanted) {
  const auto refusal = [](const char* names, const std::vector<std::vector<double>>& numbers) {
    const Transmissions made(names, numbers);
    EXPECT_FALSE(made.map);
    return made.error();
  };
  EXPECT_THAT(refusal("", {}), HasSubstr("must name the transmission of each joint"));
  EXPECT_THAT(refusal("screw chain", {{5, 1}, {3}}),
              HasSubstr("no transmission \"chain\"; there are screw, gear, gantry, differential"));
  EXPECT_THAT(refusal("screw screw", {{5, 1}}), HasSubstr("t2 must be the 2 numbers of a screw: lead_mm, gear"));
  EXPECT_THAT(refusal("gear", {{3}, {5, 1}}), HasSubstr("t2 is not understood; there are transmissions and t1 to t1"));
  EXPECT_THAT(refusal("gear", {{-3}}), HasSubstr("the first 1 above 0"));
  EXPECT_THAT(refusal("piston", {{300, 120, 10, 1.5, 80, -80, 60}}), HasSubstr("between 5 and 175 degrees"));
  EXPECT_THAT(refusal("four-bar", {{60, 150, 90, 160, 20, 100, 1, -100, 100}}), HasSubstr("must close"));
}

}  // namespace
