#include "servo/state/loop_state.hpp"

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using Kind = ServoFault::Kind;
using Part = ServoFault::Part;

constexpr auto kKeep = StopCategory::StopKeepPower;
constexpr auto kRemove = StopCategory::StopThenRemovePower;

/// Joints 0 and 1 share two motors, joint 2 has one of its own. 10 cycles to enable or to reset.
class StateOfLoop : public testing::Test {
 protected:
  StateOfLoop() {
    parts_.actuator_map = std::make_shared<DifferentialMap>();
    parts_.joints.resize(3);
    for (std::uint32_t i = 0; i < 3; ++i) parts_.actuators.push_back({bus_, i, {}});
    parts_.enable_timeout_s = 0.0105;
    parts_.stop_categories = {kKeep, kKeep, kKeep, kKeep, kKeep, kKeep};
    make();
  }
  void make() {
    wiring_.emplace(*parts_.actuator_map, 3, parts_.actuators);
    state_.emplace(parts_, *wiring_);
  }
  void obey(bool braked = false) {
    state_->begin_cycle();
    state_->obey(command_, braked);
  }
  void engage() {
    command_.power = true;
    obey();
    state_->arrive(true);
    obey();
    state_->arrive(true);
    ASSERT_TRUE(state_->follows());
  }
  void raise(Kind kind, Part part = Part::Joint, std::uint32_t index = 0) { state_->raise({kind, part, index, 7, 3}); }

  std::shared_ptr<ServoBus> bus_ = std::make_shared<ServoBus>(std::make_shared<FakeBus>(3));
  ServoLoopParts parts_;
  std::optional<Wiring> wiring_;
  std::optional<LoopState> state_;
  ServoCommand command_;
};

TEST_F(StateOfLoop, IsOffUntilThereIsPower) {
  obey();
  EXPECT_EQ(state_->state(), ServoState::Off);
  EXPECT_FALSE(state_->powered());
  command_.power = true;
  obey();
  EXPECT_EQ(state_->state(), ServoState::Enabling);
  EXPECT_TRUE(state_->driving());
}

TEST_F(StateOfLoop, EngagesWhenAllAreLiveAndFollowsFromTheCycleAfter) {
  command_.power = true;
  obey();
  state_->arrive(false);
  EXPECT_EQ(state_->state(), ServoState::Enabling);
  state_->arrive(true);
  EXPECT_EQ(state_->state(), ServoState::Engaged);
  EXPECT_FALSE(state_->follows());
  obey();
  EXPECT_FALSE(state_->follows());
  state_->arrive(true);
  EXPECT_TRUE(state_->follows());
}

TEST_F(StateOfLoop, EnablingTakesSoLongAndNoLonger) {
  command_.power = true;
  obey();
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(state_->enables_too_long()) << i;
  EXPECT_TRUE(state_->enables_too_long());
  engage();
  EXPECT_FALSE(state_->enables_too_long());
}

TEST_F(StateOfLoop, QuickStopStaysUntilItAndPowerAreTakenBack) {
  engage();
  command_.quick_stop = true;
  obey();
  EXPECT_EQ(state_->state(), ServoState::QuickStop);
  EXPECT_FALSE(state_->powered());
  command_.quick_stop = false;
  obey();
  EXPECT_EQ(state_->state(), ServoState::QuickStop) << "power has not fallen";
  command_.power = false;
  obey();
  EXPECT_EQ(state_->state(), ServoState::Off);
  command_.power = true;
  obey();
  EXPECT_EQ(state_->state(), ServoState::Enabling);
}

TEST_F(StateOfLoop, WithoutPowerIsOff) {
  engage();
  command_.power = false;
  obey();
  EXPECT_EQ(state_->state(), ServoState::Off);
}

TEST_F(StateOfLoop, HomesOnTheRiseOfTheWishWhileEngaged) {
  command_.home = true;
  command_.power = true;
  obey();
  EXPECT_EQ(state_->state(), ServoState::Enabling);
  state_->arrive(true);
  obey();
  EXPECT_EQ(state_->state(), ServoState::Engaged) << "it rose before";
  command_.home = false;
  obey();
  command_.home = true;
  obey();
  EXPECT_EQ(state_->state(), ServoState::Homing);
  EXPECT_TRUE(state_->driving());
  state_->homing_is_over();
  EXPECT_EQ(state_->state(), ServoState::Enabling);
}

TEST_F(StateOfLoop, VirtualModeEngagesInTheCycleAfterAndNeverHomes) {
  parts_.virtual_mode = true;
  make();
  command_.power = true;
  obey();
  obey();
  EXPECT_EQ(state_->state(), ServoState::Enabling);
  obey();
  EXPECT_EQ(state_->state(), ServoState::Engaged);
  state_->arrive_without_drives();
  EXPECT_TRUE(state_->follows());
  command_.home = true;
  obey();
  EXPECT_EQ(state_->state(), ServoState::Engaged);
}

TEST_F(StateOfLoop, FirstFaultStaysWithWhatItTells) {
  engage();
  raise(Kind::FollowingError, Part::Joint, 2);
  raise(Kind::BusFailure, Part::Bus, 1);
  EXPECT_EQ(state_->state(), ServoState::Faulted);
  EXPECT_EQ(state_->fault().kind, Kind::FollowingError);
  EXPECT_EQ(state_->fault().index, 2U);
  EXPECT_EQ(state_->fault().value, 7);
  EXPECT_EQ(state_->fault().bound, 3);
  EXPECT_EQ(state_->fault().stop, kRemove);
  EXPECT_FALSE(state_->follows());
  EXPECT_FALSE(state_->powered());
}

TEST_F(StateOfLoop, EmergencyStopIsToldWhateverElseIsWrongAndOnlyOnce) {
  engage();
  raise(Kind::FollowingError);
  EXPECT_TRUE(state_->take_new_stop());
  EXPECT_FALSE(state_->take_new_stop());
  raise(Kind::EmergencyStop, Part::Io, 5);
  EXPECT_EQ(state_->fault().kind, Kind::EmergencyStop);
  EXPECT_TRUE(state_->take_new_stop());
  raise(Kind::EmergencyStop, Part::Io, 6);
  EXPECT_EQ(state_->fault().index, 5U);
  EXPECT_FALSE(state_->take_new_stop());
}

struct Choice {
  const char* name;
  ServoFault fault;
  StopCategory StopCategories::*category;  ///< null: there is no choice
};

class StopByCategory : public StateOfLoop, public testing::WithParamInterface<Choice> {};

TEST_P(StopByCategory, IsAsChosenWhereThereIsAChoice) {
  for (const StopCategory chosen : {kKeep, kRemove}) {
    const StopCategory others = chosen == kKeep ? kRemove : kKeep;
    parts_.stop_categories = {others, others, others, others, others, others};
    if (GetParam().category != nullptr) parts_.stop_categories.*GetParam().category = chosen;
    make();
    engage();
    state_->raise(GetParam().fault);
    EXPECT_EQ(state_->fault().stop, GetParam().category != nullptr ? chosen : kRemove);
    EXPECT_EQ(state_->braking(), state_->fault().stop == kKeep);
    EXPECT_EQ(state_->powered(), state_->braking());
    EXPECT_FALSE(state_->driving());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, StopByCategory,
    testing::Values(Choice{"SensorOfAJoint", {Kind::SensorLost, Part::Joint, 0}, &StopCategories::sensor_lost},
                    Choice{"EncoderOfADrive", {Kind::SensorLost, Part::Actuator, 2}, nullptr},
                    Choice{"Force", {Kind::ForceLimit, Part::Joint, 0}, &StopCategories::force_limit},
                    Choice{"Contact", {Kind::ContactLost, Part::Joint, 0}, &StopCategories::contact_lost},
                    Choice{"Cycles", {Kind::CyclesLost, Part::Clock, 0}, &StopCategories::cycles_lost},
                    Choice{"SilentSpindle", {Kind::DriveOffline, Part::Spindle, 0}, &StopCategories::drive_silent},
                    Choice{"SilentDriveAlone", {Kind::DriveOffline, Part::Actuator, 2}, &StopCategories::drive_silent},
                    Choice{"SilentDriveShared", {Kind::DriveOffline, Part::Actuator, 1}, nullptr},
                    Choice{"SpindleOverload", {Kind::TorqueBound, Part::Spindle, 0}, &StopCategories::spindle_overload},
                    Choice{"TorqueOfAJoint", {Kind::TorqueBound, Part::Actuator, 0}, nullptr},
                    Choice{"FollowingError", {Kind::FollowingError, Part::Joint, 0}, nullptr},
                    Choice{"EmergencyStop", {Kind::EmergencyStop, Part::Io, 0}, nullptr}),
    [](const auto& choice) { return choice.param.name; });

TEST_F(StateOfLoop, PowerIsKeptOnlyOfAMachineThatWasEngaged) {
  command_.power = true;
  obey();
  raise(Kind::ContactLost);
  EXPECT_EQ(state_->fault().stop, kRemove);
  EXPECT_FALSE(state_->braking());
}

TEST_F(StateOfLoop, WhatElseGoesWrongWhileBrakingRemovesThePower) {
  for (const ServoFault& more :
       {ServoFault{Kind::FollowingError, Part::Joint, 1}, ServoFault{Kind::DriveOffline, Part::Actuator, 2},
        ServoFault{Kind::SensorLost, Part::Actuator, 2}, ServoFault{Kind::TorqueBound, Part::Actuator, 2},
        ServoFault{Kind::LimitSwitch, Part::Io, 3}}) {
    make();
    engage();
    raise(Kind::ContactLost);
    ASSERT_TRUE(state_->braking());
    (void)state_->take_new_stop();
    state_->raise(more);
    EXPECT_FALSE(state_->braking()) << to_string(more.kind);
    EXPECT_EQ(state_->fault().kind, Kind::ContactLost);
    EXPECT_EQ(state_->fault().stop, kRemove);
    EXPECT_FALSE(state_->take_new_stop()) << "it is the same stop";
  }
}

TEST_F(StateOfLoop, WhatKeepsPowerItselfDoesNotEndBraking) {
  for (const ServoFault& more :
       {ServoFault{Kind::SensorLost, Part::Joint, 1}, ServoFault{Kind::ForceLimit}, ServoFault{Kind::ContactLost},
        ServoFault{Kind::CyclesLost, Part::Clock}, ServoFault{Kind::TorqueBound, Part::Spindle}}) {
    make();
    engage();
    raise(Kind::DriveOffline, Part::Spindle);
    state_->raise(more);
    EXPECT_TRUE(state_->braking()) << to_string(more.kind);
  }
}

TEST_F(StateOfLoop, SilentDriveIsGivenUpWhileTheOthersBrake) {
  engage();
  raise(Kind::DriveOffline, Part::Actuator, 2);
  EXPECT_TRUE(state_->given_up(Part::Actuator, 2));
  EXPECT_FALSE(state_->given_up(Part::Actuator, 1));
  EXPECT_FALSE(state_->given_up(Part::Spindle, 2));
  EXPECT_EQ(state_->actuator_given_up(), 2U);
  raise(Kind::FollowingError);
  EXPECT_FALSE(state_->given_up(Part::Actuator, 2));
  EXPECT_EQ(state_->actuator_given_up(), std::nullopt);
}

TEST_F(StateOfLoop, PowerThatFallsEndsAStopThatKeptItOnceTheMachineStands) {
  engage();
  raise(Kind::ContactLost);
  command_.power = false;
  obey(false);
  EXPECT_TRUE(state_->braking());
  obey(true);
  EXPECT_FALSE(state_->braking());
  EXPECT_EQ(state_->state(), ServoState::Faulted);
}

TEST_F(StateOfLoop, FaultIsLeftByAResetOnceTheMachineStandsAndNothingAsksForAStop) {
  engage();
  raise(Kind::FollowingError);
  command_.reset = true;
  obey();
  EXPECT_TRUE(state_->resetting());
  state_->finish_reset(false, true);
  EXPECT_EQ(state_->state(), ServoState::Faulted);
  state_->finish_reset(true, false);
  EXPECT_EQ(state_->state(), ServoState::Faulted);
  state_->finish_reset(true, true);
  EXPECT_EQ(state_->state(), ServoState::Off);
  EXPECT_EQ(state_->fault().kind, Kind::None);
  EXPECT_FALSE(state_->resetting());
  obey();
  EXPECT_EQ(state_->state(), ServoState::Off) << "power must fall first";
  command_.power = false;
  obey();
  command_.power = true;
  obey();
  EXPECT_EQ(state_->state(), ServoState::Enabling);
}

TEST_F(StateOfLoop, ResetGivesUpAfterAWhileAndIsAskedForAnew) {
  raise(Kind::DriveFault, Part::Actuator);
  command_.reset = true;
  obey();
  for (int i = 0; i < 10; ++i) state_->finish_reset(true, false);
  EXPECT_TRUE(state_->resetting());
  state_->finish_reset(true, false);
  EXPECT_FALSE(state_->resetting());
  obey();
  EXPECT_FALSE(state_->resetting()) << "it was not asked for again";
  command_.reset = false;
  obey();
  command_.reset = true;
  obey();
  EXPECT_TRUE(state_->resetting());
}

TEST_F(StateOfLoop, NothingIsEnabledWhileDrivesAreReset) {
  command_.reset = true;
  command_.power = true;
  obey();
  EXPECT_EQ(state_->state(), ServoState::Off);
  state_->finish_reset(true, true);
  obey();
  EXPECT_EQ(state_->state(), ServoState::Enabling);
}

TEST_F(StateOfLoop, JointsThatWereHandedOverAreEnablingAtOnce) {
  state_->take_over();
  EXPECT_EQ(state_->state(), ServoState::Enabling);
}

}  // namespace
}  // namespace rmac::servo_test
