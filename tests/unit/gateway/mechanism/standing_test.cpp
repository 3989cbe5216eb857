#include "gateway/mechanism/standing.hpp"

#include <gmock/gmock.h>

#include "gateway/mechanism/assembler.hpp"
#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

/// X from -50 to 50, which may be 2 off its setpoint.
sdk::DeviceObject one_joint(JointLimitType type = JointLimitType::Limited) {
  sdk::DeviceObject device;
  device.joints = {TestMachine::joint("X")};
  device.joints[0].limits.limit_type = type;
  return device;
}

bool may_stand(const sdk::DeviceObject& device, double position, bool as_measured) {
  return check_standing(device, std::array{position}, as_measured).has_value();
}

TEST(CheckStanding, LeavesRoomForRoundingWherePositionsAreSetpoints) {
  const auto device = one_joint();
  EXPECT_TRUE(may_stand(device, 50 + 0.9e-6, false));
  EXPECT_TRUE(may_stand(device, -50 - 0.9e-6, false));
  EXPECT_FALSE(may_stand(device, 50 + 1.1e-6, false));
  EXPECT_FALSE(may_stand(device, -50 - 1.1e-6, false));
}

TEST(CheckStanding, LeavesRoomForTheFollowingErrorWherePositionsAreMeasured) {
  const auto device = one_joint();
  EXPECT_TRUE(may_stand(device, 51.99, true));
  EXPECT_TRUE(may_stand(device, -51.99, true));
  EXPECT_FALSE(may_stand(device, 52.01, true));
  EXPECT_FALSE(may_stand(device, -52.01, true));
}

TEST(CheckStanding, BoundsOnlyTheEndsThatThereAre) {
  EXPECT_TRUE(may_stand(one_joint(JointLimitType::InfinitePositive), 1000, false));
  EXPECT_FALSE(may_stand(one_joint(JointLimitType::InfinitePositive), -51, false));
  EXPECT_TRUE(may_stand(one_joint(JointLimitType::InfiniteNegative), -1000, false));
  EXPECT_FALSE(may_stand(one_joint(JointLimitType::InfiniteNegative), 51, false));
  EXPECT_TRUE(may_stand(one_joint(JointLimitType::Infinite), 1000, false));
}

TEST(CheckStanding, SaysWhichJointStandsWhere) {
  const auto refused = check_standing(one_joint(JointLimitType::InfinitePositive), std::array{-60.5}, false);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::TravelLimit);
  EXPECT_THAT(refused.error().message,
              HasSubstr("joint 0 \"X\" stands at -60.5000, outside of its limits -50 to infinity"));
}

TEST(CheckStanding, DoesNotBoundWhatIsHeld) {
  auto device = one_joint();
  device.held_joints = {TestMachine::joint("Z")};
  EXPECT_TRUE(check_standing(device, std::array{0.0, 1000.0}, false));
}

class StandingAfter : public testing::Test {
 protected:
  std::shared_ptr<Mechanism> made(const sdk::DeviceObject& device) {
    registry_.add_control_interface("TestBus", [](const std::string&, const sdk::ModuleChoice&, const ModuleLoader&) {
      return Expected<std::shared_ptr<DigitalControlInterface>>(
          std::make_shared<fieldbus::SimulatedInterface>(fieldbus::default_simulated_axes(), 0.001));
    });
    sdk::DeviceObject without_io = device;
    without_io.digital_io_interface = {};
    without_io.outputs.clear();
    auto mechanism = assemble(without_io, {}, ModuleLoader({TestMachine::options().module_folders[0]}), registry_);
    EXPECT_TRUE(mechanism) << mechanism.error().message;
    return mechanism ? *mechanism : nullptr;
  }
  BusRegistry registry_;
};

TEST_F(StandingAfter, GoesThroughTheEncodersThatBothHave) {
  const auto now = made(TestMachine::mill());
  sdk::DeviceObject other = TestMachine::plane_mill();
  std::swap(other.actuators[0], other.actuators[1]);  // X is on the drive that Y was on
  other.actuators[2].scale.direction = -1;
  const auto next = made(other);
  ASSERT_TRUE(now && next);
  const auto standing = standing_after(*now, std::array{3.0, -4.0, 7.0}, *next);
  ASSERT_TRUE(standing);
  EXPECT_THAT(*standing, testing::ElementsAre(testing::DoubleNear(-4, 1e-9), testing::DoubleNear(3, 1e-9),
                                              testing::DoubleNear(-7, 1e-9)));
}

TEST_F(StandingAfter, IsNotKnownOfADriveThatIsNew) {
  const auto now = made(TestMachine::mill());
  sdk::DeviceObject other = TestMachine::mill();
  other.actuators[1].axis = 6;
  const auto next = made(other);
  ASSERT_TRUE(now && next);
  EXPECT_FALSE(standing_after(*now, std::array{3.0, -4.0, 7.0}, *next));
}

}  // namespace
}  // namespace rmac::gateway
