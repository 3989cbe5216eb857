// What a machine does, and does not, whose joint has lost its reference.
#include <gmock/gmock.h>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class LostReference : public TestMachine, public testing::Test {
 protected:
  void SetUp() override {
    const auto loaded = load_at_zero(mill());
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_TRUE(controller.cam().cycle().start(sdk::CycleMode::Automatic)) << "it has its reference";
    ASSERT_TRUE(controller.cam().cycle().stop());
    ASSERT_TRUE(run_until([&] { return controller.sample().state == CycleState::Idle; }));
    bus->shift_encoder(1, 131072);
    ASSERT_TRUE(run_until([&] { return !last(Event::Kind::Fault).empty(); }));
    ASSERT_THAT(last(Event::Kind::Fault), HasSubstr("joint 1 (Y): its position jumped by 5"));
    ASSERT_TRUE(run_until([&] { return controller.sample().state == CycleState::Faulted; }));
    const auto left = controller.cam().cycle().reset();
    ASSERT_TRUE(left) << left.error().message;
  }
};

// Red when a reset makes a machine Idle and ready whose encoder jumped.
TEST_F(LostReference, KeepsTheCycleFromStartingAfterAReset) {
  const auto started = controller.cam().cycle().start(sdk::CycleMode::Automatic);
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, MinorCode::Scale);
  EXPECT_THAT(started.error().message, HasSubstr("CycleStart: joint 1 (Y) has lost its reference"));
}

TEST_F(LostReference, KeepsTheMachineFromGoingToPlacesByItself) {
  EXPECT_THAT(controller.cam().positioning().home().error().message, HasSubstr("Home: joint 1 (Y) has lost"));
  EXPECT_THAT(controller.cam().positioning().move_to_reference_point().error().message,
              HasSubstr("MoveToReferencePoint: joint 1 (Y) has lost"));
}

// Red when "joint 2" is told to a person whose machine has two: the third of the machine before, which is held now.
TEST(LostReferenceOfAHeldJoint, IsNamedAsWhatItIsAfterASwapToFewerJoints) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  machine.bus->shift_encoder(2, 131072);
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().state == CycleState::Faulted; }));
  ASSERT_TRUE(machine.controller.cam().cycle().reset());
  const auto loaded = machine.load(TestMachine::plane_mill());
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_THAT(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic).error().message,
              HasSubstr("held joint 2 (Z) has lost its reference"));
}

TEST_F(LostReference, LeavesJogs) {
  events.clear();
  const auto jogged = controller.cam().positioning().jog_joint(1, 2);
  ASSERT_TRUE(jogged) << jogged.error().message;
  ASSERT_TRUE(run_until_event(Event::Kind::Stopped));
  EXPECT_EQ(count(Event::Kind::Fault), 0) << last(Event::Kind::Fault);
}

TEST_F(LostReference, IsLeftByLoadingTheMachineAnew) {
  ASSERT_TRUE(controller.unload());
  const auto loaded = load(mill());
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_TRUE(controller.cam().cycle().start(sdk::CycleMode::Automatic));
}

}  // namespace
}  // namespace rmac::gateway
