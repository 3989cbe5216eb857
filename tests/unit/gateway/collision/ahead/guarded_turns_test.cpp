#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "gateway/collision/ahead/clear_way.hpp"
#include "gateway/collision/ahead/collision_guard.hpp"
#include "gateway/threads/sanitized.hpp"
#include "unit/motion/planner/planner_bench.hpp"

// The same on a turntable C in a cradle A: a ball at the tool interface, and a box on the table. Where the ball is,
// seen from the table, is asked of the forward kinematics, which the check does not use.

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 3, kClearance_mm = 0.5;

PlannerModel trunnion_model() {
  using modules::ScrewAxis;
  const std::vector<ScrewAxis> axes{{JointType::Linear, {1, 0, 0}, {}},
                                    {JointType::Linear, {0, 1, 0}, {}},
                                    {JointType::Linear, {0, 0, 1}, {}},
                                    {JointType::Rotary, {1, 0, 0}, {0, 0, -60}},
                                    {JointType::Rotary, {0, 0, 1}, {}}};
  PlannerModel model;
  model.kinematics = std::make_shared<modules::ChainKinematics>(axes, std::vector<std::size_t>{4, 3, 0, 1, 2}, Frame{});
  for (const char* name : {"X", "Y", "Z"})
    model.joints.push_back({name, JointType::Linear, JointLimitType::Limited, -200, 200, 300, 2000, 20000});
  for (const char* name : {"A", "C"})
    model.joints.push_back({name, JointType::Rotary, JointLimitType::Limited, -170, 170, 200, 1500, 20000});
  return model;
}

struct TurningBench {
  TurningBench() : guard(false), bench(trunnion_model()) {}
  ~TurningBench() { bench.planner.set_gate(nullptr); }

  void check(const Vector3d& half, const Vector3d& at) {
    const PlannerModel model = trunnion_model();
    const std::vector<std::string> chain{"C", "A", "base", "X", "Y", "Z"}, names{"X", "Y", "Z", "A", "C"};
    const std::vector<std::pair<double, double>> limits(5, {-170, 170});
    std::vector<SceneBody> bodies;
    bodies.push_back(
        {SceneBody::Kind::Fixture, "clamp", 0, Solid(Convex::box(half)), Eigen::Isometry3d(Eigen::Translation3d(at))});
    bodies.push_back(
        {SceneBody::Kind::Machine, "ball", 5, Solid(Convex::sphere(kRadius_mm)), Eigen::Isometry3d::Identity()});
    guard.put_in(std::make_shared<ClearWay>(LinkChain::make(*model.kinematics, chain, names, limits).value(),
                                            std::move(bodies), Frame{}, kClearance_mm));
    bench.planner.set_gate(&guard);
  }

  /// Positioning along the joints, and cuts that turn the tool on their way, with corners that are rounded. False where
  /// one cannot be built.
  bool run(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto uniform = [&](double most) { return std::uniform_real_distribution<double>(-most, most)(random); };
    std::vector<double> joints(5, 0.0);
    for (std::int64_t id = 1; id <= 7; ++id) {
      const bool cuts = id % 3 != 1;
      for (std::size_t j = 0; j < 5; ++j) joints[j] = cuts ? joints[j] + uniform(20) : uniform(j < 3 ? 70 : 80);
      if (std::abs(joints[3]) < 8) joints[3] = 8;  // the pole is another subject
      Move move{.id = id, .geometry = JointTargetGeometry{joints}, .feed_mm_s = 60};
      if (cuts) {
        move.geometry = LineGeometry{bench.builder.end_pose(), pose_of(joints.data())};
        move.tolerance_mm = 0.5;
        move.orientation_tolerance_deg = 2;
      }
      if (!bench.queue(move)) return false;
      joints.assign(bench.builder.end_joints().begin(), bench.builder.end_joints().end());
    }
    bench.planner.command(PathCommand::Run);
    return bench.run();
  }
  [[nodiscard]] ToolPose pose_of(const double* joints) const {
    ToolPose pose;
    trunnion_model().kinematics->forward({joints, 5}, Frame{}, pose);
    return pose;
  }
  [[nodiscard]] Vector3d ball(std::size_t i) const {
    ToolPose pose;
    kinematics->forward({bench.record[i].position.data(), 5}, Frame{}, pose);
    return {pose.tip[0], pose.tip[1], pose.tip[2]};
  }
  [[nodiscard]] double gap(std::size_t i, const Vector3d& half, const Vector3d& at) const {
    const Vector3d beyond = (ball(i) - at).cwiseAbs() - half;
    return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0) - kRadius_mm;
  }
  [[nodiscard]] double least_gap(const Vector3d& half, const Vector3d& at) const {
    double least = 1e300;
    for (std::size_t i = 0; i < bench.record.size(); ++i) least = std::min(least, gap(i, half, at));
    return least;
  }

  std::shared_ptr<const Kinematics> kinematics = trunnion_model().kinematics;
  CollisionGuard guard;
  rmac::test::PlannerBench bench;
};

// Red when a turn's reach is left out of the bound, when chords stand for a path that leaves them, or when a corner
// that is rounded in the axis is taken as it was programmed.
TEST(GuardedTurns, RestApartWhereSomethingIsInTheWayAndAreTheSamePathWhereNothingIs) {
  int held = 0, passed = 0;
  for (std::uint64_t seed = 1; seed <= (kSanitized ? 30 : 150); ++seed) {
    TurningBench free;
    if (!free.run(seed)) continue;
    std::mt19937_64 random(seed + 1000);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const Vector3d half(uniform(0.2, 8), uniform(0.2, 8), uniform(0.2, 8));
    Vector3d at = free.ball(random() % free.bench.record.size());
    for (int c = 0; c < 3; ++c) at[c] += uniform(-15, 15);
    if (free.gap(0, half, at) < 1) continue;
    TurningBench guarded;
    guarded.check(half, at);
    ASSERT_TRUE(guarded.run(seed)) << "seed " << seed;
    const double gap = free.least_gap(half, at);
    if (gap > 1.01 * kClearance_mm) {
      ++passed;
      ASSERT_FALSE(guarded.bench.planner.blocked()) << "seed " << seed << ": " << gap;
      ASSERT_EQ(guarded.bench.record.size(), free.bench.record.size()) << "seed " << seed;
      for (std::size_t i = 0; i < free.bench.record.size(); ++i) {
        ASSERT_EQ(guarded.bench.record[i].position, free.bench.record[i].position)
            << "seed " << seed << ", cycle " << i;
      }
    } else if (gap < 0.95 * kClearance_mm) {
      ++held;
      ASSERT_TRUE(guarded.bench.planner.blocked()) << "seed " << seed << ": " << gap;
      EXPECT_GE(guarded.least_gap(half, at), 0.96 * kClearance_mm) << "seed " << seed << ": on the way";
      EXPECT_GE(guarded.gap(guarded.bench.record.size() - 1, half, at), kClearance_mm) << "seed " << seed;
    }
  }
  EXPECT_GT(held, kSanitized ? 5 : 15);
  EXPECT_GT(passed, kSanitized ? 5 : 15);
}

}  // namespace
}  // namespace rmac::gateway
