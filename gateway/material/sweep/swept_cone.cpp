#include "gateway/material/sweep/swept_cone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gateway/material/sweep/axis_frame.hpp"

namespace rmac::gateway {
namespace {

/// Directions whose part along another is less than this have none: what is left out is below rounding.
constexpr double kNone = 1e-9;

}  // namespace

Eigen::AlignedBox3d SweptCone::bounds() const {
  const Vector3d half = axis_ * size_.height / 2, bottom = middle_ - half, top = middle_ + half;
  const Vector3d below = reach_of_disc(axis_, size_.bottom_radius), above = reach_of_disc(axis_, size_.top_radius);
  const Vector3d low = (bottom - below).cwiseMin(top - above), high = (bottom + below).cwiseMax(top + above);
  return {low + way_.cwiseMin(0), high + way_.cwiseMax(0)};
}

SweptCone SweptCone::wider(double by) const {
  const double slope = (size_.top_radius - size_.bottom_radius) / size_.height;
  // The side moves outwards by `by`, and both ends do.
  const double side = by * std::sqrt(1 + slope * slope);
  return {middle_,
          way_,
          axis_,
          {size_.bottom_radius + side - slope * by, size_.top_radius + side + slope * by, size_.height + 2 * by}};
}

/// Of what was found along the line.
struct SweptCone::Lines::Span {
  double from = std::numeric_limits<double>::infinity(), to = -std::numeric_limits<double>::infinity();
  void add(double s) noexcept { from = std::min(from, s), to = std::max(to, s); }
};

/// The line's own part of the quadratic form ss·s² + 2·st·s·t + tt·t² + 2·s1·s + 2·t1·t + c, at most 0 within the cone.
struct SweptCone::Lines::Here {
  Eigen::Vector3d point;  ///< at s = 0, t = 0
  double s1 = 0, t1 = 0, c = 0;
};

SweptCone::Lines::Lines(const SweptCone& cone, std::size_t axis) {
  const auto a = static_cast<Eigen::Index>(axis);
  const Eigen::Matrix3d turned = across_axis(cone.axis_);
  per_first_ = turned.col((a + 1) % 3), per_second_ = turned.col((a + 2) % 3), line_ = turned.col(a);
  begin_ = -(turned * (cone.middle_ - cone.axis_ * cone.size_.height / 2));
  way_ = turned * cone.way_;
  const Eigen::AlignedBox3d box = cone.bounds();
  low_ = box.min()[a] - 1, high_ = box.max()[a] + 1;
  height_ = cone.size_.height, radius_ = cone.size_.bottom_radius, top_radius_ = cone.size_.top_radius;
  slope_ = (top_radius_ - radius_) / height_;
  Eigen::Index upright = 0;
  constexpr double kUpright = 1 - 1e-15;
  if (slope_ == 0 && cone.axis_.cwiseAbs().maxCoeff(&upright) >= kUpright) {
    upright_.emplace(cone.middle_, cone.way_, radius_, height_, static_cast<std::size_t>(upright), axis);
  }
  const auto form = [this](const Vector3d& p, const Vector3d& q) {
    return p[0] * q[0] + p[1] * q[1] - slope_ * slope_ * p[2] * q[2];
  };
  ss_ = form(line_, line_), st_ = -form(line_, way_), tt_ = form(way_, way_);
}

/// The cone standing where a part of the way is done.
void SweptCone::Lines::at_end(const Here& here, double part, Span& span) const noexcept {
  double low = low_, high = high_;
  const double z = here.point[2] - part * way_[2];
  if (std::abs(line_[2]) > kNone) {
    const double bottom = -z / line_[2], top = (height_ - z) / line_[2];
    low = std::max(low, std::min(bottom, top)), high = std::min(high, std::max(bottom, top));
  } else if (z < 0 || z > height_) {
    return;
  }
  if (low > high) return;
  const double b = here.s1 + st_ * part, c = here.c + (2 * here.t1 + tt_ * part) * part;
  const auto outside = [&](double s) { return (ss_ * s + 2 * b) * s + c > 0; };
  if (!outside(low)) span.add(low);
  if (!outside(high)) span.add(high);
  const double under = b * b - ss_ * c;
  if (under < 0) return;
  const double q = -(b + std::copysign(std::sqrt(under), b));
  if (ss_ != 0 && q / ss_ > low && q / ss_ < high) span.add(q / ss_);
  if (q != 0 && c / q > low && c / q < high) span.add(c / q);
}

/// The side in between, where the cone touches what it leaves behind.
void SweptCone::Lines::at_envelope(const Here& here, Span& span) const noexcept {
  if (tt_ <= 0) return;
  const double a = ss_ - st_ * st_ / tt_, b = here.s1 - st_ * here.t1 / tt_, c = here.c - here.t1 * here.t1 / tt_;
  const double under = b * b - a * c;
  if (under < 0) return;
  const double q = -(b + std::copysign(std::sqrt(under), b));
  const auto try_at = [&](double s) {
    const double t = -(st_ * s + here.t1) / tt_;
    const double z = here.point[2] + s * line_[2] - t * way_[2];
    if (t > 0 && t < 1 && z > 0 && z < height_ && s > low_ && s < high_) span.add(s);
  };
  if (a != 0) try_at(q / a);
  if (q != 0) try_at(c / q);
}

/// A flat end on its way.
void SweptCone::Lines::on_plane(const Here& here, double height, double radius, Span& span) const noexcept {
  if (std::abs(line_[2]) <= kNone) {
    if (std::abs(way_[2]) <= kNone) return;
    const double part = (here.point[2] - height) / way_[2];
    if (part <= 0 || part >= 1) return;
    const double x = here.point[0] - part * way_[0], y = here.point[1] - part * way_[1];
    const double across2 = line_[0] * line_[0] + line_[1] * line_[1], beside = x * line_[1] - y * line_[0];
    const double under = across2 * radius * radius - beside * beside;
    if (under < 0) return;
    const double middle = -(x * line_[0] + y * line_[1]), half = std::sqrt(under);
    span.add((middle - half) / across2), span.add((middle + half) / across2);
    return;
  }
  // The line meets the plane of the end at s = s0 + s1 · t, in a point that runs straight as t does.
  const double s0 = (height - here.point[2]) / line_[2], s1 = way_[2] / line_[2];
  const double x0 = here.point[0] + s0 * line_[0], x1 = s1 * line_[0] - way_[0];
  const double y0 = here.point[1] + s0 * line_[1], y1 = s1 * line_[1] - way_[1];
  const double speed2 = x1 * x1 + y1 * y1;
  if (x0 * x0 + y0 * y0 <= radius * radius) span.add(s0);
  if (speed2 == 0) return;
  const double beside = x0 * y1 - y0 * x1, under = speed2 * radius * radius - beside * beside;
  if (under < 0) return;
  const double middle = -(x0 * x1 + y0 * y1), half = std::sqrt(under);
  const double in = (middle - half) / speed2, out = (middle + half) / speed2;
  if (in > 0 && in < 1) span.add(s0 + s1 * in);
  if (out > 0 && out < 1) span.add(s0 + s1 * out);
  if (in <= 1 && out >= 1) span.add(s0 + s1);
}

bool SweptCone::Lines::leaning(double first, double second, double& from, double& to) const noexcept {
  Here here;
  here.point = begin_ + first * per_first_ + second * per_second_;
  const Eigen::Vector3d& p = here.point;
  const double radius = radius_ + slope_ * p[2];
  here.s1 = p[0] * line_[0] + p[1] * line_[1] - slope_ * line_[2] * radius;
  here.t1 = -(p[0] * way_[0] + p[1] * way_[1] - slope_ * way_[2] * radius);
  here.c = p[0] * p[0] + p[1] * p[1] - radius * radius;
  Span span;
  at_end(here, 0, span);
  at_end(here, 1, span);
  at_envelope(here, span);
  on_plane(here, 0, radius_, span);
  on_plane(here, height_, top_radius_, span);
  from = span.from, to = span.to;
  return span.from < span.to;
}

}  // namespace rmac::gateway
