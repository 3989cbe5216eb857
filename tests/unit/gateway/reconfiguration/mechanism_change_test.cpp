#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>
#include <thread>

#include "unit/gateway/device_driver_manager/fixtures.hpp"
#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

/// Each case breaks one step of putting a mechanism in.
struct Defect {
  const char* name;
  void (*make)(sdk::DeviceObject& device);
  const char* message;
};

void PrintTo(const Defect& defect, std::ostream* out) {
  *out << defect.name;
}

/// A drive of it is in fault when the bus comes up, and does not leave it where the cause stays.
class BusWithAFault final : public fieldbus::SimulatedInterface {
 public:
  BusWithAFault(std::uint16_t error_code, bool stays)
      : SimulatedInterface(fieldbus::default_simulated_axes(), 0.001), error_code_(error_code), stays_(stays) {
    trip(1, error_code);
  }
  [[nodiscard]] bool receive(std::span<DriveFeedback> feedback) noexcept override {
    if (stays_) trip(1, error_code_);
    return SimulatedInterface::receive(feedback);
  }

 private:
  std::uint16_t error_code_;
  bool stays_;
};

constexpr std::uint16_t kMasterDied = 0x8130, kEncoder = 0x7305;

class FaultBeforeTheLoad : public testing::TestWithParam<std::tuple<std::uint16_t, bool>> {
 protected:
  static ControllerOptions options() {
    ControllerOptions made = TestMachine::options();
    made.control_interfaces["BusWithAFault"] =
        [](const std::string&, const sdk::ModuleChoice&,
           const ModuleLoader&) -> Expected<std::shared_ptr<DigitalControlInterface>> {
      return std::make_shared<BusWithAFault>(std::get<0>(GetParam()), std::get<1>(GetParam()));
    };
    return made;
  }
  TestMachine machine_{options()};
};

// As after the death of a master: most drives keep their fault until a controlword resets it, whatever NMT says.
TEST_P(FaultBeforeTheLoad, IsResetOnceAndRefusesTheMachineWhereItStays) {
  sdk::DeviceObject mill = TestMachine::mill();
  mill.digital_control_interface = {"BusWithAFault", {}, {}};
  const auto loaded = machine_.load(mill);
  const auto [error_code, stays] = GetParam();
  const std::string code = fmt::format("{:04X}h", error_code);
  EXPECT_EQ(loaded.has_value(), !stays);
  if (stays) {
    EXPECT_THAT(loaded.error().message, HasSubstr(code));
    EXPECT_EQ(machine_.controller.mechanism(), nullptr);
  } else {
    EXPECT_EQ(machine_.controller.sample().servo_state, ServoState::Engaged);
  }
  EXPECT_NE(machine_.controller.cycle_now().state, CycleState::Faulted);
  machine_.controller.dispatch();
  EXPECT_THAT(machine_.last(Event::Kind::Fault), HasSubstr(code)) << "it is told";
}

INSTANTIATE_TEST_SUITE_P(Causes, FaultBeforeTheLoad,
                         testing::Combine(testing::Values(kMasterDied, kEncoder), testing::Bool()));

TEST(MechanismChange, MayBeStoppedMeanwhileFromAnotherThread) {
  // As the gateway does while the thread beside it changes the mechanism. No stop leaves anything behind.
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  std::atomic<bool> changing = true;
  std::thread gateway([&] {
    int turn = 0;
    do {
      const auto stopped =
          turn % 2 == 0 ? machine.controller.cam().cycle().stop_now() : machine.controller.cam().cycle().stop();
      EXPECT_TRUE(stopped);
      (void)machine.controller.sample();
      (void)machine.controller.cycle_now();
      (void)machine.controller.cam().cycle().started();
      (void)machine.controller.cam().queue().moves_left();
      ++turn;
    } while (changing);
  });
  for (int i = 0; i < 6; ++i) {
    const auto loaded = machine.load(i % 2 == 0 ? TestMachine::plane_mill() : TestMachine::mill());
    // A stop that has not come to rest when the change begins is a reason to refuse it, and the only one.
    if (!loaded) {
      EXPECT_THAT(loaded.error().message, HasSubstr("machine at rest"));
    }
  }
  changing = false;
  gateway.join();
  const auto loaded = machine.load(TestMachine::mill());
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(6000));
  ASSERT_TRUE(machine.controller.cam().cycle().set_feed_override(0));
  ASSERT_TRUE(machine.line(1, {0, 0, 0}, {1, 0, 0}));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.controller.cam().cycle().stop());
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.cycle_now().state == CycleState::Idle; }));
  EXPECT_EQ(machine.controller.cam().queue().moves_left(), 1) << "an earlier stop's order to clear is still in force";
}

class FailedChange : public testing::TestWithParam<Defect> {};

TEST_P(FailedChange, LeavesTheOldMechanismInForce) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  const std::int64_t before = machine.controller.sample().cycle;
  sdk::DeviceObject broken = TestMachine::plane_mill();
  GetParam().make(broken);
  const auto refused = machine.load(broken);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr(GetParam().message));

  ASSERT_NE(machine.controller.mechanism(), nullptr);
  EXPECT_EQ(machine.controller.mechanism()->name, "Mill");
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(6000));
  const auto queued = machine.line(1, {0, 0, 0}, {1, 1, 1});
  ASSERT_TRUE(queued) << queued.error().message;
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until_event(Event::Kind::MoveDone, 1));
  for (const CycleSample& sample : machine.samples) {
    if (sample.cycle <= before) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(sample.statusword[i] & 0x6F, 0x27)
          << "drive " << i << " left Operation Enabled in cycle " << sample.cycle;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Steps, FailedChange,
    testing::Values(
        Defect{"Kinematics", [](sdk::DeviceObject& d) { d.kinematics.name = "Gone"; },
               "there is no kinematics module Gone"},
        Defect{"KinematicsOfAnotherMachine", [](sdk::DeviceObject& d) { d.kinematics.name = "TestKinematics3"; },
               "TestKinematics3 has 3 joints, but 2 are configured"},
        Defect{"ActuatorMap", [](sdk::DeviceObject& d) { d.actuator_map.name = "Gone"; },
               "there is no actuator map module Gone"},
        Defect{"ActuatorMapOfAnotherSize", [](sdk::DeviceObject& d) { d.actuator_map.numbers["joints"] = {2}; },
               "TestMap maps 2 joints to 2 actuators"},
        Defect{"MapParameters", [](sdk::DeviceObject& d) { d.actuator_map.numbers.clear(); },
               "joints must be 1 or more"},
        Defect{"Law", [](sdk::DeviceObject& d) { d.joints[1].servo_law.name = "Gone"; },
               "there is no servo control law module Gone"},
        Defect{"LawOfAppendixIV", [](sdk::DeviceObject& d) { d.joints[1].servo_law.name = "DMAC_FUZZY_CONTROL"; },
               "there is no servo control law module FuzzyServoControlLaw"},
        Defect{"Gains",
               [](sdk::DeviceObject& d) {
                 d.joints[0].gains = {1, 2, 3};
               },
               "it takes 2: stiffness (N/mm), damping (N·s/mm)"},
        Defect{"Limits", [](sdk::DeviceObject& d) { d.joints[0].limits.min = 60; },
               "the minimum limit 60 must be below the maximum limit 50"},
        Defect{"Mechanics", [](sdk::DeviceObject& d) { d.joints[1].mechanics.backlash = -1; },
               "joint 1: a backlash must be 0 to 10"},
        Defect{"Jerk", [](sdk::DeviceObject& d) { d.held_joints[0].limits.max_jerk = 0; },
               "SetMechanismJointMaximumJerk is 0"},
        Defect{"ForceControl", [](sdk::DeviceObject& d) { d.joints[0].method = ControlMethod::Force; },
               "which needs an approach speed"},
        Defect{"AxisTakenTwice", [](sdk::DeviceObject& d) { d.actuators[2].axis = 0; },
               "axis 0 of bus test is taken already"},
        Defect{"AxisThatIsNotThere", [](sdk::DeviceObject& d) { d.actuators[2].axis = 40; },
               "has no axis 40; it has 8"},
        Defect{"Interface", [](sdk::DeviceObject& d) { d.digital_control_interface.name = "Gone"; },
               "no digital control interface \"Gone\""},
        Defect{"IoInterface", [](sdk::DeviceObject& d) { d.digital_io_interface.name = "Gone"; },
               "no digital I/O interface \"Gone\""},
        Defect{"IoBit", [](sdk::DeviceObject& d) { d.outputs["Coolant"] = 64; }, "bit 64 must be 0 to 63"}),
    [](const testing::TestParamInfo<Defect>& defect) { return std::string(defect.param.name); });

TEST(MechanismChange, TakesWhatTheMechanicsOfAJointDoWrong) {
  // The drives stay where they are: the joint stands elsewhere than thought.
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  sdk::DeviceObject measured = TestMachine::mill();
  measured.joints[0].mechanics.pitch = {0, 1, {0.5}};
  const auto loaded = machine.load(measured);
  ASSERT_TRUE(loaded) << loaded.error().message;
  const CycleSample now = machine.controller.sample();
  EXPECT_NEAR(now.position[0], 0.5, 0.01);
  EXPECT_NEAR(now.position_set[0], 0.5, 0.01);
  EXPECT_NEAR(now.position[1], 0, 0.01);
}

TEST(MechanismChange, TakesABusOverForAnotherInterface) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  sdk::DeviceObject other = TestMachine::mill();
  other.name = "Other";
  other.digital_control_interface.name = "SimulatedInterface";
  const auto loaded = machine.load(other);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(machine.controller.mechanism()->name, "Other");
  EXPECT_EQ(machine.controller.cycle_now().state, CycleState::Idle);
  ASSERT_TRUE(machine.load(TestMachine::mill())) << "and back";
}

TEST(MechanismChange, IsPutBackWhereTheOtherInterfaceCannotCarryTheOther) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  sdk::DeviceObject other = TestMachine::mill();
  other.name = "Other";
  other.digital_control_interface.name = "SimulatedInterface";
  other.actuators[0].axis = 40;
  const auto refused = machine.load(other);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("has no axis 40"));
  ASSERT_NE(machine.controller.mechanism(), nullptr);
  EXPECT_EQ(machine.controller.mechanism()->name, "Mill");
  EXPECT_EQ(machine.controller.cycle_now().state, CycleState::Idle);
  EXPECT_EQ(machine.controller.sample().statusword[0] & 0x6F, 0x27) << "its drives hold it";
}

TEST(MechanismChange, FailsWhenTheBusDoesNotComeUp) {
  TestMachine machine;
  machine.bus_trouble = "node 3 does not answer";
  const auto refused = machine.load(TestMachine::mill());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "bus test did not come up: node 3 does not answer");
  EXPECT_EQ(machine.controller.mechanism(), nullptr);
}

TEST(MechanismChange, PutsTheOldMechanismBackWhenADriveOfTheNewOneFails) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  sdk::DeviceObject wider = TestMachine::plane_mill();
  wider.actuators[2].axis = 5;
  machine.bus->set_online(5, false);
  const auto refused = machine.load(wider);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("axis 5"));
  EXPECT_THAT(refused.error().message, HasSubstr("Mill is in force again"));
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(6000));
  const auto queued = machine.line(1, machine.controller.sample().pose_set.tip, {1, 1, 1});
  ASSERT_TRUE(queued) << queued.error().message;
  const auto started = machine.controller.cam().cycle().start(sdk::CycleMode::Automatic);
  ASSERT_TRUE(started) << started.error().message;
  EXPECT_TRUE(machine.run_until_event(Event::Kind::MoveDone, 1));
}

TEST(MechanismChange, TakesAFirstMechanismOutAgainWhenADriveOfItFails) {
  TestMachine machine;
  ASSERT_TRUE(machine.load(TestMachine::mill()));
  ASSERT_TRUE(machine.controller.unload());
  machine.bus->set_online(1, false);
  const auto refused = machine.load(TestMachine::mill());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("axis 1"));
  EXPECT_EQ(machine.controller.mechanism(), nullptr);
  EXPECT_EQ(machine.controller.cycle_now().state, CycleState::Idle) << "nothing is in force that could be at fault";
  machine.bus->set_online(1, true);
  const auto loaded = machine.load(TestMachine::mill());
  EXPECT_TRUE(loaded) << loaded.error().message;
}

TEST(MechanismChange, KeepsSharedDrivesOperationalAndHoldsTheThird) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(6000));
  ASSERT_TRUE(machine.line(1, {0, 0, 0}, {3, 4, -7}));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until_event(Event::Kind::MoveDone, 1));
  const std::int64_t before = machine.samples.back().cycle;
  const double z_before = machine.samples.back().position[2];

  const auto loaded = machine.load(TestMachine::plane_mill());
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(machine.controller.mechanism()->name, "PlaneMill");
  ASSERT_TRUE(machine.run_until([&] {
    const CycleSample& now = machine.samples.back();
    return now.joint_count == 2 && now.state == CycleState::Idle;  // another mechanism does not move until told
  }));
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(6000));
  EXPECT_FALSE(machine.line(2, {3, 4, 0}, {0, 0, 1})) << "off the plane";
  ASSERT_TRUE(machine.line(2, {3, 4, 0}, {0, 0, 0}));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until_event(Event::Kind::MoveDone, 2));

  for (const CycleSample& sample : machine.samples) {
    if (sample.cycle <= before) continue;
    ASSERT_EQ(sample.joint_count_with_held, 3U);
    for (std::size_t i = 0; i < 3; ++i) ASSERT_EQ(sample.statusword[i] & 0x6F, 0x27) << "cycle " << sample.cycle;
    ASSERT_NEAR(sample.position_set[2], -7, 1e-6);
    ASSERT_NEAR(sample.position[2], z_before, 0.01);
    ASSERT_LT(std::abs(sample.position_set[0] - sample.position[0]), 1.0);
  }
  EXPECT_EQ(machine.samples.back().cycle - machine.samples.front().cycle + 1,
            static_cast<std::int64_t>(machine.samples.size()))
      << "a cycle was missed";
}

TEST(MechanismChange, IsRefusedWhileTheMachineMoves) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  // So slow that it is not at its end before it was asked: unheard the machine runs 4096 cycles ahead at most.
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(120));
  ASSERT_TRUE(machine.line(1, {0, 0, 0}, {40, 0, 0}));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().moving; }));
  const auto refused = machine.load(TestMachine::plane_mill());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("needs the machine at rest"));
  EXPECT_TRUE(machine.run_until_event(Event::Kind::MoveDone, 1));
}

// Red when the frames of before are not put back: the tool that stays in the spindle brings frames without a part.
TEST(MechanismChange, KeepsThePartFrameInAnotherRoleWithAToolInTheSpindle) {
  const test::TemporaryFolder tables;
  ControllerOptions options = TestMachine::options();
  options.tools_folder = tables.path();
  TestMachine machine(options);
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  sdk::RmacCam& cam = machine.controller.cam();
  ToolPort& tools = machine.controller.tools();
  ASSERT_TRUE(tools.set_tool({.number = 3, .length_mm = 20}));
  ASSERT_TRUE(tools.change_tool(3));
  ASSERT_TRUE(cam.cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until([&] { return !tools.tools_now().prompt.empty(); }));
  ASSERT_TRUE(tools.confirm_tool(3));
  ASSERT_TRUE(machine.run_until([&] { return tools.tools_now().mounted == 3; }));
  ASSERT_TRUE(cam.cycle().stop());
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.cycle_now().state == CycleState::Idle; }));
  Frame part;
  part.p = {1, 2, 0};
  ASSERT_TRUE(cam.frames().set_part(part));

  sdk::DeviceObject measurer = TestMachine::mill();
  measurer.name = "Measurer";
  measurer.overlay = true;
  measurer.overlay_of = "Mill";
  const auto loaded = machine.load(measurer);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(tools.tools_now().mounted, 3);
  EXPECT_EQ(cam.frames().part().p, part.p);
}

TEST(MechanismChange, ALimitActsOnMotionOnceApplied) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  sdk::RmacConfig& config = machine.controller.config();
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(6000));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(config.joints().set_maximum_speed(0, 25));
  const auto applied = config.apply();
  ASSERT_TRUE(applied) << applied.error().message;
  ASSERT_TRUE(machine.line(1, {0, 0, 0}, {20, 0, 0}));
  ASSERT_TRUE(machine.run_until_event(Event::Kind::MoveDone, 1)) << "the cycle was running, and still is";
  EXPECT_NEAR(machine.peak_velocity(0), 25, 0.1);
}

TEST(MechanismChange, AVirtualMechanismLeavesTheBusAlone) {
  TestMachine machine;
  machine.controller.set_mechanism_folder("", true);
  const auto loaded = machine.load_at_zero(TestMachine::mill());
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_TRUE(machine.controller.cam().path().set_feedrate(6000));
  ASSERT_TRUE(machine.line(1, {0, 0, 0}, {20, 0, 0}));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until_event(Event::Kind::MoveDone, 1));
  for (const CycleSample& sample : machine.samples) EXPECT_EQ(sample.position[0], sample.position_set[0]);
  EXPECT_EQ(machine.bus, nullptr) << "a virtual machine has a bus behind it";
}

TEST(MechanismChange, AVirtualMechanismStandsWhereTheOneBeforeItStood) {
  TestMachine machine;
  machine.controller.set_mechanism_folder("", true);
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  ASSERT_TRUE(machine.controller.cam().positioning().jog_joint(1, 12));
  ASSERT_TRUE(machine.run_until([&] { return machine.count(Event::Kind::Stopped) > 0; }));
  ASSERT_TRUE(machine.controller.config().joints().set_maximum_speed(0, 25));
  const auto applied = machine.controller.config().apply();
  ASSERT_TRUE(applied) << applied.error().message;
  EXPECT_NEAR(machine.controller.sample().position_set[1], 12, 1e-9) << "after a change of its own limits";
  const auto loaded = machine.load(TestMachine::plane_mill());
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_NEAR(machine.controller.sample().position_set[1], 12, 1e-9) << "under another mechanism on the same drives";
}

TEST(MechanismChange, UnloadingDisablesTheDrives) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  ASSERT_TRUE(machine.controller.unload());
  EXPECT_EQ(machine.controller.mechanism(), nullptr);
  machine.controller.dispatch();
  EXPECT_EQ(machine.samples.back().joint_count_with_held, 0U);
  EXPECT_FALSE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  const auto again = machine.load_at_zero(TestMachine::mill());
  EXPECT_TRUE(again) << again.error().message;
}

}  // namespace
}  // namespace rmac::gateway
