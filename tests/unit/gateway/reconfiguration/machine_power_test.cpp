// The test is the servo loop: it reads the wishes and reports what the drives did.
#include "gateway/reconfiguration/machine_power.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class MachinePowerTest : public testing::Test {
 protected:
  /// A cycle of a loop that does as it is wished after `delay_` cycles, unless a fault has it.
  void cycle() {
    const ServoWishes& wishes = link_.wishes.read();
    ++status_.progress.cycle;
    status_.t_s += 0.001;
    if (wishes.reset && !fault_stays_) status_.fault = {};
    const bool faulted = status_.fault.kind != ServoFault::Kind::None;
    delay_ -= delay_ > 0 ? 1 : 0;
    status_.follows = wishes.power && !faulted && delay_ == 0;
    status_.state = faulted           ? ServoState::Faulted
                    : status_.follows ? ServoState::Engaged
                    : wishes.power    ? ServoState::Enabling
                                      : ServoState::Off;
    wished_power_ = wishes.power;
    wished_reset_ = wished_reset_ || wishes.reset;
    wished_rpm_ = wishes.spindle_rpm[0];
    link_.status.write(status_);
  }

  ServoLink link_{1};
  MotionSupervisor supervisor_{{}, link_};
  ServoRequests servo_{link_, [this] { cycle(); }};
  MachinePower power_{supervisor_, servo_};
  ServoStatus status_;
  int delay_ = 5;
  bool fault_stays_ = false;
  bool wished_power_ = false, wished_reset_ = false;
  double wished_rpm_ = 0;
};

TEST_F(MachinePowerTest, IsOnWhenEveryJointIsHeld) {
  const auto on = power_.on(nullptr);
  ASSERT_TRUE(on) << on.error().message;
  EXPECT_TRUE(link_.status.read().follows);
  EXPECT_EQ(status_.progress.cycle, 5) << "no earlier";
}

TEST_F(MachinePowerTest, SaysWhatKeepsTheDrivesFromComingUp) {
  status_.fault = {ServoFault::Kind::DriveOffline, ServoFault::Part::Actuator, 2};
  const auto on = power_.on(nullptr);
  ASSERT_FALSE(on);
  EXPECT_THAT(on.error().message, HasSubstr("drive of actuator 2: the drive does not answer"));
}

TEST_F(MachinePowerTest, GoesOffWithTheSpindles) {
  supervisor_.wish([](ServoWishes& wishes) { wishes.spindle_rpm[0] = 500; });
  ASSERT_TRUE(power_.on(nullptr));
  ASSERT_EQ(wished_rpm_, 500);
  power_.off();
  EXPECT_EQ(link_.status.read().state, ServoState::Off);
  EXPECT_FALSE(wished_power_);
  EXPECT_EQ(wished_rpm_, 0);
}

TEST_F(MachinePowerTest, GivesADriveThatIsFaultedATenthOfASecondToHearOfIt) {
  status_.fault = {ServoFault::Kind::DriveFault, ServoFault::Part::Actuator, 0};
  cycle();
  power_.off();
  EXPECT_NEAR(link_.status.read().t_s, 0.102, 0.002);
}

TEST_F(MachinePowerTest, ClearsAFaultWhoseCauseIsGoneWithThePowerOff) {
  status_.fault = {ServoFault::Kind::DriveFault, ServoFault::Part::Actuator, 0};
  supervisor_.wish([](ServoWishes& wishes) { wishes.power = true; });
  cycle();
  const auto cleared = power_.clear_fault(nullptr);
  ASSERT_TRUE(cleared) << cleared.error().message;
  EXPECT_TRUE(wished_reset_);
  EXPECT_FALSE(wished_power_);
  cycle();
  EXPECT_FALSE(link_.wishes.read().reset) << "the next reset is to rise again";
}

TEST_F(MachinePowerTest, SaysWhichCauseIsStillThere) {
  fault_stays_ = true;
  status_.fault = {ServoFault::Kind::NotANumber, ServoFault::Part::Joint, 1};
  cycle();
  const auto cleared = power_.clear_fault(nullptr);
  ASSERT_FALSE(cleared);
  EXPECT_THAT(cleared.error().message, HasSubstr("the fault is still there: joint 1"));
  EXPECT_EQ(cleared.error().code, MinorCode::Other);
  status_.fault = {ServoFault::Kind::EmergencyStop, ServoFault::Part::Io, 0};
  EXPECT_EQ(power_.clear_fault(nullptr).error().code, MinorCode::EmergencyStop);
}

}  // namespace
}  // namespace rmac::gateway
