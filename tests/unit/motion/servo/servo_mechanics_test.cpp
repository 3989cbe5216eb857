#include <gmock/gmock.h>

#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using testing::HasSubstr;

JointMechanics pitch(const PitchErrors& table) {
  JointMechanics mechanics;
  mechanics.pitch = table;
  return mechanics;
}
JointMechanics backlash(double width) {
  JointMechanics mechanics;
  mechanics.backlash = width;
  return mechanics;
}
JointMechanics filters(const std::vector<Resonance>& resonances, double low_pass_hz) {
  JointMechanics mechanics;
  mechanics.resonances = resonances;
  mechanics.low_pass_hz = low_pass_hz;
  return mechanics;
}

class ServoMechanics : public ServoLoopTest {
 protected:
  void build_with(const JointMechanics& mechanics) {
    ServoLoopParts made = parts();
    made.joints[0].mechanics = mechanics;
    build(std::move(made));
  }
  /// Joint 0 wants `velocity`, and its drive follows where it is told, for some cycles.
  void travel(double velocity, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      shown_ += velocity * 1e-3;
      put_at(0, shown_);
      command.setpoint.position[0] += velocity * 1e-3;
      command.setpoint.velocity[0] = velocity;
      cycle();
    }
  }
  double shown_ = 0;
};

const PitchErrors kTable{-10, 5, {0.1, 0.3, -0.1, 0, 0.2}};

TEST_F(ServoMechanics, PutPitchErrorsOnTopOfWhatTheDriveShows) {
  build_with(pitch(kTable));
  for (const auto& [shown, error] : {std::pair{-10.0, 0.1},
                                     {-7.5, 0.2},
                                     {-5.0, 0.3},
                                     {0.0, -0.1},
                                     {2.0, -0.06},
                                     {10.0, 0.2},
                                     {30.0, 0.2},
                                     {-30.0, 0.1}}) {
    put_at(0, shown);
    cycle();
    EXPECT_NEAR(report.position[0], shown + error, 1e-9);
    EXPECT_EQ(report.position[2], 0) << "the table is another joint's";
  }
}

TEST_F(ServoMechanics, GiveVelocitiesThatBelongToTheCorrectedPositions) {
  build_with(pitch({0, 10, {0, 1}}));
  shown_ = 5;
  put_at(0, shown_);
  engage();
  travel(10, 5);
  EXPECT_NEAR(report.velocity[0], 11, 1e-6);
}

TEST_F(ServoMechanics, KeepTheirPlaceWhenAnotherLoopTakesOver) {
  JointMechanics play = pitch(kTable);
  play.backlash = 0.05;
  build_with(play);
  engage();
  travel(20, 100);
  const double wanted = loop->hold_position()[0];
  const double measured = report.position[0];
  const auto old = std::move(loop);
  build_with(play);
  loop->engage(old->handover());
  EXPECT_NEAR(loop->hold_position()[0], wanted, 1e-9);
  cycle();
  EXPECT_NEAR(report.position[0], measured, 1e-9);
}

TEST_F(ServoMechanics, CrossTheBacklashInSmallStepsWhenTheJointTurnsRound) {
  constexpr double kBacklash = 0.04;
  build_with(backlash(kBacklash));
  engage();
  EXPECT_NEAR(report.position[0], 0, 1e-9) << "before it has moved the flank is not known";
  travel(10, 30);
  EXPECT_NEAR(report.position[0], shown_ - kBacklash / 2, 1e-9);
  travel(0, 30);
  EXPECT_NEAR(report.position[0], shown_ - kBacklash / 2, 1e-9) << "standing still changes no flank";
  double before = shown_ - report.position[0];
  for (int i = 0; i < 30; ++i) {
    travel(-10, 1);
    const double lag = shown_ - report.position[0];
    EXPECT_LE(std::abs(lag - before), 0.26 * kBacklash) << "in cycle " << i;
    before = lag;
  }
  EXPECT_NEAR(before, -kBacklash / 2, 1e-9);
}

/// Largest effort of joint 0, over the last half of a second, when its error swings by 0.5 mm with this frequency.
class EffortFilters : public ServoMechanics {
 protected:
  double swing(double frequency_hz) {
    engage();
    double largest = 0;
    for (int i = 0; i < 1000; ++i) {
      put_at(0, 0.5 * std::sin(2 * std::numbers::pi * frequency_hz * 1e-3 * i));
      cycle();
      if (i >= 500) largest = std::max(largest, std::abs(report.effort[0]));
    }
    return largest / (0.5 * laws[0]->gain);
  }
};

TEST_F(EffortFilters, NotchAtAResonanceAndNowhereElse) {
  const JointMechanics mechanics = filters({{120, 0.02, 0.4}}, 0);
  for (const auto& [frequency, gain, tolerance] :
       {std::tuple{2.0, 1.0, 0.02}, {120.0, 0.02 / 0.4, 0.02}, {12.0, 1.0, 0.03}}) {
    build_with(mechanics);
    EXPECT_NEAR(swing(frequency), gain, tolerance) << frequency << " Hz";
  }
}

TEST_F(EffortFilters, PassWhatIsBelowTheLowPassAndHalveThePowerAtItsCorner) {
  for (const auto& [frequency, gain] : {std::pair{2.0, 1.0}, {100.0, std::sqrt(0.5)}, {350.0, 0.034}}) {
    build_with(filters({}, 100));
    EXPECT_NEAR(swing(frequency), gain, 0.02) << frequency << " Hz";
  }
}

TEST_F(EffortFilters, AreEngagedWithoutAJump) {
  build_with(filters({{120, 0.02, 0.4}}, 200));
  engage();
  put_at(0, 0.5);
  cycle(1000);
  const double before = report.effort[0];
  ASSERT_NEAR(before, -0.05, 1e-4);
  const auto old = std::move(loop);
  build_with(filters({{90, 0.02, 0.4}}, 100));
  loop->engage(old->handover());
  for (int i = 0; i < 50; ++i) {
    cycle();
    EXPECT_NEAR(report.effort[0], before, 1e-4) << "in cycle " << i;
  }
}

struct Wrong {
  const char* name;
  JointMechanics mechanics;
  const char* message;
};
void PrintTo(const Wrong& wrong, std::ostream* out) {
  *out << wrong.name;
}
class WrongMechanics : public ServoMechanics, public testing::WithParamInterface<Wrong> {};
INSTANTIATE_TEST_SUITE_P(
    Kinds, WrongMechanics,
    testing::Values(Wrong{"TableWithoutStep", pitch({0, 0, {1, 1}}), "a step above 0"},
                    Wrong{"TableTooSteep", pitch({0, 1, {0, 0.2}}), "more than a tenth of its step at point 1"},
                    Wrong{"Backlash", backlash(-1), "a backlash must be 0 to 10"},
                    Wrong{"ResonanceTooHigh", filters({{450, 0.02, 0.4}}, 0), "a frequency of 1 to 400"},
                    Wrong{"ResonanceTooBroad", filters({{100, 0.5, 0.4}}, 0), "a width above the damping"},
                    Wrong{"LowPass", filters({}, 450), "low-pass must be 0 (none), or 1 to 400"}),
    [](const testing::TestParamInfo<Wrong>& wrong) { return std::string(wrong.param.name); });

TEST_P(WrongMechanics, AreRefusedWithTheReason) {
  ServoLoopParts made = parts();
  made.joints[0].mechanics = GetParam().mechanics;
  const auto refused = ServoLoop::create(std::move(made));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("joint 0: "));
  EXPECT_THAT(refused.error().message, HasSubstr(GetParam().message));
}

}  // namespace
}  // namespace rmac::servo_test
