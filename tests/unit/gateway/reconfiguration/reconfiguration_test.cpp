// Resetting, unloading and the way down.
#include "gateway/reconfiguration/reconfiguration.hpp"

#include <gmock/gmock.h>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class ReconfigurationTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(machine_.load_at_zero(TestMachine::mill())); }
  void start_line() {
    ASSERT_TRUE(cam().path().set_feedrate(600));
    ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {40, 0, 0}));
    ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
    ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.sample().position_set[0] > 1; }));
  }
  void fault() {
    machine_.bus->trip(1, 0x2310);
    ASSERT_TRUE(machine_.run_until_event(Event::Kind::Fault, 1));
  }
  sdk::RmacCam& cam() { return machine_.controller.cam(); }
  TestMachine machine_;
};

TEST_F(ReconfigurationTest, AResetDropsWhatWasPlannedAndEnablesTheDrivesWhereTheyStand) {
  start_line();
  fault();
  const auto reset = cam().cycle().reset();
  ASSERT_TRUE(reset) << reset.error().message;
  EXPECT_EQ(machine_.controller.cycle_now().state, CycleState::Idle);
  EXPECT_EQ(cam().queue().moves_left(), 0);
  const CycleSample now = machine_.controller.sample();
  EXPECT_EQ(now.servo_state, ServoState::Engaged);
  EXPECT_GT(now.position_set[0], 0.5) << "where the drives stand, a following error behind";
  ASSERT_TRUE(machine_.line(2, now.pose_set.tip, {0, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  EXPECT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 2));
}

TEST_F(ReconfigurationTest, AResetNeedsAFault) {
  const auto reset = cam().cycle().reset();
  ASSERT_FALSE(reset);
  EXPECT_EQ(reset.error().message, "reset: there is no fault to reset, the machine is Idle");
}

TEST_F(ReconfigurationTest, NoConfigurationGoesInWhileTheMachineIsFaulted) {
  start_line();
  fault();
  const auto refused = machine_.load(TestMachine::plane_mill());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("putting in a configuration: the machine is Faulted; remove the cause and reset first"));
}

TEST_F(ReconfigurationTest, AFaultedMechanismMayBeTakenOutAndOneInMotionMayNot) {
  start_line();
  const auto moving = machine_.controller.unload();
  ASSERT_FALSE(moving);
  EXPECT_THAT(moving.error().message, HasSubstr("unloading needs the machine at rest"));
  fault();
  const auto unloaded = machine_.controller.unload();
  ASSERT_TRUE(unloaded) << unloaded.error().message;
  machine_.controller.dispatch();
  EXPECT_EQ(machine_.last(Event::Kind::Mechanism), "Mill is unloaded");
}

TEST_F(ReconfigurationTest, ASpindleThatIsFasterThanItMayBeFromNowOnSlowsDown) {
  ASSERT_TRUE(cam().spindles().set_rpm(0, 900));
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.sample().spindle_rpm[0] > 890; }));
  ASSERT_TRUE(machine_.controller.config().spindles().set_maximum_rpm(0, 400));
  const auto applied = machine_.controller.config().apply();
  ASSERT_TRUE(applied) << applied.error().message;
  EXPECT_TRUE(machine_.run_until([&] { return std::abs(machine_.controller.sample().spindle_rpm[0] - 400) < 5; }));
}

}  // namespace
}  // namespace rmac::gateway
