#include "gateway/simulation/motion_account.hpp"

#include <gmock/gmock.h>

#include <numeric>

#include "rmac/modules/chain_kinematics.hpp"
#include "rmac/motion/move_name.hpp"
#include "rmac/motion/path_builder.hpp"

namespace rmac::gateway {
namespace {

constexpr double kPeriod_s = 0.001;

sdk::DeviceObject device(const std::vector<std::string>& joints) {
  sdk::DeviceObject made;
  made.max_feedrate_mm_min = 6000;
  for (const std::string& name : joints) {
    sdk::Joint joint;
    joint.limits = {name, JointType::Linear, JointLimitType::Limited, -50, 50, 200, 1000, 10000};
    made.joints.push_back(joint);
  }
  return made;
}

CycleSample moving(const std::vector<double>& velocities, const std::vector<double>& accelerations, double feed) {
  CycleSample sample;
  sample.moving = true;
  sample.joint_count = static_cast<std::uint32_t>(velocities.size());
  std::copy(velocities.begin(), velocities.end(), sample.velocity_set.begin());
  std::copy(accelerations.begin(), accelerations.end(), sample.acceleration_set.begin());
  sample.feed_set_mm_s = feed;
  return sample;
}

/// What a move from the origin becomes.
PathSegments curves(const Move& move) {
  PlannerModel model;
  model.kinematics = std::make_shared<modules::ChainKinematics>(modules::cartesian(2));
  for (const sdk::Joint& joint : device({"X", "Y"}).joints) model.joints.push_back(joint.limits);
  PathBuilder builder(model);
  builder.restart(std::vector<double>(2, 0.0), {});
  auto built = builder.build(move);
  EXPECT_TRUE(built) << built.error().message;
  return built ? *built : PathSegments{};
}

class Account : public testing::Test {
 protected:
  void SetUp() override { account_.mechanism(device({"X", "Y"})); }
  [[nodiscard]] double time_of(const std::string& limit) const {
    for (const auto& share : account_.shares()) {
      if (share.limit == limit) return share.time_s;
    }
    return 0;
  }
  MotionAccount account_{kPeriod_s};
};

TEST_F(Account, KeepsEachJointsPeaksWhateverTheirSign) {
  account_.cycle(moving({10, -20}, {5, 0}, 0), 100);
  account_.cycle(moving({5, -30}, {-6, 2}, 0), 100);
  const auto& joints = account_.joints();
  ASSERT_EQ(joints.size(), 2U);
  EXPECT_EQ(joints[0].name, "X");
  EXPECT_EQ(joints[0].peak_velocity, 10);
  EXPECT_EQ(joints[0].peak_acceleration, 6);
  EXPECT_NEAR(joints[0].peak_jerk, 11000, 1e-6) << "from 5 to -6 in a cycle";
  EXPECT_EQ(joints[1].peak_velocity, 30);
  EXPECT_NEAR(joints[1].peak_jerk, 2000, 1e-6);
}

TEST_F(Account, GivesACycleToTheNearestLimit) {
  account_.cycle(moving({195, 0}, {0, 0}, 0), 100);
  account_.cycle(moving({0, 50}, {0, 9.5}, 0), 100);
  account_.cycle(moving({0, 199}, {0, 9.5}, 0), 100);
  EXPECT_NEAR(time_of("X velocity"), kPeriod_s, 1e-12);
  EXPECT_NEAR(time_of("Y jerk"), kPeriod_s, 1e-12) << "9.5 mm/s² in a cycle are 95 % of its jerk";
  EXPECT_NEAR(time_of("Y velocity"), kPeriod_s, 1e-12);
}

TEST_F(Account, GivesACycleToNoneWhereEveryLimitIsFar) {
  account_.cycle(moving({90, 0}, {1, 0}, 0), 100);
  EXPECT_NEAR(time_of("none"), kPeriod_s, 1e-12);
}

TEST_F(Account, TakesTheProgrammedPathsBoundsOfTheMoveUnderWay) {
  Move slow{.geometry = PathTargetGeometry{{{3, 4, 0}, {0, 0, 1}}}, .feed_mm_s = 10};
  Move fast = slow;
  fast.feed_mm_s = 90;
  fast.accel_fall_mm_s2 = 50;
  account_.queued(slow, curves(slow));
  account_.queued(fast, curves(fast));
  EXPECT_NEAR(account_.length_mm(), 10, 1e-9) << "5 mm each";
  account_.cycle(moving({0, 0}, {0, 0}, 10), 100);
  EXPECT_NEAR(time_of("feed"), kPeriod_s, 1e-12);
  account_.cycle(moving({0, 0}, {0, 0}, 5), 50);
  EXPECT_NEAR(time_of("feed"), 2 * kPeriod_s, 1e-12) << "half the feed by the override";
  EXPECT_EQ(account_.move_done(), "feed");
  account_.cycle(moving({0, 0}, {0, 0}, 10), 100);
  EXPECT_NEAR(time_of("feed"), 2 * kPeriod_s, 1e-12) << "the next move is allowed more";
  account_.cycle(moving({0, 0}, {0, 0}, 10 - 50 * kPeriod_s), 100);
  EXPECT_NEAR(time_of("path acceleration"), kPeriod_s, 1e-12);
  account_.cycle(moving({0, 0}, {0, 0}, 95), 120);
  EXPECT_NEAR(time_of("feed"), 3 * kPeriod_s, 1e-12) << "the machine's 6000 mm/min, whatever the override";
}

TEST_F(Account, AJointMovesFeedIsTheSpeedItWasLeft) {
  const Move move{.geometry = JointTargetGeometry{{30, 40}}, .joint_speed_fraction = 0.1};
  account_.queued(move, curves(move));
  EXPECT_NEAR(account_.length_mm(), 50, 1e-9);
  account_.cycle(moving({12, 19}, {0, 0}, 22), 100);
  EXPECT_NEAR(time_of("feed"), kPeriod_s, 1e-12) << "19 of a tenth of 200 mm/s";
}

TEST_F(Account, AMoveIsRuledByTheLimitThatRuledLongestWithinIt) {
  for (int i = 0; i < 3; ++i) account_.cycle(moving({195, 0}, {0, 0}, 0), 100);
  account_.cycle(moving({0, 199}, {0, 0}, 0), 100);
  EXPECT_EQ(account_.move_done(), "X velocity");
  EXPECT_EQ(account_.move_done(), "") << "it did not move";
  account_.cycle(moving({0, 199}, {0, 0}, 0), 100);
  EXPECT_EQ(account_.move_done(), "Y velocity") << "whatever ruled the moves before";
  account_.cycle(moving({1, 0}, {0, 0}, 0), 100);
  EXPECT_EQ(account_.move_done(), "none");
}

TEST_F(Account, AJogIsNoPartOfTheWay) {
  const Move jog{.id = kPositioningMoveId, .geometry = JointTargetGeometry{{30, 40}}};
  account_.queued(jog, curves(jog));
  EXPECT_EQ(account_.length_mm(), 0);
}

TEST_F(Account, SharesAddUpToTheTimeInMotion) {
  for (int i = 0; i < 100; ++i) account_.cycle(moving({i * 2.0, 0}, {i * 10.0, 0}, 0), 100);
  account_.cycle(CycleSample{}, 100);
  const auto shares = account_.shares();
  const double sum =
      std::accumulate(shares.begin(), shares.end(), 0.0, [](double s, const auto& share) { return s + share.time_s; });
  EXPECT_NEAR(sum, 100 * kPeriod_s, 1e-12);
  EXPECT_TRUE(std::ranges::is_sorted(shares, std::ranges::greater{}, &MotionAccount::Share::time_s));
}

TEST_F(Account, AJointKeepsItsNameUnderAnotherMechanism) {
  account_.cycle(moving({10, 20}, {0, 0}, 0), 100);
  account_.mechanism(device({"Y", "C"}));
  account_.cycle(moving({30, 5}, {0, 0}, 0), 100);
  const auto& joints = account_.joints();
  ASSERT_EQ(joints.size(), 3U);
  EXPECT_EQ(joints[1].peak_velocity, 30);
  EXPECT_EQ(joints[2].name, "C");
  EXPECT_EQ(joints[2].peak_velocity, 5);
}

}  // namespace
}  // namespace rmac::gateway
