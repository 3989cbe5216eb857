#include "splines/quintic.hpp"

#include <algorithm>
#include <cmath>

#include "curves/vector.hpp"

namespace rmac::quintic {
namespace {

/// Values of the `degree` + 1 basis functions of that degree on the span that begins with knot `span`.
std::array<double, kDegree + 1> functions(const std::vector<double>& knots, std::size_t span, double x,
                                          std::size_t degree) {
  std::array<double, kDegree + 1> n{}, left{}, right{};
  n[0] = 1;
  for (std::size_t j = 1; j <= degree; ++j) {
    left[j] = x - knots[span + 1 - j];
    right[j] = knots[span + j] - x;
    double saved = 0;
    for (std::size_t r = 0; r < j; ++r) {
      const double share = n[r] / (right[r + 1] + left[j - r]);
      n[r] = saved + right[r + 1] * share;
      saved = left[j - r] * share;
    }
    n[j] = saved;
  }
  return n;
}

}  // namespace

std::size_t span_of(const std::vector<double>& knots, std::size_t count, double x) {
  const auto first = knots.begin() + kDegree, last = knots.begin() + static_cast<std::ptrdiff_t>(count);
  const auto above = std::upper_bound(first, last, x);
  return static_cast<std::size_t>(above - knots.begin()) - 1;
}

Basis basis(const std::vector<double>& knots, std::size_t count, double x) {
  const std::size_t span = span_of(knots, count, x);
  return {span - kDegree, functions(knots, span, x, kDegree)};
}

Basis derivatives(const std::vector<double>& knots, std::size_t count, double x, std::size_t order) {
  const std::size_t span = span_of(knots, count, x);
  Basis result{span - kDegree, {}};
  const auto lower = functions(knots, span, x, kDegree - order);
  for (std::size_t a = 0; a <= kDegree; ++a) {
    // The control points of the derivatives (The NURBS Book, eq. 3.8) where this control point is 1, and the others 0.
    std::array<double, kDegree + 1> points{};
    points[a] = 1;
    for (std::size_t k = 1; k <= order; ++k) {
      for (std::size_t i = 0; i + k <= kDegree; ++i) {
        const std::size_t at = span - kDegree + i;
        points[i] = static_cast<double>(kDegree - k + 1) * (points[i + 1] - points[i]) /
                    (knots[at + kDegree + 1] - knots[at + k]);
      }
    }
    for (std::size_t i = 0; i + order <= kDegree; ++i) result.values[a] += lower[i] * points[i];
  }
  return result;
}

void add_square(const Basis& basis, double weight, Banded& matrix) {
  for (std::size_t a = 0; a <= kDegree; ++a) {
    const double factor = weight * basis.values[a];
    for (std::size_t b = 0; b <= a; ++b) matrix.at(basis.first + a, a - b) += factor * basis.values[b];
  }
}

Vector value(const Basis& basis, const std::vector<Vector>& points) {
  Vector sum{};
  for (std::size_t a = 0; a <= kDegree; ++a) sum = curves::along(sum, basis.values[a], points[basis.first + a]);
  return sum;
}

std::vector<double> second_derivative_hull(const std::vector<double>& knots, const std::vector<Vector>& points) {
  std::vector<double> hull(points.size(), 0.0);
  for (std::size_t i = 0; i + 2 < points.size(); ++i) {
    const double w0 = knots[i + 6] - knots[i + 1], w1 = knots[i + 7] - knots[i + 2], w = knots[i + 6] - knots[i + 2];
    if (!(w > 0)) continue;
    const Vector d0 = curves::scaled(5 / w0, curves::difference(points[i + 1], points[i]));
    const Vector d1 = curves::scaled(5 / w1, curves::difference(points[i + 2], points[i + 1]));
    hull[i] = 4 * curves::distance(d1, d0) / w;
  }
  return hull;
}

}  // namespace rmac::quintic
