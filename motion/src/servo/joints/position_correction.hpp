#pragma once

#include "rmac/motion/error.hpp"
#include "rmac/motion/joint_mechanics.hpp"

namespace rmac {

/// From where the drive shows a joint to where the joint is, and back. Shown = by counts, scale and actuator map.
class PositionCorrection {
 public:
  explicit PositionCorrection(const JointMechanics& mechanics);

  /// Which flank of the backlash carries, from -1 to 1: it follows the sign of the wanted velocity, on a cycloid of
  /// `kCrossingS`, so that the loop is not hit by a step. Once a cycle.
  void follow(double wanted_velocity, double period_s) noexcept;
  /// What crossing adds to the drive's motion, so that feedforward knows of it: mm/s or deg/s, and mm/s² or deg/s².
  [[nodiscard]] double crossing_velocity() const noexcept { return side_rate_ * half_backlash_; }
  [[nodiscard]] double crossing_acceleration() const noexcept { return side_acceleration_ * half_backlash_; }
  [[nodiscard]] double side() const noexcept { return side_; }
  void set_side(double side) noexcept;

  [[nodiscard]] double actual(double shown) const noexcept { return shown + error(shown) - side_ * half_backlash_; }
  [[nodiscard]] double actual_velocity(double shown, double shown_velocity) const noexcept {
    return shown_velocity * (1 + slope(shown)) - crossing_velocity();
  }
  /// Inverse of `actual`.
  [[nodiscard]] double shown(double actual) const noexcept;

  /// Time that the drive takes to cross the backlash. Meanwhile the joint stands still where it should move; a shorter
  /// time asks for more torque, in proportion to its inverse square.
  static constexpr double kCrossingS = 0.008;
  /// Wanted velocities below this (mm/s or deg/s) are standing still.
  static constexpr double kStanding = 1e-3;

 private:
  [[nodiscard]] double error(double shown) const noexcept;
  [[nodiscard]] double slope(double shown) const noexcept;

  PitchErrors pitch_;
  double half_backlash_;
  double side_ = 0;
  double side_rate_ = 0, side_acceleration_ = 0;  ///< 1/s, 1/s²
  double from_ = 0, to_ = 0;                      ///< sides of the crossing under way
  double crossed_s_ = kCrossingS;                 ///< since it began
};

/// What makes no sense in `mechanics`, named; `who` is the joint.
[[nodiscard]] Expected<> check_mechanics(const JointMechanics& mechanics, double period_s, const std::string& who);

}  // namespace rmac
