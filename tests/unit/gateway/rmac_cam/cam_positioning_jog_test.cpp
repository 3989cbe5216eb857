// Jogs by velocity, and jogs along the path: RMAC_CAM's JogJoint and JogPath.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class Jog : public testing::Test {
 protected:
  void SetUp() override {
    const auto loaded = machine_.load_at_zero(TestMachine::mill());
    ASSERT_TRUE(loaded) << loaded.error().message;
    machine_.samples.clear();
  }
  sdk::RmacCam& cam() { return machine_.controller.cam(); }
  void run_to_rest() {
    ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.cycle_now().state == CycleState::Idle; }));
    const std::int64_t cycle = machine_.controller.sample().cycle;
    ASSERT_TRUE(
        machine_.run_until([&] { return !machine_.samples.empty() && machine_.samples.back().cycle >= cycle; }));
  }
  /// Sends a jog again whenever the machine stands, until it is refused; the refusal.
  template <typename Send>
  Error until_refused(Send&& send) {
    for (int i = 0; i < 1000; ++i) {
      if (const Expected<> sent = send(); !sent && sent.error().code == MinorCode::TravelLimit) return sent.error();
      run_to_rest();
    }
    return {MinorCode::Other, "never refused"};
  }
  [[nodiscard]] double position(std::size_t joint) { return machine_.controller.sample().position_set[joint]; }
  [[nodiscard]] double fastest(std::size_t joint) const {
    double most = 0;
    for (const CycleSample& sample : machine_.samples) most = std::max(most, std::abs(sample.velocity_set[joint]));
    return most;
  }
  TestMachine machine_;
};

TEST_F(Jog, ThatIsNotRenewedEndsByItself) {
  ASSERT_TRUE(cam().positioning().jog_joint_at(0, -20));
  run_to_rest();
  EXPECT_NEAR(fastest(0), 20, 0.05);
  // 200 ms at 20 mm/s, and the way of its ramps.
  EXPECT_LT(position(0), -0.2 * 20 + 1);
  EXPECT_GT(position(0), -0.2 * 20 - 2);
  EXPECT_EQ(machine_.controller.cycle_now().state, CycleState::Idle);
  EXPECT_EQ(cam().queue().moves_left(), 0);
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::Stopped));
  EXPECT_THAT(machine_.last(Event::Kind::Stopped), HasSubstr("because it was not renewed in time"));
}

TEST_F(Jog, OfAJointEndsExactlyAtItsLimitAndSaysSoThen) {
  const Error refusal = until_refused([&] { return cam().positioning().jog_joint_at(1, 200); });
  EXPECT_THAT(refusal.message, HasSubstr("Y stands at its limit of 50"));
  EXPECT_NEAR(position(1), 50, 1e-6);
  ASSERT_TRUE(cam().positioning().jog_joint_at(1, -100)) << "away from it is free";
  run_to_rest();
  EXPECT_LT(position(1), 40);
}

TEST_F(Jog, AlongThePathEndsWhereTheFirstJointMust) {
  ASSERT_TRUE(cam().positioning().jog_joint(1, 20));
  run_to_rest();
  (void)until_refused([&] { return cam().positioning().jog_path_at({{1, 1, 0}}, 150); });
  EXPECT_NEAR(position(0), 30, 2e-3);
  EXPECT_NEAR(position(1), 50, 2e-3);
  EXPECT_LE(position(1), 50 + 1e-6);
}

TEST_F(Jog, AlongThePathGoesByDistanceAndNegativeVelocityGoesBack) {
  ASSERT_TRUE(cam().positioning().jog_path({{0, 3, 4}}, 10));
  run_to_rest();
  EXPECT_NEAR(position(1), 6, 1e-6);
  EXPECT_NEAR(position(2), 8, 1e-6);
  machine_.samples.clear();
  ASSERT_TRUE(cam().positioning().jog_path_at({{0, 3, 4}}, -50));
  run_to_rest();
  EXPECT_NEAR(fastest(1), 30, 0.05);
  EXPECT_NEAR(position(1) / position(2), 0.75, 1e-6);
  EXPECT_LT(position(2), 8 - 0.2 * 40 + 3);
}

TEST_F(Jog, TakesItsDirectionInThePartOrInTheTool) {
  const double half = std::sqrt(0.5);
  ASSERT_TRUE(cam().frames().set_part({{0, 0, 0}, {half, half, 0, 0}}));  // part Y is machine Z, part Z machine -Y
  ASSERT_TRUE(cam().positioning().jog_path({{0, 1, 0}}, 5));
  run_to_rest();
  EXPECT_NEAR(position(2), 5, 1e-6);
  ASSERT_TRUE(cam().positioning().jog_path({{0, 0, 1}, true}, 3));  // the tool axis is machine Z
  run_to_rest();
  EXPECT_NEAR(position(2), 8, 1e-6);
  ASSERT_TRUE(cam().positioning().jog_path({{1, 0, 0}, true}, 2));
  run_to_rest();
  EXPECT_NEAR(position(0), 2, 1e-6);
  EXPECT_NEAR(position(1), 0, 1e-6);
}

TEST_F(Jog, ByVelocityRefusesWhatItCannotDo) {
  const auto too_fast = cam().positioning().jog_joint_at(0, 201);
  ASSERT_FALSE(too_fast);
  EXPECT_EQ(too_fast.error().code, MinorCode::SpeedLimit);
  EXPECT_FALSE(cam().positioning().jog_joint_at(3, 1));
  EXPECT_FALSE(cam().positioning().jog_path_at({{0, 0, 0}}, 1));
  EXPECT_FALSE(cam().positioning().jog_path({{1, 0, 0}}, 0));
  EXPECT_FALSE(cam().positioning().jog_path_at({{1, 0, 0}}, 201));
  EXPECT_TRUE(cam().positioning().jog_joint_at(0, 0)) << "stopping what stands is no fault";
  ASSERT_TRUE(cam().path().set_feedrate(600));
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {1, 0, 0}));
  const auto queued = cam().positioning().jog_joint_at(0, 10);
  ASSERT_FALSE(queued);
  EXPECT_THAT(queued.error().message, HasSubstr("needs an empty queue"));
}

}  // namespace
}  // namespace rmac::gateway
