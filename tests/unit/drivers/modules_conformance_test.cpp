#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "conformance/holds.hpp"
#include "conformance/loaded_module.hpp"
#include "gateway/verification/checks/actuator_map_check.hpp"
#include "gateway/verification/checks/kinematics_check.hpp"

namespace {

using namespace rmac;
using conformance::holds;
using conformance::LoadedModule;
using testing::HasSubstr;

constexpr const char* kDmacxyz = "mill/3-axis/DMACXYZ";
constexpr const char* kDmacxy = "mill/2-axis/DMACXY";

constexpr int kSamples = 2000;
const std::vector<Frame> kTools{{}, {{1, -2, 80}, {1, 0, 0, 0}}};

TEST(DmacxyzKinematics, Conforms) {
  LoadedModule module(kDmacxyz, "DMACXYZKinematics");
  const auto kinematics = module.create<Kinematics>();
  ASSERT_TRUE(kinematics) << module.error();
  EXPECT_TRUE(holds(verifier::check_kinematics(*kinematics, {{{-50, 50}, {-50, 50}, {-50, 50}}, kTools, kSamples})));
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
  EXPECT_TRUE(holds(verifier::check_kinematics(*kinematics, {{{-50, 50}, {-50, 50}}, kTools, kSamples})));
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
  const verifier::MappedJoint joint{-50, 50, 1e-3};
  EXPECT_TRUE(holds(verifier::check_actuator_map(*map, {{joint, joint, joint}, 3, kSamples})));
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
  EXPECT_THAT(module.error(), HasSubstr("pitch_mm holds 0; it must be 0.001 to 10000"));
  EXPECT_FALSE(module.create<ActuatorMap>(std::array{sdk::Parameter{"pitch", {kPitch.data(), 3}, nullptr}}));
  EXPECT_THAT(module.error(), HasSubstr("parameter pitch is not understood; there are pitch_mm, gear_ratio"));
}

}  // namespace
