#include "rmac/motion/pose_to_joints.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "lanes.hpp"
#include "path/least_squares.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac {
namespace {

/// Rows of the pose that are directions count as this many mm, so that one solve weighs tip and axis alike.
constexpr double kAxisWeight = 100;
constexpr std::size_t kPoseDimension = 6;
/// Step along the path for differences of the Jacobian, in mm, and the largest step of a joint with it; central
/// differences of an exact Jacobian are then good to about 1e-8.
constexpr double kJacobianStep = 1e-3;
constexpr double kJointStep = 0.01;

/// What ties joints to the pose: the whole of it, or, where the curve tells the rotary joints, the tip alone, which is
/// then the slides' to bring along.
class JointEquations {
 public:
  JointEquations(const Kinematics& kinematics, const Frame& tool, const CurvePoint& curve, bool turns_known) noexcept
      : kinematics_(kinematics), tool_(tool), curve_(curve), n_(kinematics.joint_count()) {
    for (std::size_t j = 0; turns_known && j < n_; ++j) {
      if (kinematics.joint_type(j) == JointType::Rotary) known_[known_count_++] = j;
    }
  }

  [[nodiscard]] KinematicsStatus position(const ToolPose& wanted, std::span<const double> seed,
                                          JointColumn& q) const noexcept {
    if (known_count_ == 0) return kinematics_.inverse(wanted, tool_, seed, {q.data(), n_});
    // Slides move the tip linearly, so one step from anywhere arrives.
    std::copy_n(seed.begin(), n_, q.begin());
    for (std::size_t i = 0; i < known_count_; ++i) q[known_[i]] = curve_.d[0][kPoseDimension + i];
    ToolPose here;
    kinematics_.forward({q.data(), n_}, tool_, here);
    PoseRows rows;
    jacobian_at(q, rows);
    PoseColumn way{};
    for (std::size_t c = 0; c < 3; ++c) way[c] = wanted.tip[c] - here.tip[c];
    PoseRows left;
    JointColumn x;
    if (!LeastSquares(unknown(rows, left), kinematics_).solve(way, x)) return KinematicsStatus::OutOfReach;
    for (std::size_t j = 0; j < n_; ++j) q[j] += x[j];
    return KinematicsStatus::Ok;
  }

  /// With the axis' rows weighted.
  void jacobian_at(const JointColumn& joints, PoseRows& rows) const noexcept {
    kinematics_.jacobian({joints.data(), n_}, tool_, {rows.data(), 6 * n_});
    for (std::size_t i = 3 * n_; i < 6 * n_; ++i) rows[i] *= kAxisWeight;
  }

  /// What of the Jacobian is left to solve for: all of it, or, laid into `rows`, what slides do to the tip.
  [[nodiscard]] const PoseRows& unknown(const PoseRows& jacobian, PoseRows& rows) const noexcept {
    if (known_count_ == 0) return jacobian;
    std::copy_n(jacobian.begin(), 3 * n_, rows.begin());
    std::fill(rows.begin() + static_cast<std::ptrdiff_t>(3 * n_), rows.begin() + static_cast<std::ptrdiff_t>(6 * n_),
              0.0);
    for (std::size_t i = 0; i < known_count_; ++i) {
      for (std::size_t r = 0; r < 3; ++r) rows[r * n_ + known_[i]] = 0;
    }
    return rows;
  }

  /// The joints' derivative of an order; J times it must be `rest`.
  [[nodiscard]] bool solve(const LeastSquares& squares, const PoseRows& jacobian, std::size_t order, PoseColumn rest,
                           JointColumn& x) const noexcept {
    if (known_count_ == 0) return squares.solve(rest, x);
    std::fill(rest.begin() + 3, rest.end(), 0.0);
    const auto& turns = curve_.d[order];
    for (std::size_t i = 0; i < known_count_; ++i) {
      for (std::size_t r = 0; r < 3; ++r) rest[r] -= jacobian[r * n_ + known_[i]] * turns[kPoseDimension + i];
    }
    const bool solved = squares.solve(rest, x);
    for (std::size_t i = 0; i < known_count_; ++i) x[known_[i]] = turns[kPoseDimension + i];
    return solved;
  }

 private:
  const Kinematics& kinematics_;
  const Frame& tool_;
  const CurvePoint& curve_;
  std::size_t n_;
  std::size_t known_count_ = 0;
  std::array<std::size_t, kMaxJoints> known_;
};

/// A derivative of the pose, in the machine frame, axis rows weighted.
PoseColumn weighted(const Frame& part, const std::array<double, kMaxJoints>& d) noexcept {
  const Vector tip = apply_to_vector(part, {d[0], d[1], d[2]});
  const Vector axis = apply_to_vector(part, {d[3], d[4], d[5]});
  return {tip[0], tip[1], tip[2], kAxisWeight * axis[0], kAxisWeight * axis[1], kAxisWeight * axis[2]};
}

}  // namespace

PoseToJoints::PoseToJoints(const Frames& frames, std::shared_ptr<const Kinematics> kinematics)
    : frames_(frames), kinematics_(std::move(kinematics)), joint_count_(kinematics_->joint_count()) {
  if (!kinematics_->constant_jacobian()) return;
  const CurvePoint anywhere{};
  PoseRows jacobian;
  JointEquations(*kinematics_, frames_.tool, anywhere, false).jacobian_at(JointColumn{}, jacobian);
  const LeastSquares squares(jacobian, *kinematics_);
  if (!squares.full_rank()) return;
  for (std::size_t c = 0; c < kPoseDimension; ++c) {
    JointColumn unit{}, x;
    unit[c] = 1;
    (void)squares.solve(weighted(frames_.part, unit), x);
    for (std::size_t j = 0; j < joint_count_; ++j) {
      rates_[c][j] = x[j];
      if (c < 3 || x[j] != 0) coordinates_ = c + 1;
    }
  }
}

KinematicsStatus PoseToJoints::evaluate(const CurvePoint& curve, std::size_t dimension, int order,
                                        std::span<const double> seed, JointPoint& point) const noexcept {
  const auto& d = curve.d[0];
  const ToolPose wanted = apply_to_pose(frames_.part, {{d[0], d[1], d[2]}, {d[3], d[4], d[5]}});
  if (coordinates_ == 0) return solve(curve, dimension, wanted, order, seed, point);
  if (order == 1) apply_rates<1>(curve, point);
  if (order == 2) apply_rates<2>(curve, point);
  if (order == 3) apply_rates<3>(curve, point);
  return kinematics_->inverse(wanted, frames_.tool, seed, {point.d[0].data(), joint_count_});
}

bool PoseToJoints::derivatives(const CurvePoint& curve, JointPoint& point) const noexcept {
  if (coordinates_ == 0) return false;
  apply_rates<3>(curve, point);
  return true;
}

double PoseToJoints::largest_rate(std::size_t joint) const noexcept {
  if (coordinates_ != 3) return std::numeric_limits<double>::infinity();
  return std::hypot(rates_[0][joint], rates_[1][joint], rates_[2][joint]);
}

template <std::size_t kOrder>
void PoseToJoints::apply_rates(const CurvePoint& curve, JointPoint& point) const noexcept {
  static_assert(kMaxJoints % kLanes == 0, "a point has room for whole lanes");
  for (std::size_t j = 0; j < joint_count_; j += kLanes) {
    std::array<Lanes, kOrder> d{};
    for (std::size_t c = 0; c < coordinates_; ++c) {
      const Lanes rate = load(rates_[c].data() + j);
      for (std::size_t k = 0; k < kOrder; ++k) d[k] += rate * curve.d[k + 1][c];
    }
    for (std::size_t k = 0; k < kOrder; ++k) store(d[k], point.d[k + 1].data() + j);
  }
}

KinematicsStatus PoseToJoints::solve(const CurvePoint& curve, std::size_t dimension, const ToolPose& wanted, int order,
                                     std::span<const double> seed, JointPoint& point) const noexcept {
  const std::size_t n = joint_count_;
  JointColumn &q = point.d[0], &x1 = point.d[1], &x2 = point.d[2], &x3 = point.d[3];
  const JointEquations equations(*kinematics_, frames_.tool, curve, dimension > kPoseDimension);
  const auto status = equations.position(wanted, seed, q);
  if (status != KinematicsStatus::Ok || order == 0) return status;

  // x' = J⁺p', x'' = J⁺(p'' - J' x'), x''' = J⁺(p''' - 2 J' x'' - J'' x'), primes along the path
  // (docs/derivations/joint-path.md, eq. 1 to 3).
  PoseRows jacobian;
  equations.jacobian_at(q, jacobian);
  PoseRows left;
  const LeastSquares squares(equations.unknown(jacobian, left), *kinematics_);
  if (!equations.solve(squares, jacobian, 1, weighted(frames_.part, curve.d[1]), x1)) return KinematicsStatus::Singular;
  if (order == 1) return KinematicsStatus::Ok;

  const auto step_for = [&](const JointColumn& direction) {
    double largest = 0;
    for (std::size_t j = 0; j < n; ++j) largest = std::max(largest, std::abs(direction[j]));
    return largest * kJacobianStep > kJointStep ? kJointStep / largest : kJacobianStep;
  };
  const auto jacobian_along = [&](double by, const JointColumn& direction, PoseRows& rows) {
    JointColumn joints;
    for (std::size_t j = 0; j < n; ++j) joints[j] = q[j] + by * direction[j];
    equations.jacobian_at(joints, rows);
  };
  const double h = step_for(x1);
  PoseRows ahead, behind, turn;  // turn: dJ along x'
  jacobian_along(h, x1, ahead);
  jacobian_along(-h, x1, behind);
  PoseColumn rest = weighted(frames_.part, curve.d[2]);
  for (std::size_t r = 0; r < 6; ++r) {
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t i = r * n + j;
      turn[i] = (ahead[i] - behind[i]) / (2 * h);
      rest[r] -= turn[i] * x1[j];
    }
  }
  if (!equations.solve(squares, jacobian, 2, rest, x2)) return KinematicsStatus::Singular;
  if (order == 2) return KinematicsStatus::Ok;

  const double h2 = step_for(x2);
  PoseRows ahead2, behind2;
  jacobian_along(h2, x2, ahead2);
  jacobian_along(-h2, x2, behind2);
  rest = weighted(frames_.part, curve.d[3]);
  for (std::size_t r = 0; r < 6; ++r) {
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t i = r * n + j;
      const double bend = (ahead2[i] - behind2[i]) / (2 * h2) + (ahead[i] - 2 * jacobian[i] + behind[i]) / (h * h);
      rest[r] -= 2 * turn[i] * x2[j] + bend * x1[j];
    }
  }
  return equations.solve(squares, jacobian, 3, rest, x3) ? KinematicsStatus::Ok : KinematicsStatus::Singular;
}

ToolPose PoseToJoints::pose(std::span<const double> joints) const noexcept {
  return apply_to_pose(inverse(frames_.part), pose_of(*kinematics_, joints, frames_.tool));
}

}  // namespace rmac
