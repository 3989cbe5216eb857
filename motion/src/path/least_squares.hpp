#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "rmac/motion/ports/kinematics.hpp"

namespace rmac {

using PoseColumn = std::array<double, 6>;
using JointColumn = std::array<double, kMaxJoints>;
using PoseRows = std::array<double, 6 * kMaxJoints>;  ///< row-major, 6 x n

/// Least squares of J x = p by the normal equations and their LDLᵀ: matrices of a handful of rows, for which a
/// library's general routines spend most of their time on copies. A column that depends on those before it is a joint
/// that the pose leaves free; it stays at rest, which answers p only where p asks nothing of it. The joint that the
/// kinematics says to be left over stays at rest, too.
class LeastSquares {
 public:
  LeastSquares(const PoseRows& jacobian, const Kinematics& kinematics) noexcept
      : jacobian_(jacobian), n_(kinematics.joint_count()) {
    // Slides first: at the pole a turn moves the tip as slides do, and it is the turn that is free.
    std::size_t slides = 0, turns = n_;
    for (std::size_t j = 0; j < n_; ++j) {
      order_[kinematics.joint_type(j) == JointType::Rotary ? --turns : slides++] = j;
    }
    // Of all columns: against those before it alone, a free joint's rounding errors would look like motion.
    double most = 0;
    for (std::size_t j = 0; j < n_; ++j) {
      double sum = 0;
      for (std::size_t r = 0; r < 6; ++r) sum += jacobian[r * n_ + j] * jacobian[r * n_ + j];
      most = std::max(most, sum);
    }
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
      if (kinematics.free_joint() == order_[i]) {
        diagonal_[i] = inverse_[i] = 0;
        continue;
      }
      if (diagonal_[i] > kSingularPivot * most) {
        inverse_[i] = 1 / diagonal_[i];
        continue;
      }
      diagonal_[i] = inverse_[i] = 0;
      any_free_ = true;
    }
  }

  /// No joint is free.
  [[nodiscard]] bool full_rank() const noexcept { return !any_free_; }
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
  static constexpr double kSingularPivot = 1e-9;
  /// What a free joint would have to do, in mm by path length, that counts as nothing.
  static constexpr double kAnswered = 1e-6;

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

}  // namespace rmac
