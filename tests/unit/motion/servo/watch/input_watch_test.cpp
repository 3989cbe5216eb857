#include "servo/watch/input_watch.hpp"

#include "unit/motion/servo/recorded_faults.hpp"

namespace rmac::servo_test {
namespace {

using Kind = ServoFault::Kind;
using testing::ElementsAre, testing::IsEmpty;

/// Input 1 is an emergency stop; inputs 4 and 5 are limit switches at the upper and lower end of joint 1.
class WatchedInputs : public testing::Test {
 protected:
  void step(std::uint64_t inputs, IndexSet homing = 0) {
    faults_.raised.clear();
    watch_.step(inputs, homing, faults_);
  }
  void hold_back(double velocity, IndexSet live = 0b10) {
    faults_.raised.clear();
    watch_.hold_back(live, std::array{0.0, velocity}, faults_);
  }
  static auto fault(Kind kind, std::uint32_t input) { return is_fault(kind, ServoFault::Part::Io, input, 0, 0); }
  ServoLoopParts parts_ = [] {
    ServoLoopParts made;
    made.emergency_stop_inputs = 1U << 1;
    made.limit_inputs = 3U << 4;
    made.limits = {{1U << 4, 1, 1}, {1U << 5, 1, -1}};
    return made;
  }();
  InputWatch watch_{parts_};
  RecordedFaults faults_;
};

TEST_F(WatchedInputs, EmergencyStopIsAFaultAsLongAsItIsPressed) {
  for (int i = 0; i < 2; ++i) {
    step(1U << 1);
    EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::EmergencyStop, 1)));
    EXPECT_TRUE(watch_.emergency_stop());
  }
  step(1U << 2);
  EXPECT_THAT(faults_.raised, IsEmpty());
  EXPECT_FALSE(watch_.emergency_stop());
  EXPECT_EQ(watch_.inputs(), 1U << 2);
}

TEST_F(WatchedInputs, LimitSwitchIsAFaultAsItComesOn) {
  step(1U << 5);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::LimitSwitch, 5)));
  step(1U << 5);
  EXPECT_THAT(faults_.raised, IsEmpty());
  step(0);
  step(1U << 5);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::LimitSwitch, 5)));
}

TEST_F(WatchedInputs, DriveThatLooksForHomeMayFindItInItsSwitch) {
  step(1U << 5, 0b10);
  EXPECT_THAT(faults_.raised, IsEmpty());
  step(0);
  step(1U << 5, 0b01);
  EXPECT_EQ(faults_.raised.size(), 1U) << "another joint homes";
}

TEST_F(WatchedInputs, JointOnItsSwitchGoesOffItAndNoFurther) {
  step(1U << 4);
  hold_back(-1);
  EXPECT_THAT(faults_.raised, IsEmpty());
  hold_back(1e-7);
  EXPECT_THAT(faults_.raised, IsEmpty()) << "rounding";
  hold_back(1);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::LimitSwitch, 4)));
  hold_back(1, 0b01);
  EXPECT_THAT(faults_.raised, IsEmpty()) << "it is not under control";
  step(1U << 5);
  hold_back(1);
  EXPECT_THAT(faults_.raised, IsEmpty());
  hold_back(-1);
  EXPECT_THAT(faults_.raised, ElementsAre(fault(Kind::LimitSwitch, 5)));
}

}  // namespace
}  // namespace rmac::servo_test
