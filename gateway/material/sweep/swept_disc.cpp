#include "gateway/material/sweep/swept_disc.hpp"

#include <algorithm>
#include <cmath>

#include "gateway/material/sweep/axis_frame.hpp"

namespace rmac::gateway {
namespace {

constexpr double kPrecise_mm = 1e-7;  ///< of a distance
constexpr int kMostSteps = 60;        ///< lines that graze come near in halves

}  // namespace

Eigen::AlignedBox3d SweptDisc::bounds() const {
  const Vector3d reach = reach_of_disc(axis_, radius_) + Vector3d::Constant(rounded_), to = from_ + way_;
  return {from_.cwiseMin(to) - reach, from_.cwiseMax(to) + reach};
}

SweptDisc::Lines::Lines(const SweptDisc& disc, std::size_t axis)
    : around_(SweptBall(disc.from_, disc.way_, disc.radius_ + disc.rounded_), axis),
      radius_(disc.radius_),
      rounded_(disc.rounded_) {
  const auto a = static_cast<Eigen::Index>(axis);
  const Eigen::Matrix3d turned = across_axis(disc.axis_);
  per_first_ = turned.col((a + 1) % 3), per_second_ = turned.col((a + 2) % 3), line_ = turned.col(a);
  begin_ = -(turned * disc.from_);
  way_ = turned * disc.way_;
}

/// From the nearest point of the disc to a point in the disc's frame; `falls`: how fast its part along the way gets
/// less when the disc moves on.
Eigen::Vector3d SweptDisc::Lines::beyond(const Eigen::Vector3d& point, double& falls) const noexcept {
  const double out = std::sqrt(point[0] * point[0] + point[1] * point[1]);
  falls = way_[2] * way_[2];
  if (out <= radius_) return {0, 0, point[2]};
  const double rim = radius_ / out, past = 1 - rim;
  const double outwards = (point[0] * way_[0] + point[1] * way_[1]) / out;
  falls += past * (way_[0] * way_[0] + way_[1] * way_[1]) + rim * outwards * outwards;
  return {past * point[0], past * point[1], point[2]};
}

/// How far a point is from the nearest place of the disc on its way; `part` of the way is where to begin to look, and
/// where it is.
SweptDisc::Lines::Near SweptDisc::Lines::near(const Eigen::Vector3d& point, double& part) const noexcept {
  double low = 0, high = 1, falls = 0;
  Eigen::Vector3d gap = Eigen::Vector3d::Zero();
  // What is left along the way falls as the disc moves on: where it is nothing the disc is nearest.
  for (int i = 0; i < kMostSteps; ++i) {
    gap = beyond(point - part * way_, falls);
    const double left = gap.dot(way_);
    if (left > 0) {
      low = part;
      if (part >= 1) break;
    } else {
      high = part;
      if (part <= 0) break;
    }
    double next = falls > 0 ? part + left / falls : (left > 0 ? 1 : 0);
    if (!(next > low)) next = low == 0 && next <= 0 ? 0 : (low + high) / 2;
    if (!(next < high)) next = high == 1 && next >= 1 ? 1 : (low + high) / 2;
    const bool done = std::abs(next - part) * way_.norm() < kPrecise_mm;
    part = next;
    if (done) {
      gap = beyond(point - part * way_, falls);
      break;
    }
  }
  const double distance = gap.norm();
  return {distance, distance > 0 ? gap.dot(line_) / distance : 0};
}

/// From `at`, which is outside, in a sense along the line to the surface. False: it is never met.
bool SweptDisc::Lines::enter(const Eigen::Vector3d& origin, double sense, double& at) const noexcept {
  double part = 0.5;
  for (int i = 0; i < kMostSteps; ++i) {
    const Near here = near(origin + at * line_, part);
    const double left = here.distance - rounded_;
    if (left < kPrecise_mm) return true;
    const double slope = sense * here.slope;
    if (slope >= 0) return false;
    at += sense * left / -slope;
  }
  return true;
}

bool SweptDisc::Lines::operator()(double first, double second, double& from, double& to) const noexcept {
  if (!around_(first, second, from, to)) return false;
  const Eigen::Vector3d origin = begin_ + first * per_first_ + second * per_second_;
  return enter(origin, 1, from) && enter(origin, -1, to) && from < to;
}

}  // namespace rmac::gateway
