#include "gateway/rmac_cam/cam_cycle.hpp"

#include "unit/gateway/rmac_cam/standing_mill.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class CycleCommands : public StandingMill {
 protected:
  void SetUp() override {
    StandingMill::SetUp();
    ASSERT_TRUE(path_.set_feedrate(600));
    ASSERT_TRUE(queue_line(1, {0, 0, 0}, {10, 0, 0}));
    supervisor_.wish([](ServoWishes& wishes) { wishes.force[1] = 20; });
  }
  [[nodiscard]] bool pushes() { return supervisor_.wishes().force[1] != 0; }
  CamForces forces_{device_, supervisor_};
  int resets_ = 0;
  CamCycle cycle_{device_, supervisor_, forces_, [this] {
                    ++resets_;
                    return Expected<>();
                  }};
};

TEST_F(CycleCommands, IsStartedUntilItIsStoppedAHoldIncluded) {
  EXPECT_FALSE(cycle_.started());
  ASSERT_TRUE(cycle_.start(sdk::CycleMode::Manual));
  EXPECT_TRUE(cycle_.started());
  EXPECT_STREQ(supervisor_.now().mode, "MANUAL");
  ASSERT_TRUE(cycle_.hold());
  EXPECT_EQ(supervisor_.state(), CycleState::Holding);
  EXPECT_TRUE(cycle_.started());
  ASSERT_TRUE(cycle_.resume());
  EXPECT_EQ(supervisor_.state(), CycleState::Running);
  ASSERT_TRUE(cycle_.stop());
  EXPECT_FALSE(cycle_.started());
  EXPECT_EQ(supervisor_.moves_left(), 1U) << "a stop keeps the queue";
}

TEST_F(CycleCommands, StopNowEmptiesTheQueue) {
  ASSERT_TRUE(cycle_.start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(cycle_.stop_now());
  EXPECT_EQ(supervisor_.moves_left(), 0U);
}

TEST_F(CycleCommands, StopsLetGoOfForcesAndAHoldDoesNot) {
  ASSERT_TRUE(cycle_.start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(cycle_.hold());
  EXPECT_TRUE(pushes());
  ASSERT_TRUE(cycle_.stop());
  EXPECT_FALSE(pushes());
  supervisor_.wish([](ServoWishes& wishes) { wishes.force[1] = 20; });
  ASSERT_TRUE(cycle_.stop_now());
  EXPECT_FALSE(pushes());
}

TEST_F(CycleCommands, TakesAnOverrideFromWaitingToTwice) {
  for (const double percent : {0.0, 0.01, 55.0, 200.0}) {
    ASSERT_TRUE(cycle_.set_feed_override(percent));
    EXPECT_EQ(supervisor_.now().override_percent, percent);
  }
  for (const double percent : {-1.0, 0.009, 200.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(cycle_.set_feed_override(percent).error().code, MinorCode::InvalidParameterValue);
  }
  EXPECT_EQ(supervisor_.now().override_percent, 200);
}

TEST_F(CycleCommands, TheOverrideStartsAnewWithAnotherMechanism) {
  ASSERT_TRUE(cycle_.set_feed_override(50));
  cycle_.mechanism_changed(false);
  EXPECT_EQ(supervisor_.now().override_percent, 50);
  cycle_.mechanism_changed(true);
  EXPECT_EQ(supervisor_.now().override_percent, 100);
}

TEST_F(CycleCommands, NeedsAMechanismToStart) {
  device_.change(nullptr);
  EXPECT_THAT(cycle_.start(sdk::CycleMode::Automatic).error().message, HasSubstr("CycleStart: no mechanism is loaded"));
  EXPECT_THAT(cycle_.retrace(1).error().message, HasSubstr("FeedRetrace: no mechanism is loaded"));
}

TEST_F(CycleCommands, AResetIsTheControllers) {
  ASSERT_TRUE(cycle_.reset());
  EXPECT_EQ(resets_, 1);
}

}  // namespace
}  // namespace rmac::gateway
