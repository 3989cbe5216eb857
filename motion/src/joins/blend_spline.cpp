#include "joins/blend_spline.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace rmac {
namespace {

constexpr std::size_t kDegree = 3;
/// Weight of the third derivative itself beside the shape's pattern: decides where the pattern leaves something open.
constexpr double kRidge = 1e-2;

}  // namespace

BlendSpline::BlendSpline(const CurvePoint& before, const CurvePoint& after, double reach, const CornerShape& shape) {
  lay_knots(shape);
  // The outer three control points on either side carry value and two derivatives (The NURBS Book, eq. 3.8).
  const std::size_t last = intervals_ + 2;
  const double rate = reach * shape.entry_speed, gain = reach * shape.entry_acceleration;
  const double h0 = knots_[1] - knots_[0], h1 = knots_[2] - knots_[0];
  const double g0 = knots_[intervals_] - knots_[intervals_ - 1], g1 = knots_[intervals_] - knots_[intervals_ - 2];
  for (std::size_t c = 0; c < kCoordinates; ++c) {
    const double p = before.d[0][c], p1 = rate * before.d[1][c],
                 p2 = rate * rate * before.d[2][c] - gain * before.d[1][c];
    points_[0][c] = p;
    points_[1][c] = p + h0 / 3 * p1;
    points_[2][c] = points_[1][c] + h1 / 3 * (p1 + p2 * h0 / 2);
    const double q = after.d[0][c], q1 = rate * after.d[1][c], q2 = rate * rate * after.d[2][c] + gain * after.d[1][c];
    points_[last][c] = q;
    points_[last - 1][c] = q - g0 / 3 * q1;
    points_[last - 2][c] = points_[last - 1][c] - g1 / 3 * (q1 - q2 * g0 / 2);
  }
  solve_free(shape.lobe > 0);
  fill_pieces();
}

void BlendSpline::lay_knots(const CornerShape& shape) {
  const double flat = shape.flat, outer = shape.lobe > 0 ? shape.lobe : 0.5 * (1 - flat);
  if (flat > 0) {
    intervals_ = 5;
    knots_ = {-1, -1 + outer, -flat, flat, 1 - outer, 1};
  } else {
    intervals_ = 4;
    knots_ = {-1, -1 + outer, 0, 1 - outer, 1, 0};
  }
  const auto knot = [this](std::ptrdiff_t i) {
    return knots_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, static_cast<std::ptrdiff_t>(intervals_)))];
  };
  // Derivatives of the basis, three times over (docs/derivations/curves.md, eq. 4), one control point at a time.
  const std::size_t count = intervals_ + kDegree;
  for (std::size_t k = 0; k < count; ++k) {
    std::array<double, kMostIntervals + kDegree> row{};
    row[k] = 1;
    for (std::size_t order = 1; order <= kDegree; ++order) {
      for (std::size_t i = 0; i + order < count; ++i) {
        // Flat knots begin with kDegree repetitions.
        const auto first = static_cast<std::ptrdiff_t>(i + order) - static_cast<std::ptrdiff_t>(kDegree);
        const auto end = static_cast<std::ptrdiff_t>(i) + 1;
        row[i] = static_cast<double>(kDegree - order + 1) / (knot(end) - knot(first)) * (row[i + 1] - row[i]);
      }
    }
    for (std::size_t i = 0; i < intervals_; ++i) third_[i][k] = row[i];
  }
}

void BlendSpline::solve_free(bool lobed) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 8, 8>;
  const std::size_t first = kDegree, free = intervals_ - kDegree;
  const std::size_t n = intervals_;
  const double ratio = lobed ? -1 : 1;
  // The pattern: outer and next third derivative equal, or opposite where there is a lobe; none on the flat.
  Matrix pattern = Matrix::Zero(static_cast<Eigen::Index>(3 + n), static_cast<Eigen::Index>(n));
  const auto at = [](std::size_t i) { return static_cast<Eigen::Index>(i); };
  pattern(0, 0) = 1;
  pattern(0, 1) = -ratio;
  pattern(1, at(n - 1)) = 1;
  pattern(1, at(n - 2)) = -ratio;
  if (n == 5) pattern(2, 2) = 1;
  for (std::size_t i = 0; i < n; ++i) pattern(at(3 + i), at(i)) = kRidge;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 5, 8> third(at(n), at(n + kDegree));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n + kDegree; ++k) third(at(i), at(k)) = third_[i][k];
  }
  const Matrix rows = pattern * third;
  const Matrix unknown = rows.middleCols(at(first), at(free));
  const Matrix normal = unknown.transpose() * unknown;
  const auto factor = normal.ldlt();
  for (std::size_t c = 0; c < kCoordinates; ++c) {
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1> known(at(n + kDegree));
    for (std::size_t k = 0; k < n + kDegree; ++k) {
      const bool is_free = k >= first && k < first + free;
      known(at(k)) = is_free ? 0 : points_[k][c] - points_[0][c];
    }
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1> solved =
        factor.solve(unknown.transpose() * (rows * known) * -1.0);
    for (std::size_t k = 0; k < free; ++k) points_[first + k][c] = points_[0][c] + solved(at(k));
  }
}

void BlendSpline::fill_pieces() {
  const double h0 = knots_[1] - knots_[0], h1 = knots_[2] - knots_[0];
  for (std::size_t c = 0; c < kCoordinates; ++c) {
    std::array<double, 4> d;
    d[0] = points_[0][c];
    d[1] = 3 / h0 * (points_[1][c] - points_[0][c]);
    d[2] = 2 / h0 * (3 / h1 * (points_[2][c] - points_[1][c]) - d[1]);
    for (std::size_t i = 0; i <= intervals_; ++i) {
      d[3] = 0;
      for (std::size_t k = 0; i < intervals_ && k < intervals_ + kDegree; ++k)
        d[3] += third_[i][k] * (points_[k][c] - points_[0][c]);
      for (std::size_t order = 0; order < 4; ++order) pieces_[i][order][c] = d[order];
      if (i == intervals_) break;
      const double h = knots_[i + 1] - knots_[i];
      d[0] += h * (d[1] + h * (d[2] / 2 + h * d[3] / 6));
      d[1] += h * (d[2] + h * d[3] / 2);
      d[2] += h * d[3];
    }
  }
}

BlendSpline::Values BlendSpline::at(double u) const noexcept {
  std::size_t i = 0;
  while (i + 1 < intervals_ && u >= knots_[i + 1]) ++i;
  const double h = u - knots_[i];
  Values value;
  for (std::size_t c = 0; c < kCoordinates; ++c) {
    const auto& d = pieces_[i];
    value[c] = d[0][c] + h * (d[1][c] + h * (d[2][c] / 2 + h * d[3][c] / 6));
  }
  return value;
}

double BlendSpline::largest_second(std::size_t first, std::size_t last) const noexcept {
  // Linear between knots, so its length is largest at one of them.
  double most = 0;
  for (std::size_t i = 0; i <= intervals_; ++i) {
    double sum = 0;
    for (std::size_t c = first; c < last; ++c) sum += pieces_[i][2][c] * pieces_[i][2][c];
    most = std::max(most, sum);
  }
  return std::sqrt(most);
}

Nurbs BlendSpline::nurbs(std::size_t dimension) const {
  Nurbs nurbs;
  nurbs.degree = static_cast<int>(kDegree);
  nurbs.dimension = dimension;
  nurbs.knots.assign(kDegree, knots_[0]);
  nurbs.knots.insert(nurbs.knots.end(), knots_.begin(), knots_.begin() + static_cast<std::ptrdiff_t>(intervals_) + 1);
  nurbs.knots.insert(nurbs.knots.end(), kDegree, knots_[intervals_]);
  for (std::size_t k = 0; k < intervals_ + kDegree; ++k)
    nurbs.points.emplace_back(points_[k].begin(), points_[k].begin() + static_cast<std::ptrdiff_t>(dimension));
  return nurbs;
}

}  // namespace rmac
