#include "servo/joints/measured_efforts.hpp"

#include <gmock/gmock.h>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

/// Drives of 2 N·m, the second of which turns against its shaft.
class MeasuredEffort : public testing::Test {
 protected:
  MeasuredEffort() {
    fake_->torque_told = 0b111;
    for (std::uint32_t i = 0; i < 3; ++i) actuators_.push_back({bus_, i, {1000, 2, i == 1 ? -1 : 1, 0}});
  }
  std::vector<double> read(const ActuatorMap& map) {
    const Wiring wiring(map, map.joint_count(), actuators_);
    MeasuredEfforts efforts(map, wiring, actuators_);
    efforts.read(std::vector<double>(map.joint_count()));
    std::vector<double> found;
    for (std::size_t j = 0; j < map.joint_count(); ++j) {
      found.push_back(efforts.told(j) ? efforts[j] : std::numeric_limits<double>::quiet_NaN());
    }
    return found;
  }
  void tell(std::int16_t first, std::int16_t second, std::int16_t third) {
    bus_->feedback[0].torque_permille = first;
    bus_->feedback[1].torque_permille = second;
    bus_->feedback[2].torque_permille = third;
  }
  std::shared_ptr<FakeBus> fake_ = std::make_shared<FakeBus>(3);
  std::shared_ptr<ServoBus> bus_ = std::make_shared<ServoBus>(fake_);
  std::vector<ServoActuator> actuators_;
};

using testing::DoubleNear, testing::ElementsAre, testing::IsNan;

TEST_F(MeasuredEffort, OfAJointWithAMotorOfItsOwnIsItsTorqueThroughTheMap) {
  tell(500, 250, -100);
  EXPECT_THAT(read(DirectMap()), ElementsAre(DoubleNear(1, 1e-9), DoubleNear(-0.5, 1e-9), DoubleNear(-0.2, 1e-9)));
}

TEST_F(MeasuredEffort, OfJointsThatShareMotorsIsFoundFromAllOfTheirTorques) {
  tell(1500, -500, 700);  // 3 and 1 N·m, and 1.4
  EXPECT_THAT(read(DifferentialMap()), ElementsAre(DoubleNear(4, 1e-9), DoubleNear(2, 1e-9), DoubleNear(1.4, 1e-9)));
}

TEST_F(MeasuredEffort, OfTwoMotorsOnOneJointIsTheirSum) {
  tell(500, 0, -1500);  // 1 and -3 N·m at 2 rad a mm
  EXPECT_THAT(read(GantryMap()), ElementsAre(DoubleNear(8, 1e-9), DoubleNear(0, 1e-9)));
}

TEST_F(MeasuredEffort, IsNotToldWhereADriveOfTheJointDoesNotTell) {
  fake_->torque_told = 0b011;
  tell(500, 250, -100);
  EXPECT_THAT(read(DirectMap()), ElementsAre(DoubleNear(1, 1e-9), DoubleNear(-0.5, 1e-9), IsNan()));
  EXPECT_THAT(read(GantryMap()), ElementsAre(IsNan(), DoubleNear(-0.5, 1e-9))) << "half of an effort is none";
  fake_->torque_told = 0b101;
  EXPECT_THAT(read(DifferentialMap()), ElementsAre(IsNan(), IsNan(), DoubleNear(-0.2, 1e-9)));
}

}  // namespace
}  // namespace rmac::servo_test
