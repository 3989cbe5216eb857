#include "gateway/metrology/alignment.hpp"

#include "gateway/metrology/least_squares.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

struct Rigid {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Vector3d p = Vector3d::Zero();

  [[nodiscard]] Vector3d operator*(const Vector3d& v) const { return q * v + p; }
  [[nodiscard]] Rigid inverse() const { return {q.conjugate(), -(q.conjugate() * p)}; }
  [[nodiscard]] Frame frame() const {
    const Eigen::Quaterniond unit = q.normalized();
    const double sign = unit.w() < 0 ? -1 : 1;
    return {from_eigen(p), {sign * unit.w(), sign * unit.x(), sign * unit.y(), sign * unit.z()}};
  }
};

Rigid to_rigid(const Frame& frame) {
  return {Eigen::Quaterniond(frame.q[0], frame.q[1], frame.q[2], frame.q[3]), to_eigen(frame.p)};
}

/// Turns `from` about its centroid onto `to`, and shifts it there.
Rigid least_distance(const Cloud& from, const Cloud& to) {
  const Eigen::Matrix3d covariance = to.about * from.about.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
  // The best orthogonal matrix of noise, or of points in a plane, may be a reflection.
  mirror(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  const Eigen::Quaterniond q(Eigen::Matrix3d(svd.matrixU() * mirror * svd.matrixV().transpose()));
  return {q, to.centroid - q * from.centroid};
}

/// The part in its own coordinates, as it is fitted: `pose` turns machine into part coordinates.
struct SurfaceFit {
  std::span<const SurfacePoint> points;
  Vector3d centre;    ///< of the nominal points: turns are about it
  double extent = 1;  ///< root mean square of the points' distances from it: turns count in mm there

  [[nodiscard]] Linearised evaluate(const Rigid& pose) const {
    const auto count = static_cast<Index>(points.size());
    Linearised at{Eigen::VectorXd(count), Eigen::MatrixXd(count, 6)};
    for (Index i = 0; i < count; ++i) {
      const SurfacePoint& point = points[static_cast<std::size_t>(i)];
      const Vector3d place = pose * to_eigen(point.measured);
      const Vector3d normal = to_eigen(point.normal);
      at.residuals[i] = normal.dot(place - to_eigen(point.nominal));
      at.jacobian.row(i) << normal.transpose(), (place - centre).cross(normal).transpose() / extent;
    }
    return at;
  }
  [[nodiscard]] Rigid plus(const Rigid& pose, const Eigen::VectorXd& step) const {
    const Vector3d turn = step.tail<3>() / extent;
    const double angle = turn.norm();
    const Eigen::Quaterniond by =
        angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) : Eigen::Quaterniond::Identity();
    const Vector3d shift = step.head<3>();
    return {(by * pose.q).normalized(), by * (pose.p - centre) + centre + shift};
  }
};

/// The motions that `loose` (shifts and turns, one a column) spans, in words: pure shifts first.
std::string motions_in_words(const Eigen::MatrixXd& loose, const SurfaceFit& fit) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> turns(loose.bottomRows(3), Eigen::ComputeFullV);
  const Eigen::MatrixXd motions = loose * turns.matrixV();
  std::string shifts_text, turns_text;
  for (Index i = 0; i < motions.cols(); ++i) {
    const Vector3d shift = motions.col(i).head<3>();
    const Vector3d turn = motions.col(i).tail<3>() / fit.extent;
    constexpr double kNoTurn = 0.05;  // of a motion of length one, in mm at the extent
    if (motions.col(i).tail<3>().norm() < kNoTurn) {
      shifts_text += (shifts_text.empty() ? "its place along " : " and ") + in_words(oriented(shift.normalized()));
      continue;
    }
    const Vector3d on_axis = fit.centre + turn.cross(shift) / turn.squaredNorm();
    turns_text += (turns_text.empty() ? "its turn about " : " and about ") + in_words(oriented(turn.normalized())) +
                  " through " + in_words(on_axis);
  }
  return shifts_text + (shifts_text.empty() || turns_text.empty() ? "" : ", and ") + turns_text;
}

Expected<> check_surface_points(std::span<const SurfacePoint> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double length = to_eigen(points[i].normal).norm();
    if (!(std::abs(length - 1) < 1e-6)) {
      return refuse(fmt::format("point {} of {}: its normal has length {}, and must be a unit vector", i,
                                points[i].feature.empty() ? "the part" : points[i].feature, length));
    }
  }
  return {};
}

std::vector<Vector> each(std::span<const SurfacePoint> points, Vector SurfacePoint::*what) {
  std::vector<Vector> all;
  for (const SurfacePoint& point : points) all.push_back(point.*what);
  return all;
}

}  // namespace

Expected<Frame> fit_surfaces(std::span<const SurfacePoint> points) {
  const std::vector<Vector> measured = each(points, &SurfacePoint::measured);
  const std::vector<Vector> nominal = each(points, &SurfacePoint::nominal);
  for (const auto* all : {&measured, &nominal}) {
    if (auto enough = check_points(*all, 6, "an alignment to surfaces"); !enough) return tl::unexpected(enough.error());
  }
  if (auto sound = check_surface_points(points); !sound) return tl::unexpected(sound.error());
  const Cloud from(measured), to(nominal);
  if (!(to.extent() > 0)) return refuse("the part's turns are not held: all nominal points are one and the same");
  const SurfaceFit fit{points, to.centroid, to.extent()};
  const Rigid pose = least_squares(
      least_distance(from, to), [&](const Rigid& x) { return fit.evaluate(x); },
      [&](const Rigid& x, const Eigen::VectorXd& step) { return fit.plus(x, step); });
  const Linearised at = fit.evaluate(pose);
  if (const Eigen::MatrixXd loose = not_held(at.jacobian); loose.cols() > 0) {
    return refuse(
        fmt::format("the part is not held by these points: free are {}. Measure surfaces whose normals hold it",
                    motions_in_words(loose, fit)));
  }
  return pose.inverse().frame();
}

std::vector<FeatureDeviation> feature_deviations(std::span<const SurfacePoint> points, const Frame& frame) {
  const Rigid to_part = to_rigid(frame).inverse();
  std::vector<FeatureDeviation> features;
  for (const SurfacePoint& point : points) {
    auto feature = std::ranges::find(features, point.feature, &FeatureDeviation::feature);
    if (feature == features.end()) feature = features.insert(features.end(), {point.feature});
    const double off = to_eigen(point.normal).dot(to_part * to_eigen(point.measured) - to_eigen(point.nominal));
    ++feature->points;
    feature->mean_mm += off;
    feature->rms_mm += off * off;
    if (std::abs(off) > std::abs(feature->worst_mm)) feature->worst_mm = off;
  }
  for (FeatureDeviation& feature : features) {
    feature.mean_mm /= static_cast<double>(feature.points);
    feature.rms_mm = std::sqrt(feature.rms_mm / static_cast<double>(feature.points));
  }
  return features;
}

}  // namespace rmac::gateway
