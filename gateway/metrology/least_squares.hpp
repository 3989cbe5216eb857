#pragma once

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "rmac/motion/error.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::gateway {

inline Eigen::Vector3d to_eigen(const Vector& v) {
  return {v[0], v[1], v[2]};
}
inline Vector from_eigen(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
inline std::string in_words(const Eigen::Vector3d& v) {
  const auto shown = [](double c) { return std::abs(c) < 0.0005 ? 0.0 : c; };  // no "-0.000"
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", shown(v.x()), shown(v.y()), shown(v.z()));
}

/// A direction or its opposite, whichever is the one with the larger positive coordinate.
inline Eigen::Vector3d oriented(const Eigen::Vector3d& way) {
  Eigen::Index largest = 0;
  way.cwiseAbs().maxCoeff(&largest);
  return way[largest] < 0 ? Eigen::Vector3d(-way) : way;
}
inline tl::unexpected<Error> refuse(std::string message) {
  return failure(MinorCode::InvalidParameterValue, std::move(message));
}

/// Points as the columns of a matrix, about their centroid: coordinates of a large machine keep their digits.
struct Cloud {
  explicit Cloud(std::span<const Vector> points) : about(3, static_cast<Eigen::Index>(points.size())) {
    for (std::size_t i = 0; i < points.size(); ++i) about.col(static_cast<Eigen::Index>(i)) = to_eigen(points[i]);
    if (points.empty()) return;
    centroid = about.rowwise().mean();
    about.colwise() -= centroid;
  }
  [[nodiscard]] Eigen::Index size() const { return about.cols(); }
  /// Root mean square of the distances from the centroid.
  [[nodiscard]] double extent() const { return std::sqrt(about.squaredNorm() / static_cast<double>(size())); }

  Eigen::Matrix3Xd about;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
};

/// A shape needs so many points, all of finite coordinates.
[[nodiscard]] inline Expected<> check_points(std::span<const Vector> points, std::size_t least, const char* shape) {
  if (points.size() < least) {
    return refuse(fmt::format("{} needs {} points, and there are {}", shape, least, points.size()));
  }
  for (const Vector& point : points) {
    if (!std::ranges::all_of(point, [](double c) { return std::isfinite(c); })) {
      return refuse(fmt::format("{}: a point is not finite", shape));
    }
  }
  return {};
}

/// Residuals and their Jacobian at one place.
struct Linearised {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
};

/// A freedom that changes the residuals by less than this, root mean square, when it changes by 1, is not held.
inline constexpr double kHeld = 1e-3;

/// Freedoms that are not held, one a column, orthonormal; no column where all are.
[[nodiscard]] inline Eigen::MatrixXd not_held(const Eigen::MatrixXd& jacobian) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeFullV);
  const double scale = std::sqrt(static_cast<double>(jacobian.rows()));
  Eigen::Index held = 0;
  while (held < svd.singularValues().size() && svd.singularValues()[held] / scale >= kHeld) ++held;
  return svd.matrixV().rightCols(jacobian.cols() - held);
}

/// Levenberg's and Marquardt's descent from `x` to where the residuals' squares are least. `plus` goes by a step.
template <typename State, typename Evaluate, typename Plus>
[[nodiscard]] State least_squares(State x, Evaluate&& evaluate, Plus&& plus) {
  constexpr int kMostSteps = 200;
  constexpr double kMostDamping = 1e12;
  constexpr double kSmallestStep = 1e-13;
  Linearised at = evaluate(x);
  double damping = 1e-3;
  for (int i = 0; i < kMostSteps && damping < kMostDamping; ++i) {
    Eigen::MatrixXd normal = at.jacobian.transpose() * at.jacobian;
    // The share of one keeps a freedom that nothing holds where it is.
    normal.diagonal() += damping * (normal.diagonal() + Eigen::VectorXd::Ones(normal.rows()));
    const Eigen::VectorXd step = -normal.ldlt().solve(at.jacobian.transpose() * at.residuals);
    const State next = plus(x, step);
    Linearised there = evaluate(next);
    if (!(there.residuals.squaredNorm() <= at.residuals.squaredNorm())) {
      damping *= 10;
      continue;
    }
    x = next;
    at = std::move(there);
    damping = std::max(damping / 10, 1e-14);
    if (step.norm() < kSmallestStep) break;
  }
  return x;
}

}  // namespace rmac::gateway
