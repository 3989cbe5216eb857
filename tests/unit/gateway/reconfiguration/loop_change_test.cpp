// Servo laws and gains that are changed while the machine moves.
#include <gmock/gmock.h>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kMove = 3;

class ChangesLoops : public testing::Test {
 protected:
  void start_moving() {
    ASSERT_TRUE(machine_.load_at_zero(TestMachine::mill()));
    ASSERT_TRUE(cam().path().set_feedrate(60));  // so slow that it is under way for long, as fast as it is computed
    ASSERT_TRUE(machine_.line(kMove, {0, 0, 0}, {40, 20, 10}));
    ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
    ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.sample().position_set[0] > 1; }));
  }
  [[nodiscard]] sdk::RmacCam& cam() { return machine_.controller.cam(); }
  [[nodiscard]] sdk::RmacConfig& config() { return machine_.controller.config(); }
  [[nodiscard]] Expected<> gains(int joint, const std::vector<double>& values) {
    return config().loops().set_gains(joint, values).and_then([&] { return config().apply(); });
  }
  /// Joint X, on the average over the 300 cycles after `cycle`.
  [[nodiscard]] double following_error(std::int64_t cycle) {
    double sum = 0;
    for (const CycleSample& sample : machine_.samples) {
      if (sample.cycle > cycle && sample.cycle <= cycle + 300) sum += sample.position_set[0] - sample.position[0];
    }
    return sum / 300;
  }
  TestMachine machine_;
};

TEST_F(ChangesLoops, GainsActInMotionAndThePlanGoesOn) {
  start_moving();
  const std::int64_t before = machine_.controller.sample().cycle;
  const auto applied = gains(0, {600, 8});
  ASSERT_TRUE(applied) << applied.error().message;
  const std::int64_t after = machine_.controller.sample().cycle;
  EXPECT_TRUE(machine_.controller.sample().moving);
  EXPECT_THAT(machine_.controller.mechanism()->joints[0].gains, ElementsAre(600, 8));
  EXPECT_THAT(machine_.controller.mechanism()->joints[1].gains, ElementsAre(300, 4));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, kMove)) << machine_.last(Event::Kind::Fault);
  EXPECT_THAT(machine_.last(Event::Kind::Mechanism), HasSubstr("Mill is configured: servo loop of joint X"));
  EXPECT_NEAR(following_error(after + 100) / following_error(before - 300), 0.5, 0.1) << "twice as stiff a spring";
  for (std::size_t i = 1; i < machine_.samples.size(); ++i) {
    const CycleSample &last = machine_.samples[i - 1], &now = machine_.samples[i];
    ASSERT_EQ(now.cycle, last.cycle + 1) << "no cycle is lost";
    ASSERT_NEAR(now.position_set[0], 2 * now.position_set[1], 1e-9) << "cycle " << now.cycle;
    ASSERT_LE(std::abs(now.velocity_set[0] - last.velocity_set[0]), 1.01) << "as the limits have it";
  }
}

TEST_F(ChangesLoops, AnotherLawIsWhatTheMechanismHasFromThenOn) {
  start_moving();
  ASSERT_TRUE(config().loops().set_servo_law(1, {"TestLaw", {}, {}}));
  ASSERT_TRUE(gains(1, {500, 6}));
  const auto modules = machine_.controller.modules();
  const auto of_y = std::count_if(modules.begin(), modules.end(),
                                  [](const ModuleInUse& used) { return used.role == "servo control law of joint Y"; });
  EXPECT_EQ(of_y, 1);
  EXPECT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, kMove));
}

TEST_F(ChangesLoops, RefusedGainsChangeNothing) {
  start_moving();
  const auto refused = gains(0, {-1, 4});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, AllOf(HasSubstr("joint X"), HasSubstr("it takes 2: stiffness (N/mm)")));
  EXPECT_THAT(machine_.controller.mechanism()->joints[0].gains, ElementsAre(300, 4));
  ASSERT_TRUE(config().loops().set_servo_law(0, {"Gone", {}, {}}));
  EXPECT_THAT(config().apply().error().message, HasSubstr("there is no servo control law module Gone"));
  EXPECT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, kMove));
}

TEST_F(ChangesLoops, WithAnythingElseBesideItNeedsRest) {
  start_moving();
  ASSERT_TRUE(config().joints().set_maximum_speed(0, 50));
  const auto refused = gains(0, {600, 8});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("needs the machine at rest"));
  EXPECT_THAT(machine_.controller.mechanism()->joints[0].gains, ElementsAre(300, 4));
  EXPECT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, kMove));
}

TEST_F(ChangesLoops, VelocityAndPositionTakeTurnsInMotionAndThePlanGoesOn) {
  start_moving();
  for (const ControlMethod method : {ControlMethod::Velocity, ControlMethod::Position, ControlMethod::Velocity}) {
    ASSERT_TRUE(config().loops().set_control_method(1, method));
    const auto applied = config().apply();
    ASSERT_TRUE(applied) << applied.error().message;
    EXPECT_TRUE(machine_.controller.sample().moving);
    EXPECT_EQ(machine_.controller.mechanism()->joints[1].method, method);
    const std::int64_t cycle = machine_.controller.sample().cycle;
    ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.sample().cycle > cycle + 50; }));
  }
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, kMove)) << machine_.last(Event::Kind::Fault);
  for (const CycleSample& sample : machine_.samples) {
    ASSERT_NEAR(sample.position_set[0], 2 * sample.position_set[1], 1e-9) << "cycle " << sample.cycle;
  }
}

TEST_F(ChangesLoops, AJointThatSlippedIsGivenBackToPositionControlAtRestOnly) {
  start_moving();
  ASSERT_TRUE(config().loops().set_control_method(1, ControlMethod::Velocity));
  ASSERT_TRUE(config().apply());
  machine_.bus->freeze_encoder(1, true);  // to the loop the joint stands, whatever it does
  const auto behind = [&] {
    return machine_.controller.sample().position_set[0] / 2 - machine_.controller.sample().position[1];
  };
  ASSERT_TRUE(machine_.run_until([&] { return behind() > 2; })) << machine_.last(Event::Kind::Fault);
  ASSERT_TRUE(config().loops().set_control_method(1, ControlMethod::Position));
  const auto refused = config().apply();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("joint Y has slipped off the plan; change it with the machine at rest"));
  EXPECT_EQ(machine_.controller.mechanism()->joints[1].method, ControlMethod::Velocity);
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, kMove)) << machine_.last(Event::Kind::Fault);
  ASSERT_TRUE(machine_.run_until([&] { return !machine_.controller.sample().moving; }));
  const auto applied = config().apply();
  EXPECT_TRUE(applied) << applied.error().message;
}

TEST_F(ChangesLoops, ForceControlNeedsRest) {
  start_moving();
  ASSERT_TRUE(config().loops().set_control_method(2, ControlMethod::Force));
  EXPECT_FALSE(config().apply());
  EXPECT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, kMove));
}

TEST_F(ChangesLoops, IsRefusedWhileTheMachineIsFaulted) {
  start_moving();
  machine_.bus->trip(1, 0x2310);
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::Fault, kMove));
  const auto refused = gains(0, {600, 8});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("reset first"));
}

TEST_F(ChangesLoops, HeldJointsAreCountedBehindTheOthers) {
  ASSERT_TRUE(machine_.load_at_zero(TestMachine::mill()));
  ASSERT_TRUE(machine_.load(TestMachine::plane_mill()));
  ASSERT_TRUE(gains(2, {400, 5}));
  EXPECT_THAT(machine_.controller.mechanism()->held_joints[0].gains, ElementsAre(400, 5));
  EXPECT_EQ(machine_.controller.mechanism()->name, "PlaneMill");
}

}  // namespace
}  // namespace rmac::gateway
