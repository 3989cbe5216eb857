#include "rmac/motion/path_segment.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "rmac/motion/frame.hpp"

namespace rmac {
namespace {

/// Rows of the pose that are directions count as this many mm, so that one solve weighs tip and axis alike.
constexpr double kAxisWeight = 100;
constexpr double kSingularPivot = 1e-9;
/// Step along the path for differences of the Jacobian, in mm; central differences of an exact Jacobian are good to
/// about 1e-8.
constexpr double kJacobianStep = 1e-3;

using PoseRows = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor, 6, kMaxJoints>;
using JointColumn = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;
using JointMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxJoints, kMaxJoints>;
using PoseColumn = Eigen::Matrix<double, 6, 1>;

}  // namespace

PathSegment::PathSegment(std::shared_ptr<const Curve> curve, const Frames& frames,
                         std::shared_ptr<const Kinematics> kinematics, const PathDemand& demand)
    : curve_(std::move(curve)),
      kinematics_(std::move(kinematics)),
      frames_(frames),
      demand_(demand),
      length_(curve_->length()),
      joint_count_(kinematics_->joint_count()) {}

KinematicsStatus PathSegment::resolve(std::span<const double> start_joints, double& s_failed) {
  const auto nodes = curve_->nodes();
  seeds_.assign(nodes.size() * joint_count_, 0.0);
  std::copy(start_joints.begin(), start_joints.begin() + static_cast<std::ptrdiff_t>(joint_count_), seeds_.begin());
  JointPoint point;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    double* const here = seeds_.data() + i * joint_count_;
    if (i > 0) std::copy(here - joint_count_, here, here);
    if (const auto status = evaluate(nodes[i], 3, nodes[i] > 0 ? -1 : 1, point); status != KinematicsStatus::Ok) {
      s_failed = nodes[i];
      return status;
    }
    std::copy_n(point.d[0].begin(), joint_count_, here);
  }
  return KinematicsStatus::Ok;
}

void PathSegment::seed_at(double s, std::span<double> seed) const noexcept {
  const auto nodes = curve_->nodes();
  const auto above = std::upper_bound(nodes.begin(), nodes.end(), s);
  const auto index = above == nodes.begin() ? 0U : static_cast<std::size_t>(above - nodes.begin()) - 1;
  std::copy_n(seeds_.begin() + static_cast<std::ptrdiff_t>(index * joint_count_), joint_count_, seed.begin());
}

KinematicsStatus PathSegment::evaluate(double s, int order, int side, JointPoint& point) const noexcept {
  CurvePoint c;
  curve_->evaluate(s, order, side, c);
  const std::size_t n = joint_count_;
  if (curve_->in_joint_space()) {
    for (std::size_t k = 0; k <= static_cast<std::size_t>(order); ++k)
      std::copy_n(c.d[k].begin(), n, point.d[k].begin());
    return KinematicsStatus::Ok;
  }

  // Pose and its derivatives in the machine frame.
  std::array<PoseColumn, 4> pose;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(order); ++k) {
    const Vector tip{c.d[k][0], c.d[k][1], c.d[k][2]};
    const Vector axis{c.d[k][3], c.d[k][4], c.d[k][5]};
    const Vector p = k == 0 ? apply_to_point(frames_.part, tip) : apply_to_vector(frames_.part, tip);
    const Vector a = apply_to_vector(frames_.part, axis);
    pose[k] << p[0], p[1], p[2], a[0], a[1], a[2];
  }

  std::array<double, kMaxJoints> seed{};
  seed_at(s, {seed.data(), n});
  const ToolPose wanted{{pose[0][0], pose[0][1], pose[0][2]}, {pose[0][3], pose[0][4], pose[0][5]}};
  if (const auto status = kinematics_->inverse(wanted, frames_.tool, {seed.data(), n}, {point.d[0].data(), n});
      status != KinematicsStatus::Ok) {
    return status;
  }
  if (order == 0) return KinematicsStatus::Ok;

  // Least squares of J x' = p' through the normal equations; the sixth row is dependent because the axis has unit
  // length.
  const auto joint_count = static_cast<Eigen::Index>(n);
  const auto jacobian_at = [&](const JointColumn& joints, PoseRows& rows) {
    rows.resize(6, joint_count);
    kinematics_->jacobian({joints.data(), n}, frames_.tool, {rows.data(), 6 * n});
    rows.bottomRows<3>() *= kAxisWeight;
  };
  for (int k = 1; k <= order; ++k) pose[static_cast<std::size_t>(k)].tail<3>() *= kAxisWeight;
  const JointColumn q = Eigen::Map<const Eigen::VectorXd>(point.d[0].data(), joint_count);
  PoseRows jacobian;
  jacobian_at(q, jacobian);
  const JointMatrix normal = jacobian.transpose() * jacobian;
  const Eigen::LDLT<JointMatrix> factor(normal);
  const double largest = factor.vectorD().cwiseAbs().maxCoeff();
  if (!(factor.vectorD().minCoeff() > kSingularPivot * largest)) return KinematicsStatus::Singular;
  const auto solve = [&](const PoseColumn& rhs) -> JointColumn { return factor.solve(jacobian.transpose() * rhs); };
  const auto store = [&](std::size_t k, const JointColumn& value) { std::copy_n(value.data(), n, point.d[k].begin()); };

  const JointColumn x1 = solve(pose[1]);
  store(1, x1);
  if (order == 1) return KinematicsStatus::Ok;

  // x'' = J⁺(p'' - J' x'), x''' = J⁺(p''' - 2 J' x'' - J'' x'), primes along the path (docs/derivations/joint-path.md,
  // eq. 2 and 3).
  const double h = kJacobianStep;
  PoseRows ahead, behind;
  jacobian_at(q + h * x1, ahead);
  jacobian_at(q - h * x1, behind);
  const PoseRows turn = (ahead - behind) / (2 * h);  // dJ along x'
  const JointColumn x2 = solve(pose[2] - turn * x1);
  store(2, x2);
  if (order == 2) return KinematicsStatus::Ok;

  PoseRows ahead2, behind2;
  jacobian_at(q + h * x2, ahead2);
  jacobian_at(q - h * x2, behind2);
  const PoseRows bend = (ahead2 - behind2) / (2 * h) + (ahead - 2 * jacobian + behind) / (h * h);
  store(3, solve(pose[3] - 2 * turn * x2 - bend * x1));
  return KinematicsStatus::Ok;
}

ToolPose PathSegment::pose(double s) const noexcept {
  CurvePoint c;
  curve_->evaluate(s, 0, 1, c);
  if (!curve_->in_joint_space()) return {{c.d[0][0], c.d[0][1], c.d[0][2]}, {c.d[0][3], c.d[0][4], c.d[0][5]}};
  ToolPose machine;
  kinematics_->forward({c.d[0].data(), joint_count_}, frames_.tool, machine);
  return apply_to_pose(inverse(frames_.part), machine);
}

}  // namespace rmac
