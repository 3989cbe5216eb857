#include "gateway/dynamics/path_deviation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;

constexpr double kCycle_s = 0.001, kRadius_mm = 20, kSpeed_mm_s = 100;

Vector3d on_circle(double t_s, double radius = kRadius_mm) {
  const double angle = kSpeed_mm_s * t_s / kRadius_mm;
  return radius * Vector3d(std::cos(angle), std::sin(angle), 0);
}

PathDeviation::Cycle at(int i, const Vector3d& truth) {
  const Vector3d planned = on_circle(i * kCycle_s);
  return {.planned = planned, .truth = truth, .place = planned, .t_s = i * kCycle_s, .line = 7, .move_id = i / 500};
}

TEST(PathDeviations, AreNoneOfATipThatComesLateOrEarly) {
  for (const double late : {-12.0, -3.5, 0.0, 4.2, 25.0, 90.0}) {
    PathDeviation deviation(0);
    for (int i = 0; i < 2000; ++i) deviation.add(at(i, on_circle(std::clamp(i - late, 0.0, 1999.0) * kCycle_s)));
    deviation.forget();
    // Between two cycles the path is the line between their tips.
    constexpr double kSagitta_mm = 0.1 * 0.1 / 8 / kRadius_mm;
    EXPECT_LE(deviation.peak_mm(), 1.01 * kSagitta_mm) << late;
  }
}

TEST(PathDeviations, AreHowFarATipIsBesideThePathWheneverItGetsThere) {
  std::mt19937_64 random(11);
  for (int k = 0; k < 20; ++k) {
    const double beside = std::uniform_real_distribution<>(-0.3, 0.3)(random);
    const double late = std::uniform_real_distribution<>(0, 60)(random);
    PathDeviation deviation(0);
    for (int i = 0; i < 1500; ++i) {
      deviation.add(at(i, on_circle(std::max(i - late, 0.0) * kCycle_s, kRadius_mm + beside)));
    }
    deviation.forget();
    EXPECT_NEAR(deviation.peak_mm(), std::abs(beside), 1e-4);
    EXPECT_NEAR(deviation.rms_mm(), std::abs(beside), 1e-4);
  }
}

TEST(PathDeviations, TellEachTimeOnEndThatATipIsFartherThanAllowed) {
  PathDeviation deviation(0.05);
  const auto beside = [](int i) {
    return i > 600 && i <= 700 ? 0.08 : i > 710 && i <= 850 ? 0.06 : i > 1200 ? 0.2 : 0.01;
  };
  for (int i = 0; i < 1300; ++i) deviation.add(at(i, on_circle(i * kCycle_s, kRadius_mm + beside(i))));
  deviation.forget();
  ASSERT_EQ(deviation.off_path().size(), 2U) << "a pause of ten cycles is none";
  const OffPath& first = deviation.off_path()[0];
  EXPECT_EQ(first.line, 7);
  EXPECT_EQ(first.move_id, 1);
  EXPECT_NEAR(first.t_s, 0.601, 1e-9);
  EXPECT_NEAR(first.until_s, 0.850, 1e-9);
  EXPECT_NEAR(first.most_mm, 0.08, 1e-4);
  EXPECT_EQ(first.allowed_mm, 0.05);
  EXPECT_LT((first.place - on_circle(0.65)).norm(), 0.1 * 51);
  EXPECT_LT((first.place - on_circle(first.most_t_s)).norm(), 1e-9) << "the place is where it was then";
  EXPECT_EQ(deviation.off_path()[1].move_id, 2);
  EXPECT_NEAR(deviation.off_path()[1].t_s, 1.201, 1e-9);
}

// Red when a cycle is left out, told twice or under another's time, where old cycles go and where the path is
// forgotten.
TEST(PathDeviations, AreToldOfEachCycleInTurn) {
  constexpr int kCycles = 9000, kForgets = 5000;
  PathDeviation deviation(0);
  std::vector<double> told_s, told_mm;
  deviation.on_judged([&](double t_s, double off_mm) { told_s.push_back(t_s), told_mm.push_back(off_mm); });
  const auto beside = [](int i) { return 0.02 * std::abs(std::sin(i * 0.001)); };
  for (int i = 0; i < kCycles; ++i) {
    if (i == kForgets) deviation.forget();
    deviation.add(at(i, on_circle(i * kCycle_s, kRadius_mm + beside(i))));
  }
  EXPECT_LT(told_s.size(), static_cast<std::size_t>(kCycles)) << "the last ones wait for what comes after them";
  deviation.forget();
  ASSERT_EQ(told_s.size(), static_cast<std::size_t>(kCycles));
  for (int i = 0; i < kCycles; ++i) {
    const auto n = static_cast<std::size_t>(i);
    EXPECT_EQ(told_s[n], i * kCycle_s);
    EXPECT_NEAR(told_mm[n], beside(i), 1e-4) << i;
  }
  EXPECT_EQ(*std::ranges::max_element(told_mm), deviation.peak_mm());
}

TEST(PathDeviations, DoNotHoldATipToThePathOfAnotherTool) {
  PathDeviation deviation(0);
  for (int i = 0; i < 100; ++i) deviation.add(at(i, on_circle(i * kCycle_s)));
  deviation.forget();
  // The same motion with a longer tool: beside each other, the two paths are one.
  for (int i = 100; i < 200; ++i) {
    PathDeviation::Cycle cycle = at(i, on_circle(i * kCycle_s));
    cycle.planned.z() -= 30;
    cycle.truth.z() -= 30.01;
    deviation.add(cycle);
  }
  deviation.forget();
  EXPECT_NEAR(deviation.peak_mm(), 0.01, 1e-6);
}

// However long a program is, what is kept of it stays the same, and what is told is what a short one tells.
TEST(PathDeviations, AreToldOfLongPrograms) {
  PathDeviation deviation(0);
  double sum = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double beside = 0.01 * std::sin(i * 0.001);
    sum += beside * beside;
    deviation.add(at(i, on_circle(i * kCycle_s, kRadius_mm + beside)));
  }
  deviation.forget();
  EXPECT_NEAR(deviation.rms_mm(), std::sqrt(sum / 20'000), 1e-4);
}

}  // namespace
}  // namespace rmac::gateway
