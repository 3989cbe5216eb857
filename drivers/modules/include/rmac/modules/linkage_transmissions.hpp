#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "rmac/modules/single_transmission.hpp"

namespace rmac::modules {

/// A piston that turns a lever: an electric cylinder between a point of the frame, `base_mm` from the pivot, and a
/// point of the lever, `lever_mm` from it. The joint is the lever's angle in degrees; at 0 the lines from the pivot to
/// the two points make `angle_at_zero`. By the law of cosines the piston's length is
///
///     L² = base² + lever² - 2 base lever cos(angle)
class LeverPiston final : public SingleTransmission {
 public:
  struct Parameters {
    double base_mm, lever_mm, angle_at_zero_deg;
    double lead_mm, gear;     ///< of the screw in the cylinder
    double min_deg, max_deg;  ///< travel of the joint
  };
  /// Nearer than this to where pivot and both points lie on a line, the piston cannot turn the lever.
  static constexpr double kLeastAngleDeg = 5;

  explicit LeverPiston(const Parameters& parameters) noexcept
      : SingleTransmission(JointUnit::Degree),
        base_(parameters.base_mm),
        lever_(parameters.lever_mm),
        zero_(parameters.angle_at_zero_deg * kRadPerDegree),
        rad_per_mm_(2 * std::numbers::pi * parameters.gear / parameters.lead_mm),
        length_at_zero_(length(zero_)) {}

  [[nodiscard]] static bool turns_everywhere(const Parameters& parameters) noexcept {
    const double least = parameters.angle_at_zero_deg + parameters.min_deg;
    const double most = parameters.angle_at_zero_deg + parameters.max_deg;
    return least < most && least >= kLeastAngleDeg && most <= 180 - kLeastAngleDeg;
  }

 private:
  [[nodiscard]] double length(double angle) const noexcept {
    return std::sqrt(base_ * base_ + lever_ * lever_ - 2 * base_ * lever_ * std::cos(angle));
  }
  [[nodiscard]] double shaft(double joint) const noexcept override {
    return rad_per_mm_ * (length(zero_ + joint * kRadPerDegree) - length_at_zero_);
  }
  [[nodiscard]] double joint(double shaft) const noexcept override {
    const double l = length_at_zero_ + shaft / rad_per_mm_;
    const double cosine = (base_ * base_ + lever_ * lever_ - l * l) / (2 * base_ * lever_);
    return (std::acos(std::clamp(cosine, -1.0, 1.0)) - zero_) / kRadPerDegree;
  }
  [[nodiscard]] double slope(double joint) const noexcept override {
    const double angle = zero_ + joint * kRadPerDegree;
    return rad_per_mm_ * kRadPerDegree * base_ * lever_ * std::sin(angle) / length(angle);
  }

  double base_, lever_, zero_, rad_per_mm_, length_at_zero_;
};

/// A four-bar linkage: a motor turns the crank, a coupler takes the rocker along, and the rocker is the joint, in
/// degrees. Crank pivot at the origin, rocker pivot at (ground, 0); angles count from the line between them. The rocker
/// stands at `rocker_at_zero` where the joint is 0; `branch`, 1 or -1, says on which side of the line from the crank's
/// pivot to the rocker's pin the crank is.
class FourBarLinkage final : public SingleTransmission {
 public:
  struct Parameters {
    double crank_mm, coupler_mm, rocker_mm, ground_mm;
    double gear;  ///< motor turns a turn of the crank
    double rocker_at_zero_deg;
    double branch;
    double min_deg, max_deg;  ///< travel of the joint
  };
  /// Coupler and crank, and coupler and rocker, must make at least this angle: a linkage hardly moves below it.
  static constexpr double kLeastAngleDeg = 10;

  explicit FourBarLinkage(const Parameters& parameters) noexcept
      : SingleTransmission(JointUnit::Degree), p_(parameters), zero_(parameters.rocker_at_zero_deg * kRadPerDegree) {
    const Bars at_zero = bars(zero_);
    crank_at_zero_ = at_zero.crank;
    rocker_side_ = across_rocker(at_zero) > 0 ? 1 : -1;
  }

  /// The linkage closes and transmits everywhere on its way, without passing a dead centre.
  [[nodiscard]] bool turns_everywhere() const noexcept {
    if (!(p_.min_deg < p_.max_deg)) return false;
    const double least = std::sin(kLeastAngleDeg * kRadPerDegree);
    const auto sound = [&](double joint) {
      const Bars at = bars(zero_ + joint * kRadPerDegree);
      return at.closes && p_.branch * across_crank(at) >= least && rocker_side_ * across_rocker(at) >= least;
    };
    constexpr double kStepDeg = 0.25;
    for (double joint = p_.min_deg; joint < p_.max_deg; joint += kStepDeg) {
      if (!sound(joint)) return false;
    }
    return sound(0) && sound(p_.max_deg);
  }

 private:
  using Point = std::array<double, 2>;
  struct Bars {
    double crank, rocker;  ///< rad
    Point coupler;         ///< direction from the crank's pin to the rocker's
    bool closes;
  };

  [[nodiscard]] Bars make_bars(double crank, double rocker, bool closes) const noexcept {
    const Point along{p_.ground_mm + p_.rocker_mm * std::cos(rocker) - p_.crank_mm * std::cos(crank),
                      p_.rocker_mm * std::sin(rocker) - p_.crank_mm * std::sin(crank)};
    const double length = std::hypot(along[0], along[1]);
    return {crank, rocker, {along[0] / length, along[1] / length}, closes};
  }
  /// From the rocker's angle: in the triangle of crank pivot and both pins, all sides are known.
  [[nodiscard]] Bars bars(double rocker) const noexcept {
    const double x = p_.ground_mm + p_.rocker_mm * std::cos(rocker);
    const double y = p_.rocker_mm * std::sin(rocker);
    const double far = std::hypot(x, y);
    const double cosine =
        (p_.crank_mm * p_.crank_mm + far * far - p_.coupler_mm * p_.coupler_mm) / (2 * p_.crank_mm * far);
    const double crank = std::atan2(y, x) + p_.branch * std::acos(std::clamp(cosine, -1.0, 1.0));
    return make_bars(crank, rocker, std::abs(cosine) < 1);
  }
  /// From the crank's angle: the same in the triangle of rocker pivot and both pins.
  [[nodiscard]] double rocker(double crank) const noexcept {
    const double x = p_.crank_mm * std::cos(crank) - p_.ground_mm;
    const double y = p_.crank_mm * std::sin(crank);
    const double far = std::hypot(x, y);
    const double cosine =
        (p_.rocker_mm * p_.rocker_mm + far * far - p_.coupler_mm * p_.coupler_mm) / (2 * p_.rocker_mm * far);
    return std::atan2(y, x) - rocker_side_ * std::acos(std::clamp(cosine, -1.0, 1.0));
  }
  /// Sine of the angle from coupler to crank, and to rocker: how much of the coupler's pull turns each of them.
  [[nodiscard]] static double across_crank(const Bars& at) noexcept {
    return at.coupler[0] * std::sin(at.crank) - at.coupler[1] * std::cos(at.crank);
  }
  [[nodiscard]] static double across_rocker(const Bars& at) noexcept {
    return at.coupler[0] * std::sin(at.rocker) - at.coupler[1] * std::cos(at.rocker);
  }

  [[nodiscard]] double shaft(double joint) const noexcept override {
    const double turned = bars(zero_ + joint * kRadPerDegree).crank - crank_at_zero_;
    return p_.gear * std::remainder(turned, 2 * std::numbers::pi);
  }
  [[nodiscard]] double joint(double shaft) const noexcept override {
    return std::remainder(rocker(crank_at_zero_ + shaft / p_.gear) - zero_, 2 * std::numbers::pi) / kRadPerDegree;
  }
  /// Both pins have the same speed along the coupler.
  [[nodiscard]] double slope(double joint) const noexcept override {
    const Bars at = bars(zero_ + joint * kRadPerDegree);
    return p_.gear * kRadPerDegree * (p_.rocker_mm * across_rocker(at)) / (p_.crank_mm * across_crank(at));
  }

  Parameters p_;
  double zero_;
  double crank_at_zero_;
  double rocker_side_;
};

}  // namespace rmac::modules
