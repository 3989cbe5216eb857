#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "gateway/collision/distance/solid.hpp"
#include "gateway/threads/sanitized.hpp"
#include "unit/gateway/collision/shapes.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using test::box_mesh;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vector3d direction() {
    std::normal_distribution<double> bell;
    return Vector3d(bell(engine_), bell(engine_), bell(engine_)).normalized();
  }
  Isometry3d pose(double far_mm) {
    Isometry3d made = Isometry3d::Identity();
    made.linear() = Eigen::AngleAxisd(within(-3, 3), direction()).toRotationMatrix();
    made.translation() = far_mm * direction();
    return made;
  }
  Convex convex() {
    const int kind = std::uniform_int_distribution<int>(0, 4)(engine_);
    if (kind == 0) return Convex::box({within(1, 100), within(1, 100), within(1, 100)});
    if (kind == 1) return Convex::sphere(within(1, 50));
    if (kind == 2) return Convex::cone(within(1, 50), 0, within(1, 80));
    if (kind == 3) return Convex::cone(within(1, 50), within(1, 50), within(1, 80), within(0, 5));
    const double radius = within(1, 50);
    return Convex::cone(radius, radius, within(1, 80));
  }

 private:
  std::mt19937_64 engine_;
};

TEST(Distance, OfSpheresIsThatOfTheirMiddlesLessTheirRadii) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const double r = random.within(0.1, 50), s = random.within(0.1, 50);
    const Isometry3d a = random.pose(random.within(0, 100)), b = random.pose(random.within(0, 100));
    const double truth = (a.translation() - b.translation()).norm() - r - s;
    const Apart apart = distance(Convex::sphere(r), a, Convex::sphere(s), b);
    EXPECT_NEAR(apart.most, std::max(0.0, truth), 1e-9) << i;
    if (truth < 0) {
      EXPECT_NEAR(overlap_depth(Convex::sphere(r), a, Convex::sphere(s), b), -truth, 1e-6 - 1e-4 * truth) << i;
    }
  }
}

TEST(Distance, IsBoundedFromBelowBySupportPlanesAndFromAboveByTwoPoints) {
  Random random(2);
  int apart_count = 0;
  for (int i = 0; i < (kSanitized ? 1000 : 20000); ++i) {
    const Convex a = random.convex(), b = random.convex();
    const Isometry3d at = random.pose(random.within(0, 150)), to = random.pose(random.within(0, 150));
    const Apart apart = distance(a, at, b, to);
    ASSERT_LE(apart.least, apart.most);
    if (apart.most == 0) continue;
    ++apart_count;
    EXPECT_LE(apart.most - apart.least, 1e-6 + 1e-7 * apart.most) << "scene " << i;
    EXPECT_NEAR((apart.on_first - apart.on_second).norm(), apart.most, 1e-7) << "scene " << i;
    // The truth by itself: along the line between the two points there is a plane between the solids.
    const Vector3d n = (apart.on_second - apart.on_first).normalized();
    const double reach_a = n.dot(at * a.support(at.linear().transpose() * n)) + a.rounded();
    const double reach_b = n.dot(to * b.support(to.linear().transpose() * -n)) - b.rounded();
    EXPECT_NEAR(reach_b - reach_a, apart.most, 2e-5) << "scene " << i;
  }
  EXPECT_GT(apart_count, kSanitized ? 250 : 5000);
}

TEST(Distance, SeesSolidsThatOverlapByAMicrometre) {
  Random random(3);
  for (int i = 0; i < (kSanitized ? 150 : 3000); ++i) {
    const Convex a = random.convex(), b = random.convex();
    const Isometry3d at = random.pose(50);
    Isometry3d to = random.pose(0);
    const Vector3d n = random.direction();
    // Placed so that b's farthest point along -n lies on a's farthest along n, then moved by a micrometre.
    const Vector3d tip = at * (a.support(at.linear().transpose() * n)) + n * a.rounded();
    const Vector3d foot = to.linear() * b.support(to.linear().transpose() * -n) - n * b.rounded();
    to.translation() = tip - foot + 1e-3 * n;
    const Apart apart = distance(a, at, b, to);
    EXPECT_GT(apart.most, 0) << "scene " << i;
    EXPECT_NEAR(apart.most, 1e-3, 1e-6) << "scene " << i;
    // Its foot a micrometre inside: a point of both.
    const Vector3d inwards = (at * a.middle() - tip).normalized();
    to.translation() = tip - foot + 1e-3 * inwards;
    const Apart met = distance(a, at, b, to);
    EXPECT_EQ(met.least, 0) << "scene " << i;
    EXPECT_LE(met.most, 1e-5) << "scene " << i << ": where so little is shared, digits end at 10 nm";
    EXPECT_LE(overlap_depth(a, at, b, to), 1e-3 + 1e-6) << "scene " << i;
  }
}

TEST(Distance, OfAMeshIsThatOfTheSameBox) {
  Random random(4);
  for (int i = 0; i < (kSanitized ? 300 : 5000); ++i) {
    const Vector3d half(random.within(1, 80), random.within(1, 80), random.within(1, 80));
    const Solid box(Convex::box(half)), mesh(box_mesh(half, 4)), other(random.convex()),
        plain(box_mesh({20, 30, 40}, 3));
    const Isometry3d at = random.pose(random.within(0, 150)), to = random.pose(random.within(0, 150));
    const double truth = distance(box, at, other, to, 1e9).most;
    const Apart apart = distance(mesh, at, other, to, 1e9);
    EXPECT_NEAR(apart.most, truth, 1e-6) << "scene " << i;
    const Apart swapped = distance(other, to, mesh, at, 1);
    EXPECT_LE(swapped.least, truth + 1e-9);
    EXPECT_GE(swapped.most, truth - 1e-6);
    EXPECT_GE(swapped.least, std::min(truth, 0.49 * truth) - 1e-6) << "scene " << i;
    EXPECT_NEAR(distance(mesh, at, plain, to, 1e9).most,
                distance(box, at, Solid(Convex::box({20, 30, 40})), to, 1e9).most, 1e-6)
        << "scene " << i;
  }
}

TEST(Distance, IsNoneForWhatIsInsideOfAMesh) {
  const Solid mesh(box_mesh({50, 50, 50}, 5)), ball(Convex::sphere(5)), small(box_mesh({1, 2, 3}));
  Isometry3d at = Isometry3d::Identity();
  at.translation() = Vector3d(10, 20, 30);
  EXPECT_EQ(distance(mesh, Isometry3d::Identity(), ball, at, 1).most, 0);
  EXPECT_EQ(distance(small, at, mesh, Isometry3d::Identity(), 1).most, 0);
  EXPECT_GT(overlap_depth(mesh, Isometry3d::Identity(), ball, at), 10);
  at.translation() = Vector3d(60, 0, 0);
  EXPECT_NEAR(distance(mesh, Isometry3d::Identity(), ball, at, 1).most, 5, 1e-9);
}

TEST(OverlapDepth, OfAPinInAMeshIsHowFarItWentIn) {
  const Solid mesh(box_mesh({50, 50, 50}, 5)), pin(Convex::cone(3, 3, 40));
  for (const double depth : {1e-3, 0.1, 1.0, 10.0}) {
    Isometry3d at = Isometry3d::Identity();
    at.translation() = Vector3d(7, -11, 50 + 40 - depth);
    EXPECT_NEAR(overlap_depth(mesh, Isometry3d::Identity(), pin, at), depth, 1e-6 * (1 + depth)) << depth;
  }
}

}  // namespace
}  // namespace rmac::gateway
