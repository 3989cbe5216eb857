#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gateway/material/sweep/swept_ball.hpp"

namespace rmac::gateway {

/// What a cylinder whose axis is one of the part frame's passes on a straight way, as lines along one axis see it: most
/// of what a machine of three slides cuts, at a fraction of the cost of a cone that leans. mm.
class UprightCylinder {
 public:
  using Vector3d = Eigen::Vector3d;

  /// `upright`: the axis of the cylinder; `axis`: that of the lines.
  UprightCylinder(const Vector3d& middle, const Vector3d& way, double radius, double height, std::size_t upright,
                  std::size_t axis)
      : disc_(SweptBall(middle, flat(way, upright), radius), axis), radius2_(radius * radius), half_(height / 2) {
    const auto a = static_cast<Eigen::Index>(axis), k = static_cast<Eigen::Index>(upright);
    across_ = upright != axis;
    height_is_first_ = (axis + 1) % 3 == upright;
    level_ = middle[k], rise_ = way[k];
    first_ = middle[(a + 1) % 3], second_ = middle[(a + 2) % 3];
    way_first_ = way[(a + 1) % 3], way_second_ = way[(a + 2) % 3];
  }

  [[nodiscard]] bool operator()(double first, double second, double& from, double& to) const noexcept {
    double begin = 0, end = 1;
    if (!across_) {
      if (!passes(first - first_, second - second_, begin, end)) return false;
      from = level_ - half_ + std::min(begin * rise_, end * rise_);
      to = level_ + half_ + std::max(begin * rise_, end * rise_);
      return true;
    }
    if (!at_height(height_is_first_ ? first : second, begin, end)) return false;
    return height_is_first_ ? disc_.on_part(first_, second, begin, end, from, to)
                            : disc_.on_part(first, second_, begin, end, from, to);
  }
  /// Across the axis, lines of one height meet the same disc, and lines one above the other the same part of it.
  void operator()(const RayRow& row, RowMet& met) const noexcept {
    double begin = 0, end = 1;
    if (across_ && !height_is_first_) {
      if (!at_height(row.second, begin, end)) return met.none();
      disc_.on_part({row.first, second_}, begin, end, met);
    } else if (across_ && on_all_of_its_way(row.first.front()) && on_all_of_its_way(row.first.back())) {
      double from = 0, to = 0;
      if (!disc_.on_part(first_, row.second, begin, end, from, to)) return met.none();
      met.from.fill(from), met.to.fill(to);
    } else {
      meet_one_by_one(*this, row, met);
    }
  }

 private:
  static constexpr double kFlat = 1e-12;
  [[nodiscard]] static Vector3d flat(Vector3d way, std::size_t upright) {
    way[static_cast<Eigen::Index>(upright)] = 0;
    return way;
  }
  /// Whether it is ever at a height, and on what part of its way.
  [[nodiscard]] bool at_height(double height, double& begin, double& end) const noexcept {
    const double above = height - level_;
    if (std::abs(rise_) < kFlat) return std::abs(above) <= half_;
    const double one = (above - half_) / rise_, other = (above + half_) / rise_;
    begin = std::max(begin, std::min(one, other)), end = std::min(end, std::max(one, other));
    return begin <= end;
  }
  [[nodiscard]] bool on_all_of_its_way(double height) const noexcept {
    return std::abs(height - level_) <= half_ && std::abs(height - level_ - rise_) <= half_;
  }
  /// The part of its way on which its axis is nearer to a line along it than its radius.
  [[nodiscard]] bool passes(double u, double v, double& begin, double& end) const noexcept {
    const double speed2 = way_first_ * way_first_ + way_second_ * way_second_;
    const double dot = u * way_first_ + v * way_second_, beyond = u * u + v * v - radius2_;
    if (speed2 < kFlat * kFlat) return beyond < 0;
    const double under = dot * dot - speed2 * beyond;
    if (under <= 0) return false;
    const double half = std::sqrt(under);
    begin = std::max(0.0, (dot - half) / speed2), end = std::min(1.0, (dot + half) / speed2);
    return begin <= end;
  }

  SweptBall::Lines disc_;  ///< across its axis the cylinder is a disc, as the ball is in the plane of its way
  double radius2_, half_, level_ = 0, rise_ = 0;
  double first_ = 0, second_ = 0, way_first_ = 0, way_second_ = 0;
  bool across_ = false, height_is_first_ = false;
};

}  // namespace rmac::gateway
