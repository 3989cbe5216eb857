// An inverse that gives the joints of the nearest pose that it reaches moves the machine elsewhere than it was told.
#include "gateway/verification/checks/reach_check.hpp"

#include <gmock/gmock.h>

#include "unit/planar_arm.hpp"

namespace rmac::verifier {
namespace {

KinematicsCase arm_case(std::uint64_t seed) {
  KinematicsCase given;
  given.ranges = {{-170, 170}, {-150, 150}, {-100, 0}};
  given.samples = 5000;
  given.seed = seed;
  return given;
}

TEST(ReachCheck, TakesAnArmThatKnowsItsReach) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Checked checked = check_reach(test::PlanarArm(), arm_case(seed));
    EXPECT_TRUE(checked) << to_string(checked.error());
  }
}

TEST(ReachCheck, FindsAnArmThatClampsItsReach) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Checked checked = check_reach(test::PlanarArm(test::ArmFault::ClampsItsReach), arm_case(seed));
    ASSERT_FALSE(checked) << "seed " << seed;
    EXPECT_THAT(to_string(checked.error()), testing::HasSubstr("beyond its reach"));
  }
}

}  // namespace
}  // namespace rmac::verifier
