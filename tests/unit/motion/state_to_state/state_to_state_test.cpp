#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "unit/motion/state_to_state/state_to_state_cases.hpp"

namespace rmac {
namespace {

/// As it can be replayed: the arguments of `fastest_profile`.
std::string replay(const StateToStateCase& c) {
  char text[512];
  std::snprintf(text, sizeof text, "{%.17g, %.17g, %.17g}, {%.17g, %.17g, %.17g}, {%.17g, %.17g, %.17g, %.17g, %.17g}",
                c.from.position, c.from.velocity, c.from.acceleration, c.to.position, c.to.velocity, c.to.acceleration,
                c.bounds.min_velocity, c.bounds.max_velocity, c.bounds.min_acceleration, c.bounds.max_acceleration,
                c.bounds.max_jerk);
  return text;
}

TEST(StateToState, AnyStateIsReachedWithinTheBounds) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 50'000; ++i) {
    const StateToStateCase c = random_case(random);
    const JerkProfile profile = fastest_profile(c.from, c.to, c.bounds);
    ASSERT_EQ(fault_of(c, profile), "") << replay(c);
  }
}

TEST(StateToState, RestToRestTakesTheTimeOfTheClosedForm) {
  // Seven phases: to 200 mm/s at 1000 mm/s² and 10000 mm/s³ and back takes 60 mm; then 100 mm cost v/a + a/j + s/v.
  const JerkProfile profile = fastest_profile({0, 0, 0}, {100, 0, 0}, {-200, 200, -1000, 1000, 10000});
  EXPECT_NEAR(profile.duration(), 0.2 + 0.1 + 0.5, 1e-12);
  // Four phases of 1 s, each of 1/6 mm and so on: s = 2 j t³.
  EXPECT_NEAR(fastest_profile({0, 0, 0}, {2, 0, 0}, {-9, 9, -9, 9, 1}).duration(), 4, 1e-12);
}

TEST(StateToState, TheWayBackInTimeTakesAsLong) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 20'000; ++i) {
    const StateToStateCase c = random_case(random);
    MotionBounds bounds = c.bounds;
    std::swap(bounds.min_acceleration, bounds.max_acceleration);
    bounds.min_acceleration *= -1, bounds.max_acceleration *= -1;
    const JointState from{-c.to.position, c.to.velocity, -c.to.acceleration};
    const JointState to{-c.from.position, c.from.velocity, -c.from.acceleration};
    const double there = fastest_profile(c.from, c.to, c.bounds).duration();
    ASSERT_NEAR(fastest_profile(from, to, bounds).duration(), there, 1e-7 * there) << replay(c);
  }
}

TEST(StateToState, NoDetourOverAnotherStateIsFaster) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 20'000; ++i) {
    const StateToStateCase c = random_case(random);
    StateToStateCase other = random_case(random);
    const double there = fastest_profile(c.from, c.to, c.bounds).duration();
    // Over any state: the sum of both fastest ways is never below the fastest way.
    JointState over = other.to;
    if (!stays_inside(over, c.bounds) || !came_from_inside(over, c.bounds)) continue;
    const double detour =
        fastest_profile(c.from, over, c.bounds).duration() + fastest_profile(over, c.to, c.bounds).duration();
    ASSERT_GE(detour, there * (1 - 1e-9)) << replay(c);
  }
}

TEST(StateToState, NothingIsLeftToGainFromWhereTheFastestPasses) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 20'000; ++i) {
    const StateToStateCase c = random_case(random);
    if (!stays_inside(c.from, c.bounds) || !came_from_inside(c.to, c.bounds)) continue;
    const JerkProfile profile = fastest_profile(c.from, c.to, c.bounds);
    // On its last phases a motion can be the only one that ends as wanted; a rounding beside it, and the joint has to
    // come round once more.
    if (profile.phases().size() < 5) continue;
    const double until = profile.phases()[profile.phases().size() - 4].t0;
    const double t = until * std::uniform_real_distribution<double>(0, 1)(random);
    const double rest = fastest_profile(profile.at(t), c.to, c.bounds).duration();
    ASSERT_NEAR(t + rest, profile.duration(), 1e-6 * profile.duration()) << replay(c) << " left at " << t;
  }
}

TEST(StateToState, ASpeedAboveItsBoundComesDownWithoutUndershoot) {
  const JerkProfile profile = fastest_profile({0, 80, 0}, {500, 0, 0}, {-20, 20, -100, 100, 1000});
  double t = 0;
  while (profile.at(t).velocity > 20 * (1 + 1e-9)) t += 1e-3;
  EXPECT_LT(t, 0.9);
  EXPECT_NEAR(profile.at(t + 1).velocity, 20, 1e-6);
  const JerkProfile change = velocity_profile({0, 80, 0}, 20, {-20, 20, -100, 100, 1000});
  EXPECT_NEAR(change.duration(), 60.0 / 100 + 0.1, 1e-7);
  EXPECT_NEAR(change.end().velocity, 20, 1e-9);
}

TEST(Synchronise, AllJointsArriveTogetherWithinTheirBounds) {
  constexpr std::size_t kJoints = 7;
  std::mt19937_64 random(5);
  int longer_than_the_slowest = 0;
  for (int i = 0; i < 10'000; ++i) {
    std::vector<StateToStateCase> cases;
    std::vector<JointState> from, to;
    std::vector<MotionBounds> bounds;
    std::vector<JerkProfile> profiles(kJoints);
    double slowest = 0;
    for (std::size_t k = 0; k < kJoints; ++k) {
      cases.push_back(random_case(random));
      if (k == 6) cases[k].to = cases[k].from = {1, 0, 0};
      from.push_back(cases[k].from);
      to.push_back(cases[k].to);
      bounds.push_back(cases[k].bounds);
      slowest = std::max(slowest, fastest_profile(from[k], to[k], bounds[k]).duration());
    }
    const double duration = synchronise(from, to, bounds, profiles);
    ASSERT_GE(duration, slowest * (1 - 1e-12));
    longer_than_the_slowest += duration > slowest * (1 + 1e-9) ? 1 : 0;
    for (std::size_t k = 0; k < kJoints; ++k) {
      ASSERT_EQ(fault_of(cases[k], profiles[k]), "") << replay(cases[k]) << " in " << duration;
      ASSERT_NEAR(profiles[k].duration(), duration, 1e-9 * duration) << replay(cases[k]);
    }
  }
  // The cases do hold joints that cannot take the slowest one's time.
  EXPECT_GT(longer_than_the_slowest, 0);
}

TEST(Synchronise, AJointThatCannotTakeTheTimeLengthensItForAll) {
  // At its largest speed, 1 mm ahead of where it shall have this speed: there in 1 s. Braking and speeding up again
  // with 1 mm/s³ loses T³/32 in a time T, so 1.5 s are too long not to pass the place and too short to come back.
  const JointState from[2] = {{0, 1, 0}, {0, 0, 0}}, to[2] = {{1, 1, 0}, {2 * std::pow(1.5 / 4, 3), 0, 0}};
  const MotionBounds bounds[2] = {{-1, 1, -2, 2, 1}, {-9, 9, -9, 9, 1}};
  EXPECT_NEAR(fastest_profile(from[0], to[0], bounds[0]).duration(), 1, 1e-9);
  EXPECT_NEAR(fastest_profile(from[1], to[1], bounds[1]).duration(), 1.5, 1e-9);
  JerkProfile profiles[2];
  const double t = synchronise(from, to, bounds, profiles);
  EXPECT_GT(t, 2);
  EXPECT_NEAR(t - t * t * t / 32, 1, 1e-9);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(profiles[i].duration(), t, 1e-9);
    EXPECT_NEAR(profiles[i].end().position, to[i].position, 1e-9);
  }
}

}  // namespace
}  // namespace rmac
