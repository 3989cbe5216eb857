#include "gateway/metrology/shapes.hpp"

#include <numbers>

#include "gateway/metrology/least_squares.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

tl::unexpected<Error> refuse(std::string message) {
  return failure(MinorCode::InvalidParameterValue, std::move(message));
}

std::vector<double> to_vector(const Eigen::VectorXd& values) {
  return {values.data(), values.data() + values.size()};
}

/// Two directions that make a frame with a unit `axis`.
Eigen::Matrix<double, 3, 2> across(const Vector3d& axis) {
  Eigen::Matrix<double, 3, 2> both;
  both.col(0) = axis.unitOrthogonal();
  both.col(1) = axis.cross(both.col(0));
  return both;
}

/// A ball of any dimension: the centre's coordinates, then the radius.
template <int kDimension>
struct Ball {
  using Points = Eigen::Matrix<double, kDimension, Eigen::Dynamic>;

  static Linearised evaluate(const Points& points, const Eigen::VectorXd& x) {
    Linearised at{Eigen::VectorXd(points.cols()), Eigen::MatrixXd(points.cols(), kDimension + 1)};
    for (Index i = 0; i < points.cols(); ++i) {
      const Eigen::Matrix<double, kDimension, 1> arm = points.col(i) - x.head(kDimension);
      const double distance = arm.norm();
      at.residuals[i] = distance - x[kDimension];
      at.jacobian.row(i).head(kDimension) =
          distance > 0 ? (-arm / distance).transpose().eval() : arm.transpose().eval();
      at.jacobian(i, kDimension) = -1;
    }
    return at;
  }

  /// |p|² = 2 c·p + (r² - |c|²) is linear in c and the bracket; of several solutions the one nearest to the origin.
  static Eigen::VectorXd begin(const Points& points) {
    Eigen::MatrixXd a(points.cols(), kDimension + 1);
    a << 2 * points.transpose(), Eigen::VectorXd::Ones(points.cols());
    const Eigen::VectorXd b = points.colwise().squaredNorm().transpose();
    Eigen::VectorXd x = a.completeOrthogonalDecomposition().solve(b);
    x[kDimension] = std::sqrt(std::max(0.0, x[kDimension] + x.head(kDimension).squaredNorm()));
    return x;
  }

  static Eigen::VectorXd fit(const Points& points) {
    return least_squares(
        begin(points), [&](const Eigen::VectorXd& x) { return evaluate(points, x); },
        [](const Eigen::VectorXd& x, const Eigen::VectorXd& step) { return Eigen::VectorXd(x + step); });
  }
};

/// Singular vectors of the cloud, the longest direction first, and how far it reaches along each.
Eigen::JacobiSVD<Eigen::Matrix3Xd> directions(const Cloud& cloud) {
  return Eigen::JacobiSVD<Eigen::Matrix3Xd>(cloud.about, Eigen::ComputeFullU);
}

Vector3d oriented(const Vector3d& normal) {
  Index largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  return normal[largest] < 0 ? Vector3d(-normal) : normal;
}

/// A cylinder in the cloud's coordinates.
struct Cylinder {
  Vector3d point;
  Vector3d axis;
  double radius = 0;

  [[nodiscard]] Linearised evaluate(const Cloud& cloud, double extent) const {
    const auto ways = across(axis);
    Linearised at{Eigen::VectorXd(cloud.size()), Eigen::MatrixXd(cloud.size(), 5)};
    for (Index i = 0; i < cloud.size(); ++i) {
      const Vector3d arm = cloud.about.col(i) - point;
      const double along = arm.dot(axis);
      const Vector3d radial = arm - along * axis;
      const double distance = radial.norm();
      const Eigen::RowVector2d shift =
          distance > 0 ? (-radial.transpose() / distance * ways).eval() : Eigen::RowVector2d::Zero().eval();
      at.residuals[i] = distance - radius;
      // A lean is counted in mm at the cloud's extent.
      at.jacobian.row(i) << shift, along / extent * shift, -1;
    }
    return at;
  }
  [[nodiscard]] Cylinder plus(const Eigen::VectorXd& step, double extent) const {
    const auto ways = across(axis);
    return {point + ways * step.head<2>(), (axis + ways * step.segment<2>(2) / extent).normalized(), radius + step[4]};
  }
};

/// The circle that the cloud makes when it is looked at along `axis`.
Cylinder looked_at_along(const Cloud& cloud, const Vector3d& axis) {
  const auto ways = across(axis);
  const Eigen::VectorXd circle = Ball<2>::fit(ways.transpose() * cloud.about);
  return {ways * circle.head<2>(), axis, circle[2]};
}

/// The cloud's own directions, and others evenly over the half sphere: one of them is near enough to descend from.
std::vector<Vector3d> possible_axes(const Cloud& cloud) {
  constexpr int kOthers = 30;
  const Eigen::Matrix3d own = directions(cloud).matrixU();
  std::vector<Vector3d> axes{own.col(0), own.col(1), own.col(2)};
  for (int i = 0; i < kOthers; ++i) {
    const double z = (i + 0.5) / kOthers;
    const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double lean = std::sqrt(1 - z * z);
    axes.emplace_back(lean * std::cos(turn), lean * std::sin(turn), z);
  }
  return axes;
}

}  // namespace

FitQuality fit_quality(std::vector<double> deviations_mm) {
  FitQuality quality{std::move(deviations_mm), 0, 0};
  for (const double each : quality.deviations_mm) {
    quality.rms_mm += each * each;
    quality.worst_mm = std::max(quality.worst_mm, std::abs(each));
  }
  if (!quality.deviations_mm.empty()) {
    quality.rms_mm = std::sqrt(quality.rms_mm / static_cast<double>(quality.deviations_mm.size()));
  }
  return quality;
}

Expected<FittedPlane> fit_plane(std::span<const Vector> points) {
  if (auto enough = check_points(points, 3, "a plane"); !enough) return tl::unexpected(enough.error());
  const Cloud cloud(points);
  const auto svd = directions(cloud);
  if (svd.singularValues()[1] <= kHeld * svd.singularValues()[0]) {
    return refuse("the plane's turn about the line " + in_words(svd.matrixU().col(0)) +
                  " is not held: the points lie on that line; add points beside it");
  }
  const Vector3d normal = oriented(svd.matrixU().col(2));
  return FittedPlane{from_eigen(cloud.centroid), from_eigen(normal),
                     fit_quality(to_vector(cloud.about.transpose() * normal))};
}

Expected<FittedLine> fit_line(std::span<const Vector> points) {
  if (auto enough = check_points(points, 2, "a line"); !enough) return tl::unexpected(enough.error());
  const Cloud cloud(points);
  const auto svd = directions(cloud);
  constexpr double kRound = 0.9;
  const double second = svd.singularValues().size() > 1 ? svd.singularValues()[1] : 0;
  if (!(second < kRound * svd.singularValues()[0])) {
    return refuse(
        "the line's direction is not held: the points reach equally far along several; add points further off");
  }
  const Vector3d direction = oriented(svd.matrixU().col(0));
  const Eigen::Matrix3Xd off = cloud.about - direction * (direction.transpose() * cloud.about);
  return FittedLine{from_eigen(cloud.centroid), from_eigen(direction),
                    fit_quality(to_vector(off.colwise().norm().transpose()))};
}

Expected<FittedSphere> fit_sphere(std::span<const Vector> points) {
  if (auto enough = check_points(points, 4, "a sphere"); !enough) return tl::unexpected(enough.error());
  const Cloud cloud(points);
  const Eigen::VectorXd fit = Ball<3>::fit(cloud.about);
  const Linearised at = Ball<3>::evaluate(cloud.about, fit);
  if (const Eigen::MatrixXd loose = not_held(at.jacobian); loose.cols() > 0) {
    const Vector3d way = loose.col(0).head<3>();
    return refuse(fmt::format("the sphere's {} is not held: the points lie in one plane, or nearly; add points off it",
                              way.norm() > 0.5 ? "centre along " + in_words(oriented(way.normalized())) : "radius"));
  }
  return FittedSphere{from_eigen(cloud.centroid + fit.head<3>()), fit[3], fit_quality(to_vector(at.residuals))};
}

Expected<FittedCircle> fit_circle(std::span<const Vector> points) {
  if (auto enough = check_points(points, 3, "a circle"); !enough) return tl::unexpected(enough.error());
  const auto plane = fit_plane(points);
  if (!plane) return tl::unexpected(plane.error());
  const Cloud cloud(points);
  const auto ways = across(to_eigen(plane->normal));
  const Eigen::Matrix2Xd flat = ways.transpose() * cloud.about;
  const Eigen::VectorXd fit = Ball<2>::fit(flat);
  const Linearised at = Ball<2>::evaluate(flat, fit);
  if (const Eigen::MatrixXd loose = not_held(at.jacobian); loose.cols() > 0) {
    return refuse("the circle's centre along " + in_words((ways * loose.col(0).head<2>()).normalized()) +
                  " is not held: the points lie on too short an arc; spread them");
  }
  return FittedCircle{from_eigen(cloud.centroid + ways * fit.head<2>()), plane->normal, fit[2],
                      fit_quality(to_vector(at.residuals))};
}

Expected<FittedCylinder> fit_cylinder(std::span<const Vector> points) {
  if (auto enough = check_points(points, 5, "a cylinder"); !enough) return tl::unexpected(enough.error());
  const Cloud cloud(points);
  const double extent = cloud.extent();
  if (!(extent > 0)) return refuse("nothing of the cylinder is held: its points are one and the same");
  std::optional<Cylinder> best;
  double least = 0;
  for (const Vector3d& axis : possible_axes(cloud)) {
    const Cylinder found = least_squares(
        looked_at_along(cloud, axis), [&](const Cylinder& x) { return x.evaluate(cloud, extent); },
        [&](const Cylinder& x, const Eigen::VectorXd& step) { return x.plus(step, extent); });
    const double cost = found.evaluate(cloud, extent).residuals.squaredNorm();
    // Nothing that points hold is much larger than they reach.
    constexpr double kLargest = 100;
    if (!std::isfinite(cost) || found.radius > kLargest * extent || (best && cost >= least)) continue;
    best = found;
    least = cost;
  }
  if (!best) return refuse("the cylinder's radius is not held: the points lie in one plane; add points around it");
  const Linearised at = best->evaluate(cloud, extent);
  if (const Eigen::MatrixXd loose = not_held(at.jacobian); loose.cols() > 0) {
    Index most = 0;
    loose.col(0).cwiseAbs().maxCoeff(&most);
    const std::string what = most < 2 ? "place across its axis" : most < 4 ? "direction of its axis" : "radius";
    return refuse(fmt::format("the cylinder's {} is not held: spread the points along the axis {} and around it", what,
                              in_words(best->axis)));
  }
  const Vector3d axis = oriented(best->axis);
  const Vector3d nearest = best->point - axis * axis.dot(best->point);
  return FittedCylinder{from_eigen(cloud.centroid + nearest), from_eigen(axis), best->radius,
                        fit_quality(to_vector(at.residuals))};
}

}  // namespace rmac::gateway
