#include "gateway/rmac_cam/measuring/hit_finder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rmac::gateway {
namespace {

constexpr double kPeriod_s = 0.001;

/// Two joints on cubics, sampled each cycle; the probe touches at some instant.
struct Motion {
  std::array<std::array<double, 4>, 2> terms{};
  std::array<std::uint8_t, 2> delays{};  ///< of what drives tell, in cycles

  [[nodiscard]] double at(std::size_t joint, double t_s) const {
    const auto& c = terms[joint];
    return c[0] + t_s * (c[1] + t_s * (c[2] + t_s * c[3]));
  }
  [[nodiscard]] CycleSample sample(int cycle) const {
    CycleSample sample;
    sample.cycle = cycle;
    sample.t_s = cycle * kPeriod_s;
    sample.joint_count = 2;
    for (std::size_t j = 0; j < 2; ++j) {
      sample.answer_delay[j] = delays[j];
      sample.position[j] = at(j, sample.t_s - delays[j] * kPeriod_s);
    }
    return sample;
  }
};

Motion any_motion(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Motion motion;
  for (auto& c : motion.terms) c = {10 * unit(random), 20 + 5 * unit(random), 100 * unit(random), 1000 * unit(random)};
  return motion;
}

/// The hit at `hit_s`, counted in cycle 10; latches are told in `told` cycles more.
std::optional<HitFinder::Found> find(const Motion& motion, double hit_s, double hit_before_s, std::uint32_t latching,
                                     std::uint32_t latched, int told, int* samples = nullptr) {
  HitFinder finder;
  constexpr int kCycle = 10;
  for (int cycle = 0; cycle < 40; ++cycle) {
    CycleSample sample = motion.sample(cycle);
    sample.probe.latching = latching;
    if (cycle >= kCycle) sample.probe.hits = 1;
    if (cycle == kCycle) sample.probe.hit_before_s = hit_before_s;
    if (cycle >= kCycle + told) {
      sample.probe.latched = latched;
      for (std::size_t j = 0; j < 2; ++j) sample.probe.latched_position[j] = motion.at(j, hit_s);
    }
    if (const auto found = finder.read(sample)) {
      if (samples != nullptr) *samples = cycle - kCycle;
      return found;
    }
  }
  return {};
}

TEST(HitFinder, JoinsMeasuredPositionsToTheStampOfTheHit) {
  std::mt19937 random(1);  // NOLINT(cert-msc51-cpp): the same motions every time
  for (int i = 0; i < 200; ++i) {
    const Motion motion = any_motion(random);
    const double hit_s = 0.009 + i % 10 * 1e-4;
    const auto found = find(motion, hit_s, 0.010 - hit_s, 0, 0, 0);
    ASSERT_TRUE(found);
    EXPECT_DOUBLE_EQ(found->t_s, hit_s);
    for (std::size_t j = 0; j < 2; ++j) EXPECT_NEAR(found->joints[j], motion.at(j, hit_s), 1e-9);
  }
}

// Red when the position that a drive on CAN tells is taken for where its joint is now: 5 um at 5 mm/s and 1 kHz.
TEST(HitFinder, KnowsHowManyCyclesAgoDrivesWereWhereTheyTell) {
  std::mt19937 random(4);  // NOLINT(cert-msc51-cpp): the same motions every time
  for (int i = 0; i < 400; ++i) {
    Motion motion = any_motion(random);
    motion.delays = {static_cast<std::uint8_t>(random() % (kMostAnswerDelay + 1)),
                     static_cast<std::uint8_t>(random() % (kMostAnswerDelay + 1))};
    const double hit_s = 0.0091 + i % 9 * 1e-4;
    const auto stamped = find(motion, hit_s, 0.010 - hit_s, 0, 0, 0);
    ASSERT_TRUE(stamped);
    for (std::size_t j = 0; j < 2; ++j) EXPECT_NEAR(stamped->joints[j], motion.at(j, hit_s), 1e-9) << j;
    const auto latched = find(motion, hit_s, 0, 0b01, 0b01, 2);
    ASSERT_TRUE(latched);
    EXPECT_NEAR(latched->t_s, hit_s, 1e-8);
    EXPECT_NEAR(latched->joints[1], motion.at(1, hit_s), 1e-6);
  }
}

TEST(HitFinder, TakesTheInstantWithoutAStampFromTheJointThatWasLatched) {
  std::mt19937 random(2);  // NOLINT(cert-msc51-cpp): the same motions every time
  for (int i = 0; i < 200; ++i) {
    const Motion motion = any_motion(random);
    const double hit_s = 0.0091 + i % 9 * 1e-4;
    const auto found = find(motion, hit_s, 0, 0b01, 0b01, 2);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->t_s, hit_s, 1e-8);
    EXPECT_EQ(found->joints[0], motion.at(0, hit_s)) << "as its drive says";
    EXPECT_NEAR(found->joints[1], motion.at(1, hit_s), 1e-6);
  }
}

TEST(HitFinder, WaitsForWhatDrivesLatchedAndNotForEver) {
  std::mt19937 random(3);  // NOLINT(cert-msc51-cpp): the same motion every time
  const Motion motion = any_motion(random);
  int samples = 0;
  ASSERT_TRUE(find(motion, 0.0095, 0, 0b11, 0b11, 4, &samples));
  EXPECT_EQ(samples, 4);
  const auto found = find(motion, 0.0095, 0.0005, 0b11, 0b01, 1, &samples);
  ASSERT_TRUE(found);
  EXPECT_EQ(samples, 11) << "one of the drives has not latched it";
  EXPECT_EQ(found->joints[0], motion.at(0, 0.0095));
  EXPECT_NEAR(found->joints[1], motion.at(1, 0.0095), 1e-9);
}

}  // namespace
}  // namespace rmac::gateway
