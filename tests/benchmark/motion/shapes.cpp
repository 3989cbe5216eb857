#include "shapes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "exact_nurbs.hpp"

namespace rmac::bench {

Vector rose(double angle) {
  const double r = 30 + 10 * std::cos(5 * angle);
  return {r * std::cos(angle), r * std::sin(angle), 0};
}

Vector butterfly(double angle) {
  const double twelfth = std::sin(angle / 12);
  const double r =
      11 * (std::exp(std::cos(angle)) - 2 * std::cos(4 * angle) + twelfth * twelfth * twelfth * twelfth * twelfth);
  return {r * std::sin(angle), r * std::cos(angle) - 10, 0};
}

std::vector<Vector> polyline(const std::function<Vector(double)>& shape, double angle, double line_mm) {
  constexpr int kFine = 400000;
  std::vector<double> length(kFine + 1, 0.0);
  Vector before = shape(0);
  for (int i = 1; i <= kFine; ++i) {
    const Vector here = shape(angle * i / kFine);
    length[static_cast<std::size_t>(i)] = length[static_cast<std::size_t>(i) - 1] +
                                          std::hypot(here[0] - before[0], here[1] - before[1], here[2] - before[2]);
    before = here;
  }
  const auto lines = static_cast<int>(std::lround(length.back() / line_mm));
  std::vector<Vector> corners;
  for (int k = 0; k <= lines; ++k) {
    const double wanted = length.back() * k / lines;
    const auto above = std::lower_bound(length.begin() + 1, length.end() - 1, wanted);
    const auto i = static_cast<std::size_t>(above - length.begin());
    const double part = (wanted - length[i - 1]) / (length[i] - length[i - 1]);
    corners.push_back(shape(angle * (static_cast<double>(i) - 1 + part) / kFine));
  }
  return corners;
}

Nurbs clamped(int degree, std::vector<std::vector<double>> poles) {
  Nurbs nurbs;
  nurbs.degree = degree;
  nurbs.dimension = poles.front().size();
  const int count = static_cast<int>(poles.size());
  for (int i = 0; i < count + degree + 1; ++i) nurbs.knots.push_back(std::clamp(i - degree, 0, count - degree));
  nurbs.points = std::move(poles);
  return nurbs;
}

Nurbs interpolated(const std::function<Vector(double)>& shape, double angle, int degree, int count) {
  // Values of each basis function at the sites: the spline with one pole 1 and all others 0.
  Nurbs nurbs = clamped(degree, std::vector<std::vector<double>>(static_cast<std::size_t>(count), {0.0}));
  const double last = nurbs.knots.back();
  std::vector<double> sites;  // Greville's
  for (int i = 0; i < count; ++i) {
    double sum = 0;
    for (int k = 1; k <= degree; ++k) sum += nurbs.knots[static_cast<std::size_t>(i + k)];
    sites.push_back(sum / degree);
  }
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixXd wanted(count, 3);
  for (int j = 0; j < count; ++j) {
    nurbs.points[static_cast<std::size_t>(j)][0] = 1;
    const ExactNurbs basis(nurbs);
    for (int i = std::max(0, j - degree - 1); i <= std::min(count - 1, j + degree + 1); ++i)
      matrix(i, j) = static_cast<double>(basis.at(sites[static_cast<std::size_t>(i)], 0)[0][0]);
    nurbs.points[static_cast<std::size_t>(j)][0] = 0;
  }
  for (int i = 0; i < count; ++i) {
    const Vector at = shape(angle * sites[static_cast<std::size_t>(i)] / last);
    for (int c = 0; c < 3; ++c) wanted(i, c) = at[static_cast<std::size_t>(c)];
  }
  const Eigen::MatrixXd poles = matrix.partialPivLu().solve(wanted);
  nurbs.dimension = 3;
  for (int i = 0; i < count; ++i) nurbs.points[static_cast<std::size_t>(i)] = {poles(i, 0), poles(i, 1), poles(i, 2)};
  return nurbs;
}

Nurbs RandomSplines::next(bool with_axis) {
  for (;;) {
    const int degree = std::uniform_int_distribution<int>(3, 5)(random_);
    std::vector<std::vector<double>> poles;
    for (int i = 0; i < 10; ++i) poles.push_back({uniform(-40, 40), uniform(-40, 40), uniform(-10, 10)});
    if (with_axis) {
      for (auto& pole : poles) {
        // Uniform over the cap of 15 degrees about the vertical.
        const double z = uniform(std::cos(15 * std::numbers::pi / 180), 1), turn = uniform(0, 2 * std::numbers::pi);
        const double across = std::sqrt(1 - z * z);
        pole.insert(pole.end(), {across * std::cos(turn), across * std::sin(turn), z});
      }
    }
    Nurbs nurbs = clamped(degree, std::move(poles));
    const ExactNurbs exact(nurbs);
    if (exact.length(exact.begin(), exact.end()) >= 100) return nurbs;
  }
}

Nurbs RandomSplines::in_stream(const Nurbs* before) {
  // Three poles on the tangent, the second distance twice the first: no curvature at the end of a clamped spline
  // with evenly spaced knots, whatever its degree, so that neighbours join with equal tangent and curvature.
  for (;;) {
    Nurbs nurbs = next(false);
    auto& poles = nurbs.points;
    const std::size_t last = poles.size() - 1;
    const double turn = uniform(0, 2 * std::numbers::pi);
    const double step[3] = {4 * std::cos(turn), 4 * std::sin(turn), 0};
    for (std::size_t c = 0; c < 3; ++c) {
      if (before != nullptr) {
        const double end = before->points[last][c], tangent = end - before->points[last - 1][c];
        poles[0][c] = end, poles[1][c] = end + tangent, poles[2][c] = end + 3 * tangent;
      }
      poles[last][c] *= 0.9;  // leaves room for the next one's tangent
      poles[last - 1][c] = poles[last][c] - step[c];
      poles[last - 2][c] = poles[last][c] - 3 * step[c];
    }
    const ExactNurbs exact(nurbs);
    if (exact.length(exact.begin(), exact.end()) >= 100) return nurbs;
  }
}

}  // namespace rmac::bench
