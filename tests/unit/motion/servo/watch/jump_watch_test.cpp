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

TEST_F(ReadPosition, TellsNothingWhereItsDriveDoesNotAnswer) {
  read({0.3, 0.3, {}, 0.31, 0.3, {}, {}, 0.28});
  EXPECT_THAT(faults_.raised, IsEmpty());
}

}  // namespace
}  // namespace rmac::servo_test
