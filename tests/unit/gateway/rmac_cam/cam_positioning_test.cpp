#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

/// Accelerations of a joint's setpoints while its speed rises and while it falls.
struct Accelerations {
  double rise = 0, fall = 0;
};

class Positioning : public testing::Test {
 protected:
  void SetUp() override {
    const auto loaded = machine_.load_at_zero(TestMachine::mill());
    ASSERT_TRUE(loaded) << loaded.error().message;
    machine_.samples.clear();
  }
  sdk::RmacCam& cam() { return machine_.controller.cam(); }
  void run_to_rest() {
    const int before = machine_.count(Event::Kind::Stopped);
    ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::Stopped) > before; }));
  }
  [[nodiscard]] Accelerations seen(std::size_t joint) const {
    Accelerations most;
    for (const CycleSample& sample : machine_.samples) {
      const double a = sample.acceleration_set[joint];
      double& peak = a * sample.velocity_set[joint] > 0 ? most.rise : most.fall;
      peak = std::max(peak, std::abs(a));
    }
    return most;
  }
  TestMachine machine_;
};

TEST_F(Positioning, JointAccelerationsShapeAJog) {
  ASSERT_TRUE(cam().joints().set_accel_rise(0, 300));
  ASSERT_TRUE(cam().joints().set_accel_fall(0, 600));
  ASSERT_TRUE(cam().positioning().jog_joint(0, 30));
  run_to_rest();
  EXPECT_NEAR(seen(0).rise, 300, 3);
  EXPECT_NEAR(seen(0).fall, 600, 6);
  EXPECT_NEAR(machine_.controller.sample().position_set[0], 30, 1e-6);
}

TEST_F(Positioning, TheJointWithLeastAccelerationLeadsAJointMove) {
  ASSERT_TRUE(cam().joints().set_accel_rise(1, 200));
  ASSERT_TRUE(cam().joints().set_accel_fall(1, 400));
  ASSERT_TRUE(cam().queue().add(1, JointTargetGeometry{{40, 20, 0}}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 1));
  EXPECT_NEAR(seen(1).rise, 200, 2);
  EXPECT_NEAR(seen(1).fall, 400, 4);
  EXPECT_NEAR(seen(0).rise, 400, 4);
}

TEST_F(Positioning, JointAccelerationsLeavePathMovesAlone) {
  ASSERT_TRUE(cam().joints().set_accel_rise(0, 100));
  ASSERT_TRUE(cam().path().set_feedrate(6000));
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {40, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 1));
  EXPECT_GT(seen(0).rise, 500);
}

TEST_F(Positioning, RefusesAJointAccelerationAboveTheLimit) {
  const auto above = cam().joints().set_accel_rise(0, 1e6);
  ASSERT_FALSE(above);
  EXPECT_EQ(above.error().code, MinorCode::AccelerationLimit) << above.error().message;
  EXPECT_FALSE(cam().joints().set_accel_fall(7, 10));
  EXPECT_FALSE(cam().joints().accel_rise(-1));
}

TEST_F(Positioning, TheReferencePointIsTheZeroOfThePartFrame) {
  ASSERT_TRUE(cam().frames().set_part({{5, -3, 2}, {1, 0, 0, 0}}));
  ASSERT_TRUE(cam().positioning().jog_joint(0, 20));
  run_to_rest();
  ASSERT_TRUE(cam().positioning().move_to_reference_point());
  run_to_rest();
  const CycleSample now = machine_.controller.sample();
  EXPECT_NEAR(now.position_set[0], 5, 1e-6);
  EXPECT_NEAR(now.position_set[1], -3, 1e-6);
  EXPECT_NEAR(now.position_set[2], 2, 1e-6);
}

}  // namespace
}  // namespace rmac::gateway
