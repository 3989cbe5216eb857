#include "gateway/metrology/sphere.hpp"

#include "gateway/metrology/least_squares.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

/// Distances of the points from the sphere `x`: the centre's coordinates, then the radius.
Linearised distances(const Matrix3Xd& points, const Eigen::VectorXd& x) {
  Linearised at{Eigen::VectorXd(points.cols()), Eigen::MatrixXd(points.cols(), 4)};
  for (Index i = 0; i < points.cols(); ++i) {
    const Vector3d arm = points.col(i) - x.head<3>();
    const double distance = arm.norm();
    at.residuals[i] = distance - x[3];
    at.jacobian.row(i).head<3>() = distance > 0 ? (-arm / distance).transpose().eval() : arm.transpose().eval();
    at.jacobian(i, 3) = -1;
  }
  return at;
}

/// |p|² = 2 c·p + (r² - |c|²) is linear in c and the bracket; of several solutions the one nearest to the origin.
Eigen::VectorXd algebraic_fit(const Matrix3Xd& points) {
  Eigen::MatrixXd a(points.cols(), 4);
  a << 2 * points.transpose(), Eigen::VectorXd::Ones(points.cols());
  const Eigen::VectorXd b = points.colwise().squaredNorm().transpose();
  Eigen::VectorXd x = a.completeOrthogonalDecomposition().solve(b);
  x[3] = std::sqrt(std::max(0.0, x[3] + x.head<3>().squaredNorm()));
  return x;
}

FitQuality quality_of(const Eigen::VectorXd& residuals) {
  FitQuality quality{static_cast<std::size_t>(residuals.size())};
  for (const double each : residuals) {
    quality.rms_mm += each * each;
    quality.worst_mm = std::max(quality.worst_mm, std::abs(each));
  }
  quality.rms_mm = std::sqrt(quality.rms_mm / static_cast<double>(quality.points));
  return quality;
}

}  // namespace

Expected<FittedSphere> fit_sphere(std::span<const Vector> points) {
  if (auto enough = check_points(points, 4, "a sphere"); !enough) return tl::unexpected(enough.error());
  const Cloud cloud(points);
  const Eigen::VectorXd fit = least_squares(
      algebraic_fit(cloud.about), [&](const Eigen::VectorXd& x) { return distances(cloud.about, x); },
      [](const Eigen::VectorXd& x, const Eigen::VectorXd& step) { return Eigen::VectorXd(x + step); });
  const Linearised at = distances(cloud.about, fit);
  if (const Eigen::MatrixXd loose = not_held(at.jacobian); loose.cols() > 0) {
    const Vector3d way = loose.col(0).head<3>();
    return refuse(fmt::format("the sphere's {} is not held: the points lie in one plane, or nearly; add points off it",
                              way.norm() > 0.5 ? "centre along " + in_words(oriented(way.normalized())) : "radius"));
  }
  return FittedSphere{from_eigen(cloud.centroid + fit.head<3>()), fit[3], quality_of(at.residuals)};
}

}  // namespace rmac::gateway
