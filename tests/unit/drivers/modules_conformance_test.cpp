#include <gmock/gmock.h>

#include <array>

#include "conformance/actuator_map_conformance.hpp"
#include "conformance/kinematics_conformance.hpp"
#include "conformance/loaded_module.hpp"
#include "conformance/servo_law_conformance.hpp"

namespace {

using namespace rmac;
using conformance::LoadedModule;
using testing::HasSubstr;

constexpr const char* kDmacxyz = "mill/3-axis/DMACXYZ";
constexpr const char* kDmacxy = "mill/2-axis/DMACXY";

const std::vector<Frame> kTools{{}, {{1, -2, 80}, {1, 0, 0, 0}}};

TEST(DmacxyzKinematics, Conforms) {
  LoadedModule module(kDmacxyz, "DMACXYZKinematics");
  const auto kinematics = module.create<Kinematics>();
  ASSERT_TRUE(kinematics) << module.error();
  conformance::KinematicsConformance(*kinematics, {{-50, 50}, {-50, 50}, {-50, 50}}, kTools).check();
}

TEST(DmacxyzKinematics, CannotReachATiltedTool) {
  LoadedModule module(kDmacxyz, "DMACXYZKinematics");
  const auto kinematics = module.create<Kinematics>();
  ASSERT_TRUE(kinematics) << module.error();
  std::array<double, 3> joints{};
  EXPECT_EQ(kinematics->inverse({{0, 0, 0}, {0.1, 0, 0.995}}, {}, joints, joints), KinematicsStatus::OutOfReach);
}

TEST(DmacxyKinematics, Conforms) {
  LoadedModule module(kDmacxy, "DMACXYKinematics");
  const auto kinematics = module.create<Kinematics>();
  ASSERT_TRUE(kinematics) << module.error();
  conformance::KinematicsConformance(*kinematics, {{-50, 50}, {-50, 50}}, kTools).check();
}

TEST(DmacxyKinematics, ReachesItsPlaneOnly) {
  LoadedModule module(kDmacxy, "DMACXYKinematics");
  const auto kinematics = module.create<Kinematics>();
  ASSERT_TRUE(kinematics) << module.error();
  std::array<double, 2> joints{};
  const Frame tool{{0, 0, 80}, {1, 0, 0, 0}};
  EXPECT_EQ(kinematics->inverse({{10, 20, 80 + 0.9e-6}, {0, 0, 1}}, tool, joints, joints), KinematicsStatus::Ok);
  EXPECT_EQ(kinematics->inverse({{10, 20, 80 + 1.1e-6}, {0, 0, 1}}, tool, joints, joints),
            KinematicsStatus::OutOfReach);
  EXPECT_EQ(kinematics->inverse({{10, 20, 80 - 1.1e-6}, {0, 0, 1}}, tool, joints, joints),
            KinematicsStatus::OutOfReach);
  EXPECT_EQ(kinematics->inverse({{10, 20, std::nan("")}, {0, 0, 1}}, tool, joints, joints),
            KinematicsStatus::OutOfReach);
}

const std::array<double, 3> kPitch{5, 10, 2.5};
const std::array<double, 3> kGear{1, 2, 0.5};

std::vector<sdk::Parameter> screws(std::span<const double> pitch, std::span<const double> gear) {
  return {{"pitch_mm", pitch, nullptr}, {"gear_ratio", gear, nullptr}};
}

class MachineActMap : public testing::TestWithParam<std::pair<const char*, const char*>> {};
INSTANTIATE_TEST_SUITE_P(Mills, MachineActMap,
                         testing::Values(std::pair{kDmacxyz, "DMACXYZMachineActMap"},
                                         std::pair{kDmacxy, "DMACXYMachineActMap"}));

TEST_P(MachineActMap, Conforms) {
  LoadedModule module(GetParam().first, GetParam().second);
  const auto map = module.create<ActuatorMap>(screws(kPitch, kGear));
  ASSERT_TRUE(map) << module.error();
  ASSERT_EQ(map->joint_count(), 3U);
  ASSERT_EQ(map->actuator_count(), 3U);
  conformance::check_actuator_map(*map, 50, {1e-3, 1e-3, 1e-3});
}

TEST_P(MachineActMap, TurnsTheScrewOncePerPitch) {
  LoadedModule module(GetParam().first, GetParam().second);
  const auto map = module.create<ActuatorMap>(screws(kPitch, kGear));
  ASSERT_TRUE(map) << module.error();
  std::array<double, 3> shafts{};
  map->actuator_positions(kPitch, shafts);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(shafts[i], 2 * 3.14159265358979 * kGear[i], 1e-9);
}

TEST_P(MachineActMap, RefusesParametersThatAreMissingOrImpossible) {
  LoadedModule module(GetParam().first, GetParam().second);
  EXPECT_FALSE(module.create<ActuatorMap>());
  EXPECT_THAT(module.error(), HasSubstr("pitch_mm has 0 values; give 3"));
  const std::array<double, 3> bad{5, 0, 5};
  EXPECT_FALSE(module.create<ActuatorMap>(screws(bad, kGear)));
  EXPECT_THAT(module.error(), HasSubstr("pitch_mm holds 0; it must be above 0"));
}

class PidLaw : public testing::TestWithParam<std::pair<const char*, const char*>> {};
INSTANTIATE_TEST_SUITE_P(Modules, PidLaw,
                         testing::Values(std::pair{kDmacxyz, "DMACXYZPIDServoControlLaw"},
                                         std::pair{"modules", "PIDServoControlLaw"}));

TEST_P(PidLaw, Conforms) {
  LoadedModule module(GetParam().first, GetParam().second);
  for (const double filter_s : {0.0, 0.001}) {
    const std::array<sdk::Parameter, 1> parameters{{{"derivative_filter_s", {&filter_s, 1}, nullptr}}};
    const auto law = module.create<ServoLaw>(parameters);
    ASSERT_TRUE(law) << module.error();
    conformance::ServoLawConformance(*law, {1500, 100000, 11}).check();
  }
}

TEST_P(PidLaw, DoesNotJumpWhenGainsChange) {
  LoadedModule module(GetParam().first, GetParam().second);
  const auto law = module.create<ServoLaw>();
  ASSERT_TRUE(law) << module.error();
  ASSERT_TRUE(law->set_gains(std::array{1000.0, 0.0, 5.0}));
  law->set_effort_limit(1000);
  const ServoInput input{.position_setpoint = 0.01, .velocity_setpoint = 2, .velocity = 1};
  law->engage({}, 0);
  const double before = law->update(input);
  ASSERT_TRUE(law->set_gains(std::array{2000.0, 0.0, 9.0}));
  EXPECT_NEAR(law->update(input), before, 1e-9);
}

TEST_P(PidLaw, LeavesItsLimitAtOnceAfterALongSaturation) {
  LoadedModule module(GetParam().first, GetParam().second);
  const auto law = module.create<ServoLaw>();
  ASSERT_TRUE(law) << module.error();
  ASSERT_TRUE(law->set_gains(std::array{1000.0, 50000.0, 5.0}));
  law->set_effort_limit(100);
  law->engage({}, 0);
  for (int i = 0; i < 10000; ++i) EXPECT_EQ(law->update({.position_setpoint = 1}), 100);
  EXPECT_LT(law->update({.position_setpoint = -0.01}), 100);
}

TEST_P(PidLaw, RefusesAFilterOutOfRange) {
  LoadedModule module(GetParam().first, GetParam().second);
  const double filter_s = -1;
  const std::array<sdk::Parameter, 1> parameters{{{"derivative_filter_s", {&filter_s, 1}, nullptr}}};
  EXPECT_FALSE(module.create<ServoLaw>(parameters));
  EXPECT_THAT(module.error(), HasSubstr("derivative_filter_s must be one number from 0 to 0.1 s"));
}

}  // namespace
