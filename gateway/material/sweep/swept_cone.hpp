#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "gateway/material/sweep/upright_cylinder.hpp"

namespace rmac::gateway {

/// What a cone or a cylinder with flat ends passes on a straight way while it keeps its direction. mm.
class SweptCone {
 public:
  using Vector3d = Eigen::Vector3d;
  static constexpr bool kClosedForm = true;  ///< lines have its ends but for rounding
  struct Size {
    double bottom_radius = 0, top_radius = 0, height = 0;
  };

  /// `middle` of its height where it begins; `axis`, unit, from bottom to top.
  SweptCone(const Vector3d& middle, const Vector3d& way, const Vector3d& axis, const Size& size)
      : middle_(middle), way_(way), axis_(axis), size_(size) {}

  [[nodiscard]] Eigen::AlignedBox3d bounds() const;
  /// All that is at most `by` away from it, and a little more at its edges.
  [[nodiscard]] SweptCone wider(double by) const;

  /// The solid as lines along one axis see it. In the plane that such a line and the way span, a point has the
  /// coordinates s along the line and t, the part of the way that is done. The cone cuts a conic between two parallel
  /// lines out of it, and the way is over at t = 0 and 1: what is convex and bounded so has its least and its greatest
  /// s at one of a few points in closed form.
  class Lines {
   public:
    Lines(const SweptCone& cone, std::size_t axis);
    /// The line through first and second coordinate across the axis: whether it meets the solid, and between where and
    /// where along the axis.
    [[nodiscard]] bool operator()(double first, double second, double& from, double& to) const noexcept {
      return upright_ ? (*upright_)(first, second, from, to) : leaning(first, second, from, to);
    }
    void operator()(const RayRow& row, RowMet& met) const noexcept {
      if (upright_) {
        (*upright_)(row, met);
      } else {
        meet_one_by_one(*this, row, met);
      }
    }

   private:
    [[nodiscard]] bool leaning(double first, double second, double& from, double& to) const noexcept;
    struct Span;
    struct Here;
    void at_end(const Here& here, double part, Span& span) const noexcept;
    void at_envelope(const Here& here, Span& span) const noexcept;
    void on_plane(const Here& here, double height, double radius, Span& span) const noexcept;

    std::optional<UprightCylinder> upright_;
    Eigen::Vector3d begin_, per_first_, per_second_;  ///< of the line's point, in the cone's frame
    Eigen::Vector3d line_, way_;                      ///< directions in the cone's frame
    double low_, high_;                               ///< between where and where it can be along the axis
    double height_, radius_, top_radius_, slope_;     ///< radius = radius_ + slope_ · z
    double ss_, st_, tt_;                             ///< of the quadratic form of the conic
  };
  [[nodiscard]] Lines along(std::size_t axis) const { return {*this, axis}; }

 private:
  Vector3d middle_, way_, axis_;
  Size size_;
};

}  // namespace rmac::gateway
