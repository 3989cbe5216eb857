#include "rmac/motion/path_segment.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "rmac/motion/frame.hpp"

namespace rmac {
namespace {

/// Rows of the pose that are directions count as this many mm, so that one solve weighs tip and axis alike.
constexpr double kAxisWeight = 100;
constexpr std::size_t kPoseDimension = 6;
constexpr double kSingularPivot = 1e-9;
/// What a free joint would have to do, in mm by path length, that counts as nothing.
constexpr double kAnswered = 1e-6;
/// Step along the path for differences of the Jacobian, in mm, and the largest step of a joint with it; central
/// differences of an exact Jacobian are then good to about 1e-8.
constexpr double kJacobianStep = 1e-3;
constexpr double kJointStep = 0.01;

using PoseColumn = std::array<double, 6>;
using JointColumn = std::array<double, kMaxJoints>;
using PoseRows = std::array<double, 6 * kMaxJoints>;  ///< row-major, 6 x n

/// Least squares of J x = p by the normal equations and their LDLᵀ: matrices of a handful of rows, for which a
/// library's general routines spend most of their time on copies. A column that depends on those before it is a joint
/// that the pose leaves free; it stays at rest, which answers p only where p asks nothing of it.
class LeastSquares {
 public:
  LeastSquares(const PoseRows& jacobian, const Kinematics& kinematics) noexcept
      : jacobian_(jacobian), n_(kinematics.joint_count()) {
    // Slides first: at the pole a turn moves the tip as slides do, and it is the turn that is free.
    std::size_t slides = 0, turns = n_;
    for (std::size_t j = 0; j < n_; ++j) {
      order_[kinematics.joint_type(j) == JointType::Rotary ? --turns : slides++] = j;
    }
    double most = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t k = 0; k <= i; ++k) {
        double sum = 0;
        for (std::size_t r = 0; r < 6; ++r) sum += jacobian[r * n_ + order_[i]] * jacobian[r * n_ + order_[k]];
        for (std::size_t m = 0; m < k; ++m) sum -= lower_[i * n_ + m] * lower_[k * n_ + m] * diagonal_[m];
        if (k < i) {
          lower_[i * n_ + k] = sum * inverse_[k];
        } else {
          diagonal_[i] = sum;
        }
      }
      most = std::max(most, diagonal_[i]);
      if (diagonal_[i] > kSingularPivot * most) {
        inverse_[i] = 1 / diagonal_[i];
        continue;
      }
      diagonal_[i] = inverse_[i] = 0;
      any_free_ = true;
    }
  }

  /// False where p asks for what a free joint alone could do.
  [[nodiscard]] bool solve(const PoseColumn& pose, JointColumn& x) const noexcept {
    std::array<double, kMaxJoints> y;  // in the order of the columns
    for (std::size_t i = 0; i < n_; ++i) {
      double sum = 0;
      for (std::size_t r = 0; r < 6; ++r) sum += jacobian_[r * n_ + order_[i]] * pose[r];
      for (std::size_t m = 0; m < i; ++m) sum -= lower_[i * n_ + m] * y[m];
      y[i] = sum;
    }
    for (std::size_t i = n_; i-- > 0;) {
      y[i] *= inverse_[i];
      // Nothing depends on a free joint: its column below the diagonal is zero.
      for (std::size_t m = i + 1; m < n_; ++m) y[i] -= lower_[m * n_ + i] * y[m];
    }
    for (std::size_t i = 0; i < n_; ++i) x[order_[i]] = y[i];
    return !any_free_ || answered(pose, x);
  }

 private:
  [[nodiscard]] bool answered(const PoseColumn& pose, const JointColumn& x) const noexcept {
    double off = 0, whole = 0;
    for (std::size_t r = 0; r < 6; ++r) {
      double left = pose[r];
      for (std::size_t j = 0; j < n_; ++j) left -= jacobian_[r * n_ + j] * x[j];
      off += left * left;
      whole += pose[r] * pose[r];
    }
    return off <= kAnswered * kAnswered * (1 + whole);
  }

  const PoseRows& jacobian_;
  std::size_t n_;
  std::array<std::size_t, kMaxJoints> order_;          ///< of the columns
  std::array<double, kMaxJoints * kMaxJoints> lower_;  // below the unit diagonal
  std::array<double, kMaxJoints> diagonal_, inverse_;  // 0 for a free joint
  bool any_free_ = false;
};

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

  [[nodiscard]] KinematicsStatus position(const PoseColumn& pose, const JointColumn& seed,
                                          JointColumn& q) const noexcept {
    const ToolPose wanted{{pose[0], pose[1], pose[2]}, {pose[3], pose[4], pose[5]}};
    if (known_count_ == 0) return kinematics_.inverse(wanted, tool_, {seed.data(), n_}, {q.data(), n_});
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

}  // namespace

PathSegment::PathSegment(std::shared_ptr<const Curve> curve, const Frames& frames,
                         std::shared_ptr<const Kinematics> kinematics, const PathDemand& demand,
                         std::vector<MoveStretch> stretches)
    : curve_(std::move(curve)),
      kinematics_(std::move(kinematics)),
      frames_(frames),
      demand_(demand),
      stretches_(std::move(stretches)),
      length_(curve_->length()),
      joint_count_(kinematics_->joint_count()) {
  ended_before_.reserve(stretches_.size());
  std::uint32_t ended = 0;
  for (const MoveStretch& stretch : stretches_) {
    ended_before_.push_back(ended);
    if (stretch.last_of_move) ++ended;
  }
}

const MoveStretch& PathSegment::stretch_at(double s) const noexcept {
  const auto above = std::upper_bound(stretches_.begin(), stretches_.end(), s,
                                      [](double value, const MoveStretch& stretch) { return value < stretch.begin; });
  return above == stretches_.begin() ? stretches_.front() : *(above - 1);
}

std::uint32_t PathSegment::moves_ended(double from, double to) const noexcept {
  // A stretch ends where the next one begins, the last one at the segment's end.
  const auto ended = [this](double s) {
    if (s >= length_) return ended_before_.back() + (stretches_.back().last_of_move ? 1U : 0U);
    const auto index = &stretch_at(s) - stretches_.data();
    return ended_before_[static_cast<std::size_t>(index)];
  };
  return to > from ? ended(to) - ended(from) : 0;
}

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
    pose[k] = {p[0], p[1], p[2], a[0], a[1], a[2]};
  }

  auto& [q, x1, x2, x3] = point.d;
  JointColumn seed;
  seed_at(s, {seed.data(), n});
  const JointEquations equations(*kinematics_, frames_.tool, c, curve_->dimension() > kPoseDimension);
  const auto status = equations.position(pose[0], seed, q);
  if (status != KinematicsStatus::Ok || order == 0) return status;

  for (std::size_t k = 1; k <= static_cast<std::size_t>(order); ++k) {
    for (std::size_t r = 3; r < 6; ++r) pose[k][r] *= kAxisWeight;
  }
  // x' = J⁺p', x'' = J⁺(p'' - J' x'), x''' = J⁺(p''' - 2 J' x'' - J'' x'), primes along the path
  // (docs/derivations/joint-path.md, eq. 1 to 3).
  PoseRows jacobian;
  equations.jacobian_at(q, jacobian);
  PoseRows left;
  const LeastSquares squares(equations.unknown(jacobian, left), *kinematics_);
  if (!equations.solve(squares, jacobian, 1, pose[1], x1)) return KinematicsStatus::Singular;
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
  PoseColumn rest = pose[2];
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
  rest = pose[3];
  for (std::size_t r = 0; r < 6; ++r) {
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t i = r * n + j;
      const double bend = (ahead2[i] - behind2[i]) / (2 * h2) + (ahead[i] - 2 * jacobian[i] + behind[i]) / (h * h);
      rest[r] -= 2 * turn[i] * x2[j] + bend * x1[j];
    }
  }
  return equations.solve(squares, jacobian, 3, rest, x3) ? KinematicsStatus::Ok : KinematicsStatus::Singular;
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
