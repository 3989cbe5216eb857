// The learner against closed loops that know nothing of it: a mass with friction and cogging under a PID, whose drive
// answers late, and which may stand on a spring.
#include "gateway/learning/learner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <numbers>
#include <random>

namespace rmac::gateway {
namespace {

constexpr double kPeriod = 0.001;
constexpr double kPi = std::numbers::pi;

/// One axis: 100 kg; all in N, mm and s.
struct Axis {
  double bandwidth_hz = 30;
  double friction_n = 40, cogging_n = 10, pitch_mm = 4;
  double resonance_hz = 0;  ///< of the load on its screw; 0: rigid
  int delay = 1;            ///< cycles until a torque acts
  double noise_mm = 0;
  double gain_sign = 1;  ///< -1: what is added acts the wrong way round, so that learning makes things worse
};

/// Runs from 0 to 40 mm and back with `offsets`, and tells the learner's view of it.
class Loop {
 public:
  Loop(const Axis& axis, unsigned seed) : axis_(axis), random_(seed) {}

  Pass run(const LearnedPath* learned) {
    Pass pass({0});
    LearnedPath::Cursor cursor;
    double offset = 0;
    const double w = 2 * kPi * axis_.bandwidth_hz;
    const double kp = kMass * w * w / 2, kd = kMass * w * 1.2, ki = kp * w / 10;
    Plant plant;
    std::deque<double> forces(static_cast<std::size_t>(axis_.delay), 0.0);
    double integral = 0, shown_before = 0;
    for (int cycle = 0; cycle < 2400; ++cycle) {
      const double t = cycle * kPeriod;
      const Wanted wanted = at(t);
      const double before = offset;
      double told[1] = {};
      if (learned != nullptr && wanted.moves && learned->at(cursor, wanted.move, wanted.s, told)) {
        offset = axis_.gain_sign * told[0];
      }
      const double shown = plant.motor + axis_.noise_mm * normal_(random_);
      const double following_error[1] = {wanted.q - shown}, set[1] = {wanted.q};
      pass.add({cycle, wanted.move, wanted.s, wanted.moves, set, following_error});
      const double error = wanted.q + offset - shown;
      integral += error * kPeriod;
      const double rate = wanted.v + (offset - before) / kPeriod - (shown - shown_before) / kPeriod;
      shown_before = shown;
      forces.push_back(kp * error + kd * rate + ki * integral + kMass * wanted.a);
      move(plant, forces.front());
      forces.pop_front();
    }
    pass.end();
    return pass;
  }

 private:
  static constexpr double kMass = 0.1;  // N s²/mm
  struct Plant {
    double motor = 0, motor_v = 0, load = 0, load_v = 0;
  };
  struct Wanted {
    double q = 0, v = 0, a = 0, s = 0;
    std::int64_t move = 1;
    bool moves = false;
  };
  /// There within a second, a rest, and back.
  static Wanted at(double t) {
    const bool back = t > 1.2;
    const double u = std::clamp(back ? t - 1.2 : t, 0.0, 1.0);
    const double way = 40 * (u - std::sin(2 * kPi * u) / (2 * kPi)), v = 40 * (1 - std::cos(2 * kPi * u));
    const double a = 80 * kPi * std::sin(2 * kPi * u);
    const bool moves = u > 0 && u < 1;
    if (back) return {40 - way, -v, -a, way, 2, moves};
    return {way, v, a, way, 1, moves};
  }
  void move(Plant& plant, double force) const {
    constexpr int kParts = 20;
    const double h = kPeriod / kParts;
    const bool rigid = axis_.resonance_hz == 0;
    const double motor = rigid ? kMass : 0.4 * kMass, load = 0.6 * kMass;
    const double w = 2 * kPi * axis_.resonance_hz;
    const double k = rigid ? 0 : w * w * motor * load / kMass, d = rigid ? 0 : 2 * 0.05 * std::sqrt(k * load);
    for (int i = 0; i < kParts; ++i) {
      const double spring = k * (plant.motor - plant.load) + d * (plant.motor_v - plant.load_v);
      const double friction = axis_.friction_n * std::tanh(plant.motor_v / 0.2);
      const double cogging = axis_.cogging_n * std::sin(2 * kPi * plant.motor / axis_.pitch_mm);
      plant.motor_v += h * (force - friction - cogging - spring) / motor;
      plant.motor += h * plant.motor_v;
      plant.load_v += h * spring / load;
      plant.load += h * plant.load_v;
    }
  }

  Axis axis_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

struct Lesson {
  std::vector<double> rms;
  Learner learner;
};

Lesson learn(const Axis& axis, unsigned seed, int passes, double bandwidth_hz, double largest = 0.2) {
  Loop loop(axis, seed);
  Lesson lesson{{}, Learner({.period_s = kPeriod, .bandwidth_hz = bandwidth_hz, .largest = {largest}})};
  for (int i = 0; i < passes; ++i) {
    const Pass pass = loop.run(lesson.learner.next().get());
    lesson.rms.push_back(pass.rms(0));
    lesson.learner.learn(pass);
  }
  return lesson;
}

Axis random_axis(std::mt19937& random) {
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  Axis axis;
  axis.bandwidth_hz = between(20, 50);
  axis.friction_n = between(10, 80);
  axis.cogging_n = between(0, 20);
  axis.pitch_mm = between(2, 10);
  axis.delay = static_cast<int>(between(1, 3));
  axis.resonance_hz = between(0, 1) < 0.5 ? 0 : between(150, 300);
  return axis;
}

/// Calls `judge` for a hundred axes but those whose loop swings without any learning.
void for_each_loop(double part_of_bandwidth, const std::function<void(const std::vector<double>& rms)>& judge) {
  int loops = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    const Axis axis = random_axis(random);
    const Lesson lesson = learn(axis, seed, 6, part_of_bandwidth * axis.bandwidth_hz);
    if (!(lesson.rms[0] < 0.2)) continue;
    ++loops;
    SCOPED_TRACE(testing::Message() << "seed " << seed << ": " << axis.bandwidth_hz << " Hz, friction "
                                    << axis.friction_n << ", resonance " << axis.resonance_hz << ", delay "
                                    << axis.delay << "; rms " << testing::PrintToString(lesson.rms));
    judge(lesson.rms);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(loops, 70);
}

TEST(Learner, EachPassIsBetterUpToHalfTheLoopsBandwidth) {
  for_each_loop(0.5, [](const std::vector<double>& rms) {
    for (std::size_t i = 1; i < rms.size(); ++i) EXPECT_LT(rms[i], std::max(1.03 * rms[i - 1], 0.3 * rms[0]));
    EXPECT_LT(rms.back(), 0.7 * rms[0]);
  });
}

TEST(Learner, AThirdIsLeftAtMostWhereItLearnsUpToTheLoopsBandwidth) {
  for_each_loop(1, [](const std::vector<double>& rms) { EXPECT_LT(std::ranges::min(rms), rms[0] / 3); });
}

TEST(Learner, OffsetsKeepWithinTheirBoundAndBeginAndEndWithNone) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    const Lesson lesson = learn(random_axis(random), seed, 4, 30, 0.003);
    const LearnedPath::Parts& parts = lesson.learner.next_parts();
    for (const double offset : parts.offsets) ASSERT_LE(std::abs(offset), 0.003);
    EXPECT_EQ(parts.offsets.front(), 0);
    EXPECT_EQ(parts.offsets.back(), 0);
  }
}

// Red when the best is not kept: what is added acts the wrong way round here.
TEST(Learner, GoesBackToTheBestPassWhereItMakesThingsWorse) {
  Axis wrong;
  wrong.gain_sign = -1;
  const Lesson lesson = learn(wrong, 1, 6, 20);
  EXPECT_GT(lesson.rms[1], 1.2 * lesson.rms[0]);
  EXPECT_NEAR(lesson.rms[2], lesson.rms[0], 1e-9) << "without offsets again";
  EXPECT_TRUE(lesson.learner.fell_back(0));
  EXPECT_EQ(lesson.learner.best_pass(0), 0U);
  Learner settled = lesson.learner;
  settled.settle(Loop(wrong, 1).run(nullptr));
  for (const double offset : settled.next_parts().offsets) ASSERT_EQ(offset, 0);
}

// Red where it learns up to a lower frequency by forgetting what it knew above.
TEST(Learner, APassThatWasDisturbedTakesNothingAway) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    Axis axis = random_axis(random);
    axis.resonance_hz = 0;
    Lesson lesson = learn(axis, seed, 5, axis.bandwidth_hz / 2);
    const double best = std::ranges::min(lesson.rms);
    Axis dirty = axis;
    dirty.friction_n *= 3;  // a chip below the way cover
    lesson.learner.learn(Loop(dirty, seed).run(lesson.learner.next().get()));
    ASSERT_TRUE(lesson.learner.fell_back(0)) << seed;
    for (int i = 0; i < 4; ++i) {
      const Pass pass = Loop(axis, seed).run(lesson.learner.next().get());
      EXPECT_LT(pass.rms(0), 1.1 * best) << "seed " << seed << ", pass " << i;
      lesson.learner.learn(pass);
    }
  }
}

TEST(Learner, WhatIsNoisyOnlyIsNotMadeWorse) {
  Axis noisy;
  noisy.friction_n = noisy.cogging_n = 0;
  noisy.noise_mm = 0.001;
  const Lesson lesson = learn(noisy, 3, 8, 20);
  for (const double rms : lesson.rms) EXPECT_LT(rms, 1.15 * lesson.rms[0]);
}

TEST(Learner, AJointThatTakesNoOffsetsLearnsNone) {
  const Lesson lesson = learn(Axis{}, 1, 3, 20, 0);
  for (const double offset : lesson.learner.next_parts().offsets) ASSERT_EQ(offset, 0);
  EXPECT_NEAR(lesson.rms[2], lesson.rms[0], 1e-12);
}

}  // namespace
}  // namespace rmac::gateway
