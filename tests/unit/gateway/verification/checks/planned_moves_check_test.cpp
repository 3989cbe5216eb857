// What the planner makes of a geometry, and of one that lies to it.
#include "gateway/verification/checks/planned_moves_check.hpp"

#include <gmock/gmock.h>

#include "unit/planar_arm.hpp"

namespace rmac::verifier {
namespace {

using test::ArmFault;
using testing::HasSubstr;

PlannedMovesCase arm_case(ArmFault fault, std::uint64_t seed) {
  PlannedMovesCase given;
  given.model = test::planar_arm(fault);
  for (const JointLimits& joint : given.model.joints) given.ranges.push_back({joint.min, joint.max});
  given.start = {0, 90, -50};
  given.programs = 5;
  given.seed = seed;
  return given;
}

class PlannedMovesOfSeed : public testing::TestWithParam<std::uint64_t> {
 protected:
  std::string refusal(ArmFault fault) {
    PlannedMovesCase given = arm_case(fault, GetParam());
    given.programs = 100;
    const auto done = check_planned_moves(given);
    return done ? "" : to_string(done.error());
  }
};

INSTANTIATE_TEST_SUITE_P(Seeds, PlannedMovesOfSeed, testing::Range<std::uint64_t>(1, 6));

TEST_P(PlannedMovesOfSeed, RunsThoseOfAnArmToTheirEnds) {
  PlannedMovesCase given = arm_case(ArmFault::None, GetParam());
  std::int64_t cycles = 0;
  given.follow = [&](const Setpoint&, const Frames&) {
    ++cycles;
    return Checked();
  };
  const auto done = check_planned_moves(given);
  ASSERT_TRUE(done) << to_string(done.error());
  EXPECT_GT(done->run, 10);
  EXPECT_EQ(done->run + done->refused, 30);
  EXPECT_GT(cycles, 1000);
}

TEST_P(PlannedMovesOfSeed, FindsALieAboutItsRates) {
  EXPECT_THAT(refusal(ArmFault::LiesOfItsRates), HasSubstr("planned moves"));
}

TEST_P(PlannedMovesOfSeed, FindsAPlaceThatIsNoNumber) {
  EXPECT_THAT(refusal(ArmFault::LosesItsNumbers), testing::Not(testing::IsEmpty()));
}

TEST_P(PlannedMovesOfSeed, FindsAToolBesideItsLine) {
  EXPECT_THAT(refusal(ArmFault::Misses), testing::Not(testing::IsEmpty()));
}

TEST_P(PlannedMovesOfSeed, PassesOnWhatFollowsDoesNotTake) {
  PlannedMovesCase given = arm_case(ArmFault::None, GetParam());
  given.follow = [&](const Setpoint& setpoint, const Frames&) {
    return setpoint.position[2] > -50 ? found("stability", "it shakes", -1, {}) : Checked();
  };
  const auto done = check_planned_moves(given);
  ASSERT_FALSE(done);
  EXPECT_THAT(to_string(done.error()), HasSubstr("it shakes"));
}

}  // namespace
}  // namespace rmac::verifier
