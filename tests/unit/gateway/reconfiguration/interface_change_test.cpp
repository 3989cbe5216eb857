// A mill that goes over from one interface to another: two buses that the test can reach.
#include "gateway/reconfiguration/interface_change.hpp"

#include <gmock/gmock.h>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class InterfaceChangeTest : public testing::Test {
 protected:
  InterfaceChangeTest() : machine_(options()) {}
  ControllerOptions options() {
    ControllerOptions made = TestMachine::options();
    made.control_interfaces["OtherBus"] =
        [this](const std::string&, const sdk::ModuleChoice&,
               const ModuleLoader&) -> Expected<std::shared_ptr<DigitalControlInterface>> {
      if (!other_fails_.empty()) return failure(MinorCode::CommTimeout, other_fails_);
      other_ = std::make_shared<fieldbus::SimulatedInterface>(fieldbus::default_simulated_axes(), 0.001);
      if (offline_) other_->set_online(*offline_, false);
      return other_;
    };
    return made;
  }
  Expected<> choose(const std::string& interface) {
    sdk::RmacConfig& config = machine_.controller.config();
    return config.interfaces().set_control({interface, {}, {}}).and_then([&] { return config.apply(); });
  }
  [[nodiscard]] std::string interface() { return machine_.controller.mechanism()->digital_control_interface.name; }
  void expect_that_it_moves() {
    ASSERT_TRUE(machine_.controller.cam().path().set_feedrate(6000));
    const auto queued = machine_.line(1, machine_.controller.sample().pose_set.tip, {1, 1, 1});
    ASSERT_TRUE(queued) << queued.error().message;
    ASSERT_TRUE(machine_.controller.cam().cycle().start(sdk::CycleMode::Automatic));
    EXPECT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 1)) << machine_.last(Event::Kind::Fault);
  }

  std::shared_ptr<fieldbus::SimulatedInterface> other_;
  std::string other_fails_;
  std::optional<std::size_t> offline_;
  TestMachine machine_;
};

TEST_F(InterfaceChangeTest, BringsTheDrivesDownAndUpOverTheOther) {
  ASSERT_TRUE(machine_.load_at_zero(TestMachine::mill()));
  const auto changed = choose("OtherBus");
  ASSERT_TRUE(changed) << changed.error().message;
  EXPECT_EQ(interface(), "OtherBus");
  ASSERT_NE(other_, nullptr);
  EXPECT_EQ(machine_.bus.use_count(), 1) << "the test's: the appliance has let go of it";
  machine_.controller.dispatch();
  EXPECT_THAT(machine_.last(Event::Kind::Mechanism), HasSubstr("Mill is configured over OtherBus"));
  expect_that_it_moves();
}

TEST_F(InterfaceChangeTest, PutsTheMechanismBackOverTheOldOneWhenTheOtherDoesNotComeUp) {
  ASSERT_TRUE(machine_.load_at_zero(TestMachine::mill()));
  other_fails_ = "no card in slot 2";
  const auto refused = choose("OtherBus");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::CommTimeout);
  EXPECT_THAT(refused.error().message, HasSubstr("no card in slot 2; Mill is in force again over TestBus"));
  EXPECT_EQ(interface(), "TestBus");
  expect_that_it_moves();
}

TEST_F(InterfaceChangeTest, PutsTheMechanismBackWhenADriveOfTheOtherFails) {
  ASSERT_TRUE(machine_.load_at_zero(TestMachine::mill()));
  offline_ = 1;
  const auto refused = choose("OtherBus");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("Mill is in force again over TestBus"));
  EXPECT_EQ(machine_.controller.cycle_now().state, CycleState::Idle) << "the failed attempt's fault went with it";
  expect_that_it_moves();
}

TEST_F(InterfaceChangeTest, LeavesTheDrivesAloneWhenTheOtherIsNotThere) {
  ASSERT_TRUE(machine_.load_at_zero(TestMachine::mill()));
  EXPECT_THAT(choose("Gone").error().message, HasSubstr("no digital control interface \"Gone\""));
  expect_that_it_moves();
  for (const CycleSample& sample : machine_.samples) ASSERT_EQ(sample.statusword[0] & 0x6F, 0x27);
}

TEST_F(InterfaceChangeTest, IsNoneInVirtualMode) {
  machine_.controller.set_mechanism_folder("", true);
  ASSERT_TRUE(machine_.load_at_zero(TestMachine::mill()));
  other_fails_ = "nobody may ask";
  const auto changed = choose("OtherBus");
  ASSERT_TRUE(changed) << changed.error().message;
  EXPECT_EQ(interface(), "OtherBus");
}

}  // namespace
}  // namespace rmac::gateway
