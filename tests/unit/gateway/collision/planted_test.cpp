#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "gateway/collision/checker.hpp"
#include "gateway/threads/sanitized.hpp"
#include "rmac/modules/chain_kinematics.hpp"
#include "unit/gateway/collision/shapes.hpp"

// Collisions that are planted, and the truth about them by other means than the checker's: kinematics by hand, and the
// signed distance of a point from a box, a cylinder and a ball in closed form, looked for its least along the way.

namespace rmac::gateway {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Joints = std::array<double, 5>;

double evenly(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
double spread(std::mt19937_64& random, double low, double high) {
  return std::exp(evenly(random, std::log(low), std::log(high)));
}

/// A turntable C on a cradle A, and a spindle that X, Y and Z carry.
LinkChain trunnion() {
  using modules::ScrewAxis;
  const std::vector<ScrewAxis> axes{{JointType::Linear, {1, 0, 0}, {}},
                                    {JointType::Linear, {0, 1, 0}, {}},
                                    {JointType::Linear, {0, 0, 1}, {}},
                                    {JointType::Rotary, {1, 0, 0}, {0, 0, -60}},
                                    {JointType::Rotary, {0, 0, 1}, {}}};
  const modules::ChainKinematics kinematics(axes, {4, 3, 0, 1, 2}, Frame{});
  const std::vector<std::string> chain{"C", "A", "base", "X", "Y", "Z"}, names{"X", "Y", "Z", "A", "C"};
  const std::vector<std::pair<double, double>> limits(5, {-200, 200});
  return LinkChain::make(kinematics, chain, names, limits).value();
}

/// A point of the spindle, seen from the table, by hand.
Vector3d seen_from_table(const Joints& q, Vector3d p) {
  p += Vector3d(q[0], q[1], q[2]);
  const double a = q[3] * std::numbers::pi / 180, c = q[4] * std::numbers::pi / 180;
  p = {p[0], std::cos(a) * p[1] - std::sin(a) * (p[2] + 60), std::sin(a) * p[1] + std::cos(a) * (p[2] + 60) - 60};
  return {std::cos(c) * p[0] - std::sin(c) * p[1], std::sin(c) * p[0] + std::cos(c) * p[1], p[2]};
}

struct Obstacle {
  enum class Kind { Box, BoxMesh, Cylinder, Ball } kind = Kind::Box;
  Vector3d half{1, 1, 1};  ///< of a box; of a cylinder radius, nothing, half height; of a ball its radius
  Isometry3d at = Isometry3d::Identity();

  [[nodiscard]] double signed_distance(const Vector3d& point) const {
    const Vector3d p = at.inverse() * point;
    if (kind == Kind::Ball) return p.norm() - half[0];
    if (kind == Kind::Cylinder) {
      const double across = std::hypot(p[0], p[1]) - half[0], along = std::abs(p[2]) - half[2];
      return std::min(std::max(across, along), 0.0) + std::hypot(std::max(across, 0.0), std::max(along, 0.0));
    }
    const Vector3d beyond = p.cwiseAbs() - half;
    return std::min(beyond.maxCoeff(), 0.0) + beyond.cwiseMax(0.0).norm();
  }
  [[nodiscard]] Solid solid() const {
    if (kind == Kind::Ball) return Solid(Convex::sphere(half[0]));
    if (kind == Kind::Cylinder) return Solid(Convex::cone(half[0], half[0], half[2]));
    if (kind == Kind::Box) return Solid(Convex::box(half));
    return Solid(test::box_mesh(half, 4));
  }
};

struct Scene {
  Obstacle obstacle;
  Vector3d ball;  ///< where it sits on the spindle
  double radius = 1, clearance = 1;
  Joints from{}, way{};
  int steps = 1;

  [[nodiscard]] double gap(double u) const {
    Joints q = from;
    for (std::size_t j = 0; j < q.size(); ++j) q[j] += u * way[j];
    return obstacle.signed_distance(seen_from_table(q, ball)) - radius;
  }
  /// The least gap on the way: by samples, and around the best of them by thirds.
  [[nodiscard]] double least_gap() const {
    constexpr std::size_t kSamples = 4000;
    double length = 0;
    std::vector<double> gaps;
    for (std::size_t i = 0; i <= kSamples; ++i) gaps.push_back(gap(double(i) / kSamples));
    for (std::size_t i = 0; i < kSamples; ++i) length = std::max(length, std::abs(gaps[i + 1] - gaps[i]));
    double least = *std::min_element(gaps.begin(), gaps.end());
    for (std::size_t i = 1; i < kSamples; ++i) {
      if (gaps[i] > gaps[i - 1] || gaps[i] > gaps[i + 1] || gaps[i] > least + 2 * length) continue;
      double low = double(i - 1) / kSamples, high = double(i + 1) / kSamples;
      for (int k = 0; k < 60; ++k) {
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        if (gap(a) < gap(b)) {
          high = b;
        } else {
          low = a;
        }
      }
      least = std::min(least, gap((low + high) / 2));
    }
    return least;
  }
};

/// A ball that flies past or into an obstacle, thin ones too, by anything from a micrometre to a centimetre.
Scene planted(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Scene scene;
  std::normal_distribution<double> bell;
  scene.radius = spread(random, 0.2, 20);
  scene.ball = {evenly(random, -20, 20), evenly(random, -20, 20), evenly(random, -80, 0)};
  scene.clearance = std::array{0.001, 0.01, 0.1, 1.0}[random() % 4];
  scene.steps = std::array{1, 2, 7, 60}[random() % 4];
  for (std::size_t j = 0; j < 5; ++j) {
    scene.from[j] = evenly(random, -100, 100);
    scene.way[j] = random() % 3 == 0 ? 0 : evenly(random, -60, 60);
  }
  scene.way[0] += 5;
  scene.obstacle.kind = static_cast<Obstacle::Kind>(random() % 4);
  for (int c = 0; c < 3; ++c) scene.obstacle.half[c] = spread(random, 0.05, 60);
  scene.obstacle.at.linear() =
      Eigen::Quaterniond(bell(random), bell(random), bell(random), bell(random)).normalized().toRotationMatrix();
  // The ball's middle at some moment lies off a point of the surface by its radius, and a little more or less.
  const double u = evenly(random, 0, 1), depth = spread(random, 1e-3, 10) * (random() % 2 == 0 ? 1 : -1);
  Joints q = scene.from;
  for (std::size_t j = 0; j < 5; ++j) q[j] += u * scene.way[j];
  const Vector3d out = Vector3d(bell(random), bell(random), bell(random)).normalized();
  double far = 0, beyond = 200;
  for (int k = 0; k < 100; ++k) {
    const double middle = (far + beyond) / 2;
    (scene.obstacle.signed_distance(scene.obstacle.at.linear() * (middle * out)) < scene.radius - depth ? far
                                                                                                        : beyond) =
        middle;
  }
  scene.obstacle.at.translation() = seen_from_table(q, scene.ball) - scene.obstacle.at.linear() * (far * out);
  return scene;
}

std::vector<Finding> found(const Scene& scene) {
  std::vector<SceneBody> bodies;
  bodies.push_back({SceneBody::Kind::Fixture, "clamp", 0, scene.obstacle.solid(), scene.obstacle.at});
  bodies.push_back({SceneBody::Kind::Machine, "ball", 5, Solid(Convex::sphere(scene.radius)),
                    Isometry3d(Eigen::Translation3d(scene.ball))});
  CollisionChecker checker(trunnion(), std::move(bodies), Frame{}, scene.clearance);
  for (int k = 0; k <= scene.steps; ++k) {
    Joints q = scene.from;
    for (std::size_t j = 0; j < q.size(); ++j) q[j] += scene.way[j] * k / scene.steps;
    checker.advance(k * 0.001, q, {.id = k});
  }
  return checker.findings().sorted();
}

TEST(PlantedCollisions, AreFoundWhereTheyAreDeeperThanTheClearanceAndNoneIsInvented) {
  int deep = 0, apart = 0;
  const std::uint64_t scenes = kSanitized ? 50 : 1000;  // a sanitizer makes minutes of each second
  for (std::uint64_t seed = 1; seed <= scenes; ++seed) {
    const Scene scene = planted(seed);
    const double gap = scene.least_gap();
    const auto findings = found(scene);
    const bool collision = std::any_of(findings.begin(), findings.end(), [](const Finding& f) { return f.collision; });
    constexpr double kRounding_mm = 1e-6;
    if (gap < -scene.clearance) {
      ++deep;
      EXPECT_TRUE(collision) << "seed " << seed << ": " << -gap << " mm deep";
    } else if (gap > kRounding_mm) {
      ++apart;
      EXPECT_FALSE(collision) << "seed " << seed << ": " << gap << " mm apart";
      if (gap < 0.8 * scene.clearance) {
        EXPECT_EQ(findings.size(), 1u) << "seed " << seed << ": a near miss";
      }
    }
    EXPECT_TRUE(gap <= scene.clearance + kRounding_mm || findings.empty()) << "seed " << seed << ": " << gap;
    // It may come near twice: the nearest is told, or that they met.
    double nearest = 1e300;
    for (const Finding& f : findings) {
      nearest = std::min(nearest, f.collision ? 0.0 : f.distance_mm);
      if (f.collision) continue;
      EXPECT_GE(f.distance_mm, gap - kRounding_mm) << "seed " << seed;
    }
    if (!findings.empty()) {
      EXPECT_LE(nearest, std::max(gap, 0.0) + 0.2 * scene.clearance + kRounding_mm)
          << "seed " << seed << ", " << findings.size() << " findings";
    }
  }
  EXPECT_GT(deep, 0.2 * scenes);
  EXPECT_GT(apart, 0.1 * scenes);
}

TEST(PlantedCollisions, TellWhenTheyBeganAndHowDeepTheyAreAtTheLooks) {
  for (std::uint64_t seed = 2001; seed <= (kSanitized ? 2012 : 2200); ++seed) {
    Scene scene = planted(seed);
    scene.obstacle.kind = Obstacle::Kind::Ball;
    scene.steps = 200;
    const auto findings = found(scene);
    if (findings.empty() || !findings.front().collision) continue;
    const double u = findings.front().t_s / (0.001 * scene.steps);
    EXPECT_LE(scene.gap(u), 1e-6) << "seed " << seed;
    const double before = scene.gap(std::max(0.0, u - 1.0 / scene.steps));
    EXPECT_TRUE(u == 0 || before > 0) << "seed " << seed << ": it had begun a cycle before";
    EXPECT_LE(findings.front().depth_mm, -scene.least_gap() * (1 + 1e-4) + 1e-6) << "seed " << seed;
  }
}

}  // namespace
}  // namespace rmac::gateway
