#pragma once

#include <Eigen/Geometry>

#include "gateway/material/sweep/swept_ball.hpp"

namespace rmac::gateway {

/// What a disc that is rounded in every direction, the lower end of a bull nose, passes on a straight way while it
/// keeps its direction. mm.
class SweptDisc {
 public:
  using Vector3d = Eigen::Vector3d;
  static constexpr bool kClosedForm = false;  ///< nearest places are looked for in steps

  /// `axis`, unit, across the disc.
  SweptDisc(const Vector3d& from, const Vector3d& way, const Vector3d& axis, double radius, double rounded)
      : from_(from), way_(way), axis_(axis), radius_(radius), rounded_(rounded) {}

  [[nodiscard]] Eigen::AlignedBox3d bounds() const;
  /// All that is at most `by` away from it.
  [[nodiscard]] SweptDisc wider(double by) const { return {from_, way_, axis_, radius_, rounded_ + by}; }

  /// The solid as lines along one axis see it. The distance of a point from the disc on its way is a convex function,
  /// also along a line: Newton's steps from outside come to where it is `rounded` without passing it.
  class Lines {
   public:
    Lines(const SweptDisc& disc, std::size_t axis);
    /// The line through first and second coordinate across the axis: whether it meets the solid, and between where and
    /// where along the axis, to a millionth of a millimetre.
    [[nodiscard]] bool operator()(double first, double second, double& from, double& to) const noexcept;
    void operator()(const RayRow& row, RowMet& met) const noexcept { meet_one_by_one(*this, row, met); }

   private:
    struct Near {
      double distance = 0, slope = 0;  ///< along the line
    };
    [[nodiscard]] Eigen::Vector3d beyond(const Eigen::Vector3d& point, double& falls) const noexcept;
    [[nodiscard]] Near near(const Eigen::Vector3d& point, double& part) const noexcept;
    [[nodiscard]] bool enter(const Eigen::Vector3d& origin, double sense, double& at) const noexcept;

    SweptBall::Lines around_;                         ///< a capsule that holds it
    Eigen::Vector3d begin_, per_first_, per_second_;  ///< of the line's point, in the disc's frame
    Eigen::Vector3d line_, way_;                      ///< directions in the disc's frame
    double radius_, rounded_;
  };
  [[nodiscard]] Lines along(std::size_t axis) const { return {*this, axis}; }

 private:
  Vector3d from_, way_, axis_;
  double radius_, rounded_;
};

}  // namespace rmac::gateway
