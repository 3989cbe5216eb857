#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "rmac/modules/screw_axis.hpp"

namespace rmac::modules {

/// A direction closer than this to a turn's own axis says nothing about the angle of that turn: ten thousand times the
/// rounding of a unit vector, and far below what any machine can tell. In rad.
inline constexpr double kPoleAngle = 1e-12;
/// How far a direction may lie outside of what turns can reach, in rad: what programs round off.
inline constexpr double kAxisSlack = 1e-6;

/// The angle, in rad, by which `from` turns about `axis` into `to` (Paden and Kahan's subproblem 1, for directions).
/// Both enter through what of them is across the axis, so that directions close to it keep their digits.
[[nodiscard]] inline double angle_about(const Vector& axis, const Vector& from, const Vector& to) noexcept {
  const Vector a = cross(axis, from), b = cross(axis, to);
  return std::atan2(dot(axis, cross(a, b)), dot(a, b));
}

/// Angles of one or two turns, in rad. A turn that the direction does not determine is `free`, and its angle means
/// nothing.
struct TurnAngles {
  std::array<double, 2> angle{};
  std::array<bool, 2> free{};
};

/// Which turns take one direction into another: exp(ξ₁ θ₁) exp(ξ₂ θ₂) from = to (Paden and Kahan's subproblem 2, for
/// directions; docs/derivations/chain-kinematics.md). Real-time safe.
class TwoTurns {
 public:
  TwoTurns() = default;
  /// The directions of the two axes must not be parallel.
  TwoTurns(const Vector& first, const Vector& second) noexcept : first_(first), second_(second) {
    cosine_ = dot(first, second);
    const Vector across = plus(second, -cosine_, first);
    sine_ = length(across);
    for (std::size_t c = 0; c < 3; ++c) e_[c] = across[c] / sine_;
    f_ = cross(first, e_);
  }

  /// 0 where `to` is out of reach, else 2 (which agree where the two branches meet).
  std::size_t solve(const Vector& from, const Vector& to, std::array<TurnAngles, 2>& found) const noexcept {
    // Between the turns the direction is z = (to·d₁) d₁ + u e + v f: as far around d₁ as `to`, as far from d₂ as `from`
    // (eq. 4 to 6).
    const double height = dot(to, first_);
    const double to_e = dot(to, e_), to_f = dot(to, f_);
    const double radius = std::hypot(to_e, to_f);
    const double u = (dot(from, second_) - cosine_ * height) / sine_;
    const double square = (radius - u) * (radius + u);
    if (!(std::abs(u) - radius <= kAxisSlack)) return 0;
    const double v = square > 0 ? std::sqrt(square) : 0;
    const bool second_free = length(cross(second_, from)) <= kPoleAngle;
    for (std::size_t branch = 0; branch < 2; ++branch) {
      const double sign = branch == 0 ? 1 : -1;
      const Vector z = plus(plus({height * first_[0], height * first_[1], height * first_[2]}, u, e_), sign * v, f_);
      found[branch].angle = {std::atan2(u * to_f - sign * v * to_e, u * to_e + sign * v * to_f),
                             angle_about(second_, from, z)};
      found[branch].free = {radius <= kPoleAngle, second_free};
    }
    return 2;
  }

 private:
  Vector first_{0, 0, 1}, second_{1, 0, 0};
  Vector e_{1, 0, 0}, f_{0, 1, 0};  ///< with the first direction, a right-handed frame that holds the second in d₁, e
  double cosine_ = 0, sine_ = 1;    ///< of the angle between the two
};

/// The same for a single turn: `to` must lie on the cone that `from` sweeps.
[[nodiscard]] inline std::size_t solve_turn(const Vector& axis, const Vector& from, const Vector& to,
                                            std::array<TurnAngles, 2>& found) noexcept {
  const double from_radius = length(cross(axis, from)), to_radius = length(cross(axis, to));
  const double off = std::hypot(from_radius - to_radius, dot(axis, from) - dot(axis, to));
  if (!(off <= kAxisSlack)) return 0;
  found[0].angle = {angle_about(axis, from, to), 0};
  found[0].free = {from_radius <= kPoleAngle || to_radius <= kPoleAngle, true};
  return 1;
}

}  // namespace rmac::modules
