#include "gateway/material/removal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "gateway/threads/sanitized.hpp"
#include "unit/gateway/material/solids.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;
using test::block, test::direction, test::remove_along, test::volume_of;
constexpr double kPi = std::numbers::pi;

/// Every ray's material begins and ends on the block's side or on the surface of what was taken away, and the middle of
/// each cell is in material for the rays of all three families where it is outside of that. `outside`: the distance
/// from it, negative within.
void expect_left(const DexelGrid& grid, double half_mm, double tolerance_mm,
                 const std::function<double(const Vector3d&)>& outside) {
  const DexelLayout& layout = grid.layout();
  std::size_t seen = 0;
  double farthest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = DexelLayout::across(axis, 0), v = DexelLayout::across(axis, 1);
    for (std::uint32_t j = 0; j < layout.count[v]; ++j) {
      for (std::uint32_t i = 0; i < layout.count[u]; ++i) {
        Vector3d point;
        point[static_cast<Eigen::Index>(u)] = layout.line(u, i),
        point[static_cast<Eigen::Index>(v)] = layout.line(v, j);
        const std::size_t ray = grid.ray(axis, i, j);
        grid.pieces(axis, ray, [&](const DexelGrid::Piece& piece) {
          for (const float end : {piece.from, piece.to}) {
            const double at = layout.low[axis] + double{end};
            if (std::abs(std::abs(at) - half_mm) < 1e-5) continue;
            point[static_cast<Eigen::Index>(axis)] = at;
            farthest = std::max(farthest, std::abs(outside(point)));
            ++seen;
          }
        });
        for (std::uint32_t k = 0; k < layout.count[axis]; k += 3) {
          const double at = layout.line(axis, k);
          point[static_cast<Eigen::Index>(axis)] = at;
          const double distance = outside(point);
          if (std::abs(distance) < tolerance_mm + 1e-4) continue;
          ASSERT_EQ(grid.holds(axis, ray, static_cast<float>(at - layout.low[axis])), distance > 0)
              << "axis " << axis << " at " << point.transpose() << ", " << distance << " outside";
        }
      }
    }
  }
  EXPECT_GT(seen, 100U);
  EXPECT_LE(farthest, tolerance_mm + 2e-5);
}

double from_segment(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  const Vector3d way = b - a;
  const double part = std::clamp((point - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (point - a - part * way).norm();
}

const ProfilePiece kBall{.kind = ProfilePiece::Kind::Ball, .middle = 3, .rounded = 3};

TEST(Removal, OfABallAlongALineLeavesItsCapsule) {
  std::mt19937_64 random(1);
  for (const double resolution : {0.6, 0.3, 0.15}) {
    for (int n = 0; n < (kSanitized ? 1 : 4); ++n) {
      SCOPED_TRACE(testing::Message() << resolution << " mm, " << n);
      DexelGrid grid = block(20, resolution);
      const Vector3d a = 3 * direction(random), b = a + 3.5 * direction(random);
      const double before = grid.volume_mm3();
      const double removed = volume_of(cut(grid, sweep_of(kBall, {a, b, Vector3d::UnitZ()}), Cut::Remove));
      const double true_volume = kPi * 9 * (b - a).norm() + 4.0 / 3 * kPi * 27;
      EXPECT_NEAR(removed / true_volume, 1, 0.002 * resolution / 0.15);
      EXPECT_NEAR(before - grid.volume_mm3(), removed, 1e-6 * before);
      expect_left(grid, 10, 0, [&](const Vector3d& p) { return from_segment(p, a, b) - 3; });
      // What is gone is not met again.
      EXPECT_LT(volume_of(cut(grid, sweep_of(kBall, {a, b, Vector3d::UnitZ()}), Cut::Look)), 1e-4);
    }
  }
}

TEST(Removal, OfABallAlongACircleLeavesItsTorusToTheToleranceOfItsStrokes) {
  std::mt19937_64 random(2);
  for (const double tolerance : {0.02, 0.002}) {
    for (int n = 0; n < (kSanitized ? 1 : 3); ++n) {
      SCOPED_TRACE(testing::Message() << tolerance << " mm, " << n);
      DexelGrid grid = block(20, 0.2);
      const Vector3d normal = direction(random), x = normal.unitOrthogonal(), y = normal.cross(x);
      // The ball's middle is on the circle, whichever way the tool leans.
      const double removed = remove_along(grid, kBall, tolerance, 4000, [&](double t) {
        const Vector3d axis = (normal + std::sin(7 * t) * x).normalized();
        return ToolAt{5 * (std::cos(2 * kPi * t) * x + std::sin(2 * kPi * t) * y) - 3 * axis, axis};
      });
      EXPECT_NEAR(removed / (2 * kPi * kPi * 5 * 9), 1, 0.002);
      expect_left(grid, 10, tolerance, [&](const Vector3d& p) {
        const double up = p.dot(normal), out = (p - up * normal).norm();
        return std::hypot(out - 5, up) - 3;
      });
    }
  }
}

const ProfilePiece kFlat{
    .kind = ProfilePiece::Kind::Cone, .middle = 2, .bottom_radius = 2, .top_radius = 2, .height = 4};

TEST(Removal, OfAFlatEndAcrossItsAxisIsASlot) {
  std::mt19937_64 random(3);
  for (int n = 0; n < 6; ++n) {
    SCOPED_TRACE(n);
    DexelGrid grid = block(16, 0.2);
    const Vector3d axis = n == 0 ? Vector3d(Vector3d::UnitZ()) : direction(random), way = 4 * axis.unitOrthogonal();
    const Vector3d a = -way / 2 + direction(random), b = a + way;
    const double removed = volume_of(cut(grid, sweep_of(kFlat, {a, b, axis}), Cut::Remove));
    EXPECT_NEAR(removed / ((kPi * 4 + 4 * 4) * 4), 1, 0.005);
    expect_left(grid, 8, 0, [&](const Vector3d& p) {
      const double up = std::abs((p - a).dot(axis)) - 2;
      const Vector3d flat = p - (p - a).dot(axis) * axis;
      const double out = from_segment(flat, a, b) - 2;
      return up > 0 && out > 0 ? std::hypot(up, out) : std::max(up, out);
    });
  }
}

TEST(Removal, OfAFlatEndThatDrillsIsACylinderWhereverItLeans) {
  std::mt19937_64 random(4);
  for (int n = 0; n < 4; ++n) {
    DexelGrid grid = block(16, 0.2);
    const Vector3d axis = direction(random), a = direction(random);
    const double removed = volume_of(cut(grid, sweep_of(kFlat, {a, a - 3 * axis, axis}), Cut::Remove));
    EXPECT_NEAR(removed / (kPi * 4 * 7), 1, 0.005) << n;
  }
}

TEST(Removal, OfAConeIsAThirdOfItsCylinder) {
  std::mt19937_64 random(5);
  const ProfilePiece cone{
      .kind = ProfilePiece::Kind::Cone, .middle = 3, .bottom_radius = 0, .top_radius = 4, .height = 6};
  for (int n = 0; n < 4; ++n) {
    DexelGrid grid = block(20, 0.2);
    const Vector3d axis = direction(random), a = direction(random);
    const double removed = volume_of(cut(grid, sweep_of(cone, {a, a, axis}), Cut::Remove));
    EXPECT_NEAR(removed / (kPi * 16 * 6 / 3), 1, 0.005) << n;
    // On its way along its axis it widens by what it is wide.
    const double more = volume_of(cut(grid, sweep_of(cone, {a, a + 2 * axis, axis}), Cut::Remove));
    EXPECT_NEAR(more / (kPi * 16 * 2), 1, 0.01) << n;
  }
}

/// Half a turn of a flat end about its own tip: what its side passes, its bottom does too. A cylinder of radius r and
/// height h that turns about a diameter of its lower end covers, to each side, what a dense check by points says.
TEST(Removal, OfAToolThatTurnsIsWhatItsPositionsCoverToTheTolerance) {
  std::mt19937_64 random(6);
  for (int n = 0; n < (kSanitized ? 1 : 3); ++n) {
    SCOPED_TRACE(n);
    const double tolerance = 0.01;
    DexelGrid grid = block(16, 0.3);
    const Vector3d normal = direction(random), x = normal.unitOrthogonal(), y = normal.cross(x),
                   drift = 2 * direction(random);
    const auto at = [&](double t) { return ToolAt{drift * t, (std::cos(t) * x + std::sin(t) * y).normalized()}; };
    remove_along(grid, kFlat, tolerance, 3000, at);
    std::uniform_real_distribution<double> any(-7, 7);
    const DexelLayout& layout = grid.layout();
    int inside = 0, outside = 0;
    for (int k = 0; k < 4000; ++k) {
      std::array<std::uint32_t, 3> cell{};
      Vector3d p;
      for (std::size_t a = 0; a < 3; ++a) {
        cell[a] = static_cast<std::uint32_t>(random() % layout.count[a]);
        p[static_cast<Eigen::Index>(a)] = layout.line(a, cell[a]);
      }
      if (p.norm() > 6) continue;
      double deepest = -1e9;
      for (int i = 0; i <= 4000; ++i) {
        const ToolAt tool = at(i / 4000.0);
        const double up = (p - tool.tip).dot(tool.axis), out = (p - tool.tip - up * tool.axis).norm();
        deepest = std::max(deepest, std::min({up, 4 - up, 2 - out}));
      }
      if (std::abs(deepest) < tolerance + 1e-3) continue;
      ++(deepest > 0 ? inside : outside);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t u = DexelLayout::across(axis, 0), v = DexelLayout::across(axis, 1);
        const auto i = static_cast<Eigen::Index>(axis);
        EXPECT_EQ(grid.holds(axis, grid.ray(axis, cell[u], cell[v]), static_cast<float>(p[i] - layout.low[axis])),
                  deepest < 0)
            << p.transpose() << ": " << deepest;
      }
    }
    EXPECT_GT(inside, 50);
    EXPECT_GT(outside, 50);
  }
}

/// Short strokes one behind the other, as motion along a curve is cut into.
std::vector<Sweep> chain(const ProfilePiece& piece, const Vector3d& axis, const Vector3d& begin,
                         std::mt19937_64& random) {
  std::uniform_real_distribution<double> step(0.02, 0.8);
  std::vector<Sweep> sweeps;
  const Vector3d bend = 0.1 * direction(random);
  Vector3d at = begin, ahead = direction(random);
  for (int k = 0; k < 40; ++k) {
    const Vector3d next = at + step(random) * ahead;
    sweeps.push_back(sweep_of(piece, {at, next, axis}));
    at = next;
    if (k % 10 > 4) ahead = (ahead + bend).normalized();  // straight and bent in turn
  }
  return sweeps;
}

/// How much of what one has on its rays the other has not, on the ray where that is the most.
double most_missing(const DexelGrid& of, const DexelGrid& in) {
  double most = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t ray = 0; ray < of.layout().rays(axis); ++ray) {
      double missing = 0;
      of.pieces(axis, ray, [&](const DexelGrid::Piece& piece) {
        missing += double{piece.to - piece.from} - double{in.between(axis, ray, piece.from, piece.to)};
      });
      most = std::max(most, missing);
    }
  }
  return most;
}

/// Of many sweeps together most are not looked at on most rays, because others take all that they would: this is told
/// of none of which it is not so.
TEST(Removal, OfSweepsTogetherIsThatOfOneAfterTheOther) {
  std::mt19937_64 random(8);
  ProfilePiece cone = kFlat, disc = kFlat;
  cone.top_radius = 3;
  disc.kind = ProfilePiece::Kind::RoundedDisc, disc.rounded = 1;
  for (const ProfilePiece& piece : {kBall, kFlat, cone, disc}) {
    // A line that grazes a rounded disc is found to a ten-millionth across the surface, and to less along itself.
    const double tolerance = piece.kind == ProfilePiece::Kind::RoundedDisc ? 2e-3 : 1e-5;
    for (int n = 0; n < (kSanitized ? 1 : 6); ++n) {
      SCOPED_TRACE(testing::Message() << "piece " << static_cast<int>(piece.kind) << ", " << n);
      const Vector3d axis = n % 2 == 0 ? Vector3d(Vector3d::UnitZ()) : direction(random), begin = 5 * direction(random);
      DexelGrid together = block(20, 0.2), single = together;
      // The second chain finds a slot, and rays with two pieces.
      for (int pass = 0; pass < 2; ++pass) {
        const std::vector<Sweep> sweeps = chain(piece, axis, begin, random);
        double removed = 0;
        for (const Sweep& sweep : sweeps) removed += volume_of(cut(single, sweep, Cut::RemoveAndTell));
        EXPECT_NEAR(volume_of(cut(together, sweeps, Cut::Remove)) / removed, 1, 1e-6);
      }
      EXPECT_LT(most_missing(together, single), tolerance);
      EXPECT_LT(most_missing(single, together), tolerance);
    }
  }
}

TEST(Removal, TellsWhereAndHowDeepWhatItOnlyLooksAt) {
  DexelGrid grid = block(20, 0.2);
  const double before = grid.volume_mm3();
  // From above, half a millimetre below the top.
  const Removal met = cut(grid, sweep_of(kFlat, {{1, 2, 15}, {1, 2, 11.5}, Vector3d::UnitZ()}), Cut::Look);
  EXPECT_NEAR(met.depth_mm, 0.5, 1e-5);
  EXPECT_NEAR(met.place[2], 9.75, 0.25);
  EXPECT_NEAR(std::hypot(met.place[0] - 1, met.place[1] - 2), 0, 2);
  EXPECT_EQ(grid.volume_mm3(), before);
  EXPECT_EQ(cut(grid, sweep_of(kFlat, {{1, 2, 15}, {1, 2, 12.5}, Vector3d::UnitZ()}), Cut::Look).depth_mm, 0);
}

}  // namespace
}  // namespace rmac::gateway
