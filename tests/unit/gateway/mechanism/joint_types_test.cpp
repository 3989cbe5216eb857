// Joints that are neither a slide nor a limited turn: screws, and those without an end.
#include <gmock/gmock.h>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

class JointTypes : public testing::Test {
 protected:
  void load(const std::function<void(sdk::DeviceObject&)>& change) {
    sdk::DeviceObject device = TestMachine::mill();
    change(device);
    const auto loaded = machine_.load_at_zero(device);
    ASSERT_TRUE(loaded) << loaded.error().message;
  }
  [[nodiscard]] bool jog(std::size_t joint, double distance) {
    const double there = machine_.controller.sample().position_set[joint] + distance;
    return machine_.controller.cam().positioning().jog_joint(static_cast<int>(joint), distance) &&
           machine_.run_until([&] {
             const CycleSample now = machine_.controller.sample();
             return !now.moving && std::abs(now.position_set[joint] - there) < 1e-6;
           });
  }
  TestMachine machine_;
};

TEST_F(JointTypes, ScrewCountsMillimetresAsASlideDoes) {
  load([](sdk::DeviceObject& device) { device.joints[2].limits.type = JointType::Screw; });
  const auto feed = machine_.controller.cam().path().set_feedrate(3000);
  ASSERT_TRUE(feed) << feed.error().message;
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {10, 0, -7}));
  ASSERT_TRUE(machine_.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 1)) << machine_.last(Event::Kind::Fault);
  EXPECT_NEAR(machine_.controller.sample().position_set[2], -7, 1e-6);
}

TEST_F(JointTypes, OneWithoutAnEndGoesOnThroughManyTimesWhatTravelItMightHaveHad) {
  load([](sdk::DeviceObject& device) { device.joints[0].limits.limit_type = JointLimitType::Infinite; });
  for (const double distance : {4321.0, -9000.0, 5000.0}) ASSERT_TRUE(jog(0, distance));
  EXPECT_NEAR(machine_.controller.sample().position[0], 321, 0.05);
}

TEST_F(JointTypes, OneEndIsKeptWhereTheOtherIsFree) {
  load([](sdk::DeviceObject& device) {
    device.joints[0].limits.limit_type = JointLimitType::InfinitePositive;
    device.joints[1].limits.limit_type = JointLimitType::InfiniteNegative;
  });
  EXPECT_TRUE(jog(0, 1000));
  EXPECT_TRUE(jog(1, -1000));
  const auto below = machine_.controller.cam().positioning().jog_joint(0, -1051);
  ASSERT_FALSE(below);
  EXPECT_THAT(below.error().message, testing::HasSubstr("X"));
  EXPECT_FALSE(machine_.controller.cam().positioning().jog_joint(1, 1051));
  EXPECT_TRUE(jog(0, -1049));
}

// A joint that was enabled some micrometres beside its place is jogged by its whole travel all the same.
TEST_F(JointTypes, AJogByTheWholeTravelEndsWhereThatEnds) {
  load([](sdk::DeviceObject&) {});
  const JointLimits limits = TestMachine::mill().joints[0].limits;
  for (const double end : {limits.max, limits.min}) {
    const double beyond = std::copysign(0.004, end);
    const double from = machine_.controller.sample().position_set[0];
    ASSERT_FALSE(machine_.controller.cam().positioning().jog_joint(0, end - from + 10 * beyond));
    ASSERT_TRUE(machine_.controller.cam().positioning().jog_joint(0, end - from + beyond));
    ASSERT_TRUE(machine_.run_until([&] {
      const CycleSample now = machine_.controller.sample();
      return !now.moving && now.position_set[0] == end;
    }));
    EXPECT_FALSE(machine_.controller.cam().positioning().jog_joint(0, beyond)) << "there is no way left";
  }
}

}  // namespace
}  // namespace rmac::gateway
