#include "servo/joints/transmission.hpp"

#include <gmock/gmock.h>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using testing::DoubleNear, testing::ElementsAre;

std::vector<ServoJoint> joints(std::size_t count) {
  return std::vector<ServoJoint>(count);
}

TEST(Transmission, PassesPositionsThroughMapAndCorrectionsAndBack) {
  const DifferentialMap map;
  auto parts = joints(3);
  parts[0].mechanics.pitch = {0, 10, {0.5, 0.5}};
  const Transmission transmission(map, parts);
  std::array<double, 3> shafts{}, back{};
  transmission.shafts_for(std::array{3.5, 1.0, 7.0}, shafts);
  EXPECT_THAT(shafts, ElementsAre(DoubleNear(4, 1e-9), DoubleNear(2, 1e-9), DoubleNear(7, 1e-9)))
      << "joint 0 stands half a mm beyond where its drive shows it";
  transmission.joints_for(shafts, back);
  EXPECT_THAT(back, ElementsAre(DoubleNear(3.5, 1e-9), DoubleNear(1, 1e-9), DoubleNear(7, 1e-9)));
}

TEST(Transmission, FindsTheEffortsBehindTorques) {
  const DifferentialMap map;
  const auto parts = joints(3);
  const Transmission transmission(map, parts);
  std::array<double, 3> efforts{};
  transmission.efforts_for(std::array{0.0, 0.0, 0.0}, std::array{3.0, 1.0, 7.0}, efforts);
  EXPECT_THAT(efforts, ElementsAre(DoubleNear(4, 1e-9), DoubleNear(2, 1e-9), DoubleNear(7, 1e-9)));
}

TEST(Transmission, MotorsThatDisagreeGiveTheNearestEffort) {
  const GantryMap map;
  const auto parts = joints(2);
  const Transmission transmission(map, parts);
  std::array<double, 2> efforts{};
  transmission.efforts_for(std::array{0.0, 0.0}, std::array{1.0, 5.0, -3.0}, efforts);
  EXPECT_THAT(efforts, ElementsAre(DoubleNear(8, 1e-9), DoubleNear(5, 1e-9)));
}

}  // namespace
}  // namespace rmac::servo_test
