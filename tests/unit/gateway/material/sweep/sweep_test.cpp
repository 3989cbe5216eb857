#include "gateway/material/sweep/sweep.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "gateway/threads/sanitized.hpp"
#include "unit/gateway/material/solids.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;
using test::direction;
using Kind = ProfilePiece::Kind;

/// How deep a point is within a piece that stands, by its definition; below 0: outside. Concave, as pieces are convex.
double depth_within(const ProfilePiece& piece, const Vector3d& middle, const Vector3d& axis, const Vector3d& point) {
  const double z = (point - middle).dot(axis);
  const double out = (point - middle - z * axis).norm();
  if (piece.kind == Kind::Ball) return piece.rounded - (point - middle).norm();
  if (piece.kind == Kind::RoundedDisc) return piece.rounded - std::hypot(std::max(0.0, out - piece.bottom_radius), z);
  const double up = z + piece.height / 2;
  const double radius = piece.bottom_radius + (piece.top_radius - piece.bottom_radius) * up / piece.height;
  return std::min({up, piece.height - up, radius - out});
}

/// The most that a concave function reaches, by sections.
double most(double low, double high, const std::function<double(double)>& of) {
  const double golden = (std::sqrt(5.0) - 1) / 2;
  for (int i = 0; i < 60; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    (of(a) > of(b) ? high : low) = of(a) > of(b) ? b : a;
  }
  return of((low + high) / 2);
}

struct Case {
  ProfilePiece piece;
  Stroke stroke;
  [[nodiscard]] double deepest(const Vector3d& point) const {
    return most(0, 1, [&](double t) {
      return depth_within(piece, stroke.from + t * (stroke.to - stroke.from), stroke.axis, point);
    });
  }
};

Case random_case(std::mt19937_64& random) {
  std::uniform_real_distribution<double> size(0.2, 4);
  Case made;
  made.piece.kind = static_cast<Kind>(random() % 3);
  made.piece.rounded = size(random);
  made.piece.bottom_radius = size(random);
  made.piece.top_radius = random() % 3 == 0 ? 0 : random() % 2 == 0 ? made.piece.bottom_radius : size(random);
  made.piece.height = size(random);
  made.stroke.from = size(random) * direction(random);
  // As machines move, too: along axes, across the tool, along it, and not at all.
  made.stroke.axis = random() % 2 == 0 ? Vector3d::UnitZ() : direction(random);
  Vector3d way = size(random) * direction(random);
  const auto special = random() % 5;
  if (special == 0) way = size(random) * Vector3d::UnitX();
  if (special == 1) way = -size(random) * made.stroke.axis;
  if (special == 2) way = size(random) * made.stroke.axis.cross(direction(random));
  if (special == 3 && random() % 3 == 0) way = Vector3d::Zero();
  made.stroke.to = made.stroke.from + way;
  return made;
}

/// Where a line enters and leaves the sweep the piece's surface is at its nearest; a line that is said to miss it has
/// no point within. Neither the conic nor Newton's steps are looked at: only what a piece is.
TEST(Sweep, BeginsAndEndsOnALineWhereSomePlaceOfThePieceOnItsWayDoes) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> offset(-1, 1);
  int met = 0, missed = 0;
  for (int n = 0; n < (kSanitized ? 300 : 3000); ++n) {
    const Case made = random_case(random);
    const std::size_t axis = random() % 3;
    const auto a = static_cast<Eigen::Index>(axis);
    std::visit(
        [&](const auto& swept) {
          const Eigen::AlignedBox3d box = swept.bounds();
          const Vector3d at =
              box.center() + Vector3d(offset(random), offset(random), offset(random)).cwiseProduct(box.sizes() / 2);
          double from = 0, to = 0;
          const bool meets = swept.along(axis)(at[(a + 1) % 3], at[(a + 2) % 3], from, to);
          const auto deepest = [&](double s) {
            Vector3d point = at;
            point[a] = s;
            return made.deepest(point);
          };
          SCOPED_TRACE(testing::Message() << "case " << n << ", kind " << static_cast<int>(made.piece.kind));
          if (!meets) {
            ++missed;
            EXPECT_LT(most(box.min()[a] - 1, box.max()[a] + 1, deepest), 1e-5);
            return;
          }
          ++met;
          EXPECT_NEAR(deepest(from), 0, 2e-6);
          EXPECT_NEAR(deepest(to), 0, 2e-6);
          EXPECT_GE(deepest((from + to) / 2), -1e-7);
          EXPECT_GE(from, box.min()[a] - 1e-6);
          EXPECT_LE(to, box.max()[a] + 1e-6);
          // A little outside is outside, a little inside is inside: it is the first entry and the last exit.
          const double beside = 1e-3;
          EXPECT_LT(deepest(from - beside), 0);
          EXPECT_LT(deepest(to + beside), 0);
        },
        sweep_of(made.piece, made.stroke));
  }
  EXPECT_GT(met, missed);
  EXPECT_GT(missed, 10);
}

TEST(Sweep, HasOfARowOfLinesWhatItHasOfEach) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> offset(-1, 1);
  int met = 0, missed = 0;
  for (int n = 0; n < (kSanitized ? 500 : 5000); ++n) {
    const Case made = random_case(random);
    const std::size_t axis = random() % 3;
    const auto u = static_cast<Eigen::Index>((axis + 1) % 3), v = static_cast<Eigen::Index>((axis + 2) % 3);
    std::visit(
        [&](const auto& swept) {
          const Eigen::AlignedBox3d box = swept.bounds();
          const double begin = box.center()[u] + offset(random) * box.sizes()[u] / 2;
          const double pitch = 0.1 * (offset(random) + 1);
          RayRow row{.first = {}, .second = box.center()[v] + offset(random) * box.sizes()[v] / 2};
          for (std::size_t i = 0; i < RayRow::kRays; ++i) row.first[i] = begin + static_cast<double>(i) * pitch;
          const auto lines = swept.along(axis);
          RowMet of_row;
          lines(row, of_row);
          for (std::size_t i = 0; i < RayRow::kRays; ++i) {
            double from = 0, to = 0;
            if (lines(row.first[i], row.second, from, to)) {
              ++met;
              EXPECT_NEAR(of_row.from[i], from, 1e-12) << "case " << n << ", line " << i;
              EXPECT_NEAR(of_row.to[i], to, 1e-12) << "case " << n << ", line " << i;
            } else {
              ++missed;
              EXPECT_GT(of_row.from[i], of_row.to[i]) << "case " << n << ", line " << i;
            }
          }
        },
        sweep_of(made.piece, made.stroke));
  }
  EXPECT_GT(met, missed);
  EXPECT_GT(missed, 1000);
}

TEST(Sweep, IsHeldByTheWiderOne) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> offset(-1, 1);
  for (int n = 0; n < (kSanitized ? 500 : 5000); ++n) {
    const Case made = random_case(random);
    const std::size_t axis = random() % 3;
    const auto a = static_cast<Eigen::Index>(axis);
    std::visit(
        [&](const auto& swept) {
          const Eigen::AlignedBox3d box = swept.bounds();
          const Vector3d at =
              box.center() + Vector3d(offset(random), offset(random), offset(random)).cwiseProduct(box.sizes() / 2);
          const double by = 0.3, aside = by * (offset(random) + 1) / 2;
          const double turn = 3 * offset(random), u = at[(a + 1) % 3], v = at[(a + 2) % 3];
          double from = 0, to = 0, wide_from = 0, wide_to = 0;
          if (!swept.along(axis)(u, v, from, to)) return;
          ASSERT_TRUE(
              swept.wider(by).along(axis)(u + aside * std::cos(turn), v + aside * std::sin(turn), wide_from, wide_to))
              << n;
          EXPECT_LE(wide_from, from + 1e-6) << n;
          EXPECT_GE(wide_to, to - 1e-6) << n;
        },
        sweep_of(made.piece, made.stroke));
  }
}

}  // namespace
}  // namespace rmac::gateway
