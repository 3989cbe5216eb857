#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gateway/material/sweep/ray_row.hpp"

namespace rmac::gateway {

/// What a ball passes on a straight way: a capsule. mm.
class SweptBall {
 public:
  using Vector3d = Eigen::Vector3d;
  static constexpr bool kClosedForm = true;  ///< lines have its ends but for rounding

  SweptBall(const Vector3d& from, const Vector3d& way, double radius) : from_(from), way_(way), radius_(radius) {}

  [[nodiscard]] Eigen::AlignedBox3d bounds() const {
    const Vector3d to = from_ + way_, reach = Vector3d::Constant(radius_);
    return {from_.cwiseMin(to) - reach, from_.cwiseMax(to) + reach};
  }
  /// All that is at most `by` away from it.
  [[nodiscard]] SweptBall wider(double by) const { return {from_, way_, radius_ + by}; }

  /// The capsule as lines along one axis see it.
  class Lines {
   public:
    Lines(const SweptBall& ball, std::size_t axis);
    /// The line through first and second coordinate across the axis: whether it meets the capsule, and between where
    /// and where along the axis.
    [[nodiscard]] bool operator()(double first, double second, double& from, double& to) const noexcept {
      return on_part(first, second, 0, 1, from, to);
    }
    /// The same of what the ball passes between two parts of its way.
    [[nodiscard]] bool on_part(double first, double second, double begin, double end, double& from,
                               double& to) const noexcept;
    /// The same of many lines, at less than half of the cost.
    void on_part(const RayRow& row, double begin, double end, RowMet& met) const noexcept;
    void operator()(const RayRow& row, RowMet& met) const noexcept { on_part(row, 0, 1, met); }

   private:
    struct Rows;
    double first_, second_, along_;              ///< where the ball begins
    double way_first_, way_second_, way_along_;  ///< its way
    double radius2_, across2_, length2_;         ///< squares: of the radius, and of the way across the axis and in all
    double per_length2_ = 0, per_across2_ = 0;   ///< 0: no way
  };
  [[nodiscard]] Lines along(std::size_t axis) const { return {*this, axis}; }

 private:
  Vector3d from_, way_;
  double radius_;
};

inline SweptBall::Lines::Lines(const SweptBall& ball, std::size_t axis) {
  const auto a = static_cast<Eigen::Index>(axis), u = (a + 1) % 3, v = (a + 2) % 3;
  first_ = ball.from_[u], second_ = ball.from_[v], along_ = ball.from_[a];
  way_first_ = ball.way_[u], way_second_ = ball.way_[v], way_along_ = ball.way_[a];
  radius2_ = ball.radius_ * ball.radius_;
  across2_ = way_first_ * way_first_ + way_second_ * way_second_;
  length2_ = across2_ + way_along_ * way_along_;
  // A way this short, or this steep, is no longer than rounding.
  constexpr double kNoWay2 = 1e-18;
  if (length2_ > kNoWay2) per_length2_ = 1 / length2_;
  if (across2_ > kNoWay2 + 1e-14 * length2_) per_across2_ = 1 / across2_;
}

inline bool SweptBall::Lines::on_part(double first, double second, double begin, double end, double& from,
                                      double& to) const noexcept {
  const double u = first - first_, v = second - second_;
  const auto half_at = [&](double part) {
    const double at_u = u - part * way_first_, at_v = v - part * way_second_;
    return radius2_ - at_u * at_u - at_v * at_v;
  };
  if (per_across2_ == 0) {
    const double half2 = half_at(begin);
    if (half2 <= 0) return false;
    const double half = std::sqrt(half2), one = begin * way_along_, other = end * way_along_;
    from = along_ + std::min(one, other) - half, to = along_ + std::max(one, other) + half;
    return true;
  }
  // Where the line enters and leaves the cylinder about the whole line of the way.
  const double dot = u * way_first_ + v * way_second_;
  const double beside = u * way_second_ - v * way_first_;
  const double under = radius2_ - beside * beside * per_across2_;
  if (under <= 0) return false;
  const double middle = dot * way_along_ * per_across2_, half = std::sqrt(under * length2_ * per_across2_);
  // There, the part of the way that the ball has done; beyond its ends the ball at that end is what the line meets.
  const double part_low = (dot + (middle - half) * way_along_) * per_length2_;
  const double part_high = (dot + (middle + half) * way_along_) * per_length2_;
  if ((part_low < begin && part_high < begin) || (part_low > end && part_high > end)) {
    // Only one end can be met.
    const double part = part_low < begin ? begin : end, half2 = half_at(part);
    if (half2 <= 0) return false;
    const double reach = std::sqrt(half2);
    from = along_ + part * way_along_ - reach, to = along_ + part * way_along_ + reach;
    return true;
  }
  const auto at = [&](double part, double root, double sign) {
    if (part >= begin && part <= end) return root;
    const double there = part < begin ? begin : end;
    return there * way_along_ + sign * std::sqrt(std::max(0.0, half_at(there)));
  };
  from = along_ + at(part_low, middle - half, -1);
  to = along_ + at(part_high, middle + half, 1);
  return true;
}

}  // namespace rmac::gateway
