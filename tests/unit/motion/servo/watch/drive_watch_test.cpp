#include "servo/watch/drive_watch.hpp"

#include "servo/watch/deadline_watch.hpp"
#include "servo/watch/torque_watch.hpp"
#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using Kind = ServoFault::Kind;
using Part = ServoFault::Part;
using testing::ElementsAre, testing::IsEmpty;

constexpr std::uint16_t kOperational = 0x27, kSwitchedOn = 0x23, kFault = 0x08, kFaultReaction = 0x0F;

std::vector<ServoFault> watched(const DriveFeedback& words, bool in_use) {
  RecordedFaults faults;
  watch_drive(words, in_use, Part::Spindle, 2, faults);
  return faults.raised;
}

TEST(DriveWatch, OperationalDriveIsFine) {
  EXPECT_THAT(watched({.statusword = kOperational, .online = true}, true), IsEmpty());
}

TEST(DriveWatch, SilentDriveIsAFaultWhileItIsInUse) {
  EXPECT_THAT(watched({.statusword = kFault, .online = false}, true),
              ElementsAre(is_fault(Kind::DriveOffline, Part::Spindle, 2, 0, 0)));
  EXPECT_THAT(watched({.statusword = kFault, .online = false}, false), IsEmpty()) << "what it told last is old";
}

TEST(DriveWatch, FaultOfTheDriveIsOneInUseOrNot) {
  for (const std::uint16_t status : {kFault, kFaultReaction}) {
    for (const bool in_use : {true, false}) {
      EXPECT_THAT(watched({.statusword = status, .error_code = 0x2310, .online = true}, in_use),
                  ElementsAre(is_fault(Kind::DriveFault, Part::Spindle, 2, 0x2310, 0)));
    }
  }
}

TEST(DriveWatch, FaultOfItsEncoderIsALostSensor) {
  EXPECT_THAT(watched({.statusword = kFault, .error_code = 0x7305, .online = true}, true),
              ElementsAre(is_fault(Kind::SensorLost, Part::Spindle, 2, 0x7305, 0)));
  EXPECT_THAT(watched({.statusword = kFault, .error_code = 0x7405, .online = true}, true),
              ElementsAre(is_fault(Kind::DriveFault, Part::Spindle, 2, 0x7405, 0)));
}

TEST(DriveWatch, DriveThatLeftOperationIsAFaultWhileItIsInUse) {
  EXPECT_THAT(watched({.statusword = kSwitchedOn, .online = true}, true),
              ElementsAre(is_fault(Kind::DriveDropped, Part::Spindle, 2, kSwitchedOn, 0)));
  EXPECT_THAT(watched({.statusword = kSwitchedOn, .online = true}, false), IsEmpty());
}

TEST(DriveWatch, DriveThatDidNotComeUpIsNamedWithWhereItIsStuck) {
  RecordedFaults faults;
  watch_enabled({.statusword = kOperational, .online = true}, 5, Part::Actuator, 0, faults);
  watch_enabled({.statusword = kSwitchedOn, .online = true}, 5, Part::Actuator, 1, faults);
  watch_enabled({.statusword = kOperational, .online = false}, 5, Part::Actuator, 2, faults);
  EXPECT_THAT(faults.raised, ElementsAre(is_fault(Kind::EnableTimeout, Part::Actuator, 1, kSwitchedOn, 5),
                                         is_fault(Kind::DriveOffline, Part::Actuator, 2, kOperational, 5)));
}

class WatchedTorques : public testing::Test {
 protected:
  void cycle(std::int16_t first, std::int16_t second) {
    bus_->feedback[0].torque_permille = first;
    bus_->feedback[1].torque_permille = second;
    watch_.step(faults_);
  }
  std::shared_ptr<ServoBus> bus_ = std::make_shared<ServoBus>(std::make_shared<FakeBus>(2));
  std::vector<ServoActuator> actuators_{{bus_, 0, {1000, 2, 1, 0}, 0, 3}, {bus_, 1, {1000, 2, -1, 0}, 0, 0}};
  TorqueWatch watch_{actuators_};
  RecordedFaults faults_;
};

TEST_F(WatchedTorques, ThreeCyclesOnEndBeyondTheBoundAreAFault) {
  cycle(-1510, 9000);
  cycle(-1510, 9000);
  cycle(-1490, 9000);
  cycle(-1510, 9000);
  cycle(-1510, 9000);
  EXPECT_THAT(faults_.raised, IsEmpty());
  cycle(-1510, 9000);
  EXPECT_THAT(faults_.raised, ElementsAre(is_fault(Kind::TorqueBound, Part::Actuator, 0, -3.02, 3)))
      << "in N·m of the drive; the second one is not watched";
}

TEST_F(WatchedTorques, CyclesWithoutPowerDoNotCount) {
  cycle(1600, 0);
  cycle(1600, 0);
  watch_.rest();
  cycle(1600, 0);
  EXPECT_THAT(faults_.raised, IsEmpty());
}

TEST(DeadlineWatch, MoreMissedWithinASecondThanAllowedIsAFault) {
  DeadlineWatch watch(3, 0.001);
  RecordedFaults faults;
  watch.step(2, true, faults);
  watch.step(1, true, faults);
  EXPECT_THAT(faults.raised, IsEmpty());
  watch.step(2, false, faults);
  EXPECT_THAT(faults.raised, IsEmpty()) << "nothing is driven";
  watch.step(0, true, faults);
  EXPECT_THAT(faults.raised, ElementsAre(is_fault(Kind::CyclesLost, Part::Clock, 0, 5, 3)));
}

TEST(DeadlineWatch, CountsSecondBySecond) {
  DeadlineWatch watch(3, 0.001);
  RecordedFaults faults;
  watch.step(3, true, faults);
  for (int i = 1; i < 1000; ++i) watch.step(0, true, faults);
  watch.step(3, true, faults);
  EXPECT_THAT(faults.raised, IsEmpty());
  watch.step(1, true, faults);
  EXPECT_EQ(faults.raised.size(), 1U);
}

TEST(DeadlineWatch, WithoutABoundWatchesNothing) {
  DeadlineWatch watch(0, 0.001);
  RecordedFaults faults;
  watch.step(1000, true, faults);
  EXPECT_THAT(faults.raised, IsEmpty());
}

}  // namespace
}  // namespace rmac::servo_test
