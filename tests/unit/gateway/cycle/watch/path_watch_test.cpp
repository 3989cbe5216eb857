#include "gateway/cycle/watch/path_watch.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

/// Machine time in cycles of a millisecond, at a place that the test moves.
class PathWatched : public ::testing::Test {
 protected:
  std::optional<std::string> cycles(int count) {
    for (int i = 0; i < count; ++i) {
      now.t_s += 0.001;
      if (auto wrong = watch.step(now)) return wrong;
    }
    return std::nullopt;
  }

  PathWatch watch;
  PathWatch::Seen now{.should_move = true, .move_id = 7, .s_mm = 1.5};
};

TEST_F(PathWatched, StandingForHalfASecondIsWrong) {
  EXPECT_FALSE(cycles(500));
  const auto wrong = cycles(10);
  ASSERT_TRUE(wrong);
  EXPECT_NE(wrong->find("stood for 0.5 s at move 7, 1.500000 mm"), std::string::npos) << *wrong;
}

TEST_F(PathWatched, IsToldOnceUntilItHasStoodAsLongAgain) {
  ASSERT_TRUE(cycles(600));
  EXPECT_FALSE(cycles(400));
  EXPECT_TRUE(cycles(200));
}

TEST_F(PathWatched, AnyProgressIsEnough) {
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(cycles(400));
    now.s_mm += 2e-7;
  }
  now.move_id = 8;
  EXPECT_FALSE(cycles(400));
}

TEST_F(PathWatched, StandingWhereSomethingIsWaitedForIsRight) {
  now.should_move = false;
  EXPECT_FALSE(cycles(5000));
  now.should_move = true;
  EXPECT_FALSE(cycles(499)) << "what went before does not count";
}

TEST_F(PathWatched, APlannerThatIsNotLetRunHasTime) {
  for (int i = 0; i < 40; ++i) {
    now.t_s += 10;
    EXPECT_FALSE(watch.step(now)) << "in look " << i;
  }
}

TEST_F(PathWatched, JointsThatWereStoppedAsAskedAreRight) {
  now.departure = {1, 3, 100, PathDeparture::Cause::Stop, 0};
  EXPECT_FALSE(cycles(10));
}

TEST_F(PathWatched, KinematicsThatFailOnTheWayAreToldOnce) {
  now.departure = {1, 3, 100, PathDeparture::Cause::NotANumber, 2};
  auto wrong = cycles(1);
  ASSERT_TRUE(wrong);
  EXPECT_NE(wrong->find("cycle 101: the kinematics gave something that is no number for joint 2"), std::string::npos)
      << *wrong;
  EXPECT_FALSE(cycles(10));
  now.departure = {2, 3, 200, PathDeparture::Cause::NoSolution, 0};
  wrong = cycles(1);
  ASSERT_TRUE(wrong);
  EXPECT_NE(wrong->find("found no joints"), std::string::npos) << *wrong;
  EXPECT_EQ(wrong->find("joint 0"), std::string::npos) << "none is to blame: " << *wrong;
}

TEST_F(PathWatched, AnotherMechanismsDeparturesCountFromZero) {
  now.departure = {1, 3, 100, PathDeparture::Cause::Jump, 2};
  ASSERT_TRUE(cycles(1));
  watch.restart();
  EXPECT_TRUE(cycles(1));
}

}  // namespace
}  // namespace rmac::gateway
