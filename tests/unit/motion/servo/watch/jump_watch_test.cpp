#include "servo/watch/jump_watch.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using Kind = ServoFault::Kind;
using testing::IsEmpty, testing::SizeIs;

/// What motion explains is a change of 0.1 mm between two steps.
class ReadPosition : public testing::Test {
 protected:
  ReadPosition() { joint_.bounds.jump = 0.1; }

  /// Steps of its reading, mm a cycle; none: its drive did not answer.
  void read(const std::vector<std::optional<double>>& steps) {
    watch_.rest();
    faults_.raised.clear();
    std::optional<double> before;
    double fastest = 0;
    for (const std::optional<double>& step : steps) {
      JumpSeen seen{.step = step};
      if (before && step) seen.jump = *step - *before;
      seen.may_stop = step && std::abs(*step) <= fastest + joint_.bounds.jump / 2;
      if (step) fastest = std::max(fastest, std::abs(*step));
      before = step;
      watch_.step(seen, faults_);
    }
  }
  ServoJoint joint_;
  JumpWatch watch_{joint_, 4};
  RecordedFaults faults_;
};

TEST_F(ReadPosition, MayStopWithinACycleOnWhatItMeets) {
  const std::vector<std::optional<double>> stays{0.3, 0.3, 0, 0, 0, 0, 0, 0}, bends{0.3, 0.3, 0.1, 0, -0.05, 0, 0, 0},
      comes_back{0.3, 0.3, 0, -0.1, -0.2, -0.2, -0.2}, rings{0.3, 0.3, 0.05, -0.2, -0.1, 0.2, 0.1},
      goes_on_by_and_by{0.3, 0.3, 0, 0, 0, 0, 0.05, 0.1, 0.15, 0.2, 0.3};
  for (const auto& steps : {stays, bends, comes_back, rings, goes_on_by_and_by}) {
    read(steps);
    EXPECT_THAT(faults_.raised, IsEmpty()) << testing::PrintToString(steps);
  }
}

TEST_F(ReadPosition, JumpsWhereItGoesOnAsBefore) {
  const std::vector<std::optional<double>> slips{0.3, 0.3, 0, 0.3, 0.3}, back{0.3, 0.3, -0.2, 0.3, 0.3},
      over_two_cycles{0.3, 0.3, 0.1, 0.1, 0.3, 0.3}, forwards{0.1, 0.1, 0.3, 0.1}, standing{0, 0, 0.11, 0},
      after_a_silence{0.3, 0.3, 0, {}, {}, 0.3, 0.3}, in_an_hours_silence{0.3, 0.3, 0, {}, {}, {}, {}, {}, {}, {}, 0.3};
  for (const auto& steps : {slips, back, over_two_cycles, forwards, standing, after_a_silence, in_an_hours_silence}) {
    read(steps);
    ASSERT_THAT(faults_.raised, SizeIs(1)) << testing::PrintToString(steps);
    EXPECT_EQ(faults_.raised[0].kind, Kind::EncoderJump);
    EXPECT_EQ(faults_.raised[0].bound, 0.1);
  }
}

// Each edge of a spike is a jump, and no joint is so fast.
TEST_F(ReadPosition, JumpsThereAndBack) {
  read({0.3, 0.3, -0.2, 0.8, 0.3});
  ASSERT_FALSE(faults_.raised.empty());
  EXPECT_NEAR(faults_.raised[0].value, 1, 1e-12);
}

TEST_F(ReadPosition, JumpsWhileItTremblesWhereItIsFasterThanBeforeOrNotBelieved) {
  watch_.step({.jump = -0.3, .step = 0.1, .may_stop = true, .trembles = true}, faults_);
  EXPECT_THAT(faults_.raised, IsEmpty()) << "a motor on its spring";
  watch_.step({.jump = 0.2, .step = 0.3, .may_stop = false, .trembles = true}, faults_);
  EXPECT_THAT(faults_.raised, SizeIs(1));
  watch_.rest();
  watch_.step({.jump = 0.05, .may_stop = true, .trembles = true, .refused = true}, faults_);
  EXPECT_THAT(faults_.raised, SizeIs(2));
}

TEST_F(ReadPosition, IsInDoubtFromAJumpThatMayBeAStopUntilThatIsClear) {
  EXPECT_FALSE(watch_.doubts());
  watch_.step({.jump = -0.3, .step = 0, .may_stop = true}, faults_);
  EXPECT_TRUE(watch_.doubts());
  watch_.step({.step = 0, .may_stop = true}, faults_);
  watch_.step({.step = 0, .may_stop = true}, faults_);
  EXPECT_FALSE(watch_.doubts()) << "it stopped";
  watch_.step({.jump = 0.3, .step = 0.3}, faults_);
  watch_.step({.step = 0.3}, faults_);
  EXPECT_TRUE(watch_.doubts()) << "it jumped";
  watch_.rest();
  EXPECT_FALSE(watch_.doubts());
}

TEST_F(ReadPosition, TellsNothingWhereItsDriveDoesNotAnswer) {
  read({0.3, 0.3, {}, 0.31, 0.3, {}, {}, 0.28});
  EXPECT_THAT(faults_.raised, IsEmpty());
}

}  // namespace
}  // namespace rmac::servo_test
