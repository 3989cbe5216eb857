#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gateway/chatter/vibration_mode.hpp"

namespace rmac::gateway {

/// A tool that swings against the waves of the tooth before, step by step: slower than `CutStability`, and right also
/// where teeth are in material for a small part of the turn, so that what they change is anything but its mean.
class CutInTime {
 public:
  /// `over_pitch`: `ChipStiffness`, N/mm; of teeth that are all alike. In one frame with the modes.
  CutInTime(std::span<const Eigen::Matrix3d> over_pitch_n_mm, std::span<const VibrationMode> modes);

  /// Whether it is known at up to twice this share: many modes far from each other, or waves without number between two
  /// teeth, would take too long.
  [[nodiscard]] bool can_tell(double share, double tooth_period_s) const;
  /// Whether waves grow, with so much of what it takes and so long from tooth to tooth; not where nobody can tell.
  [[nodiscard]] bool grows(double share, double tooth_period_s) const;
  /// A share at which they begin to, to 3 %, looked for within half and twice of a first guess; one of these ends where
  /// it is beyond.
  [[nodiscard]] double limit(double near, double tooth_period_s) const;

 private:
  struct Length {
    int steps = 0, teeth = 0;  ///< from tooth to tooth, and how many; none: too long
  };
  [[nodiscard]] Length length_of(double share, double tooth_period_s) const;
  struct Oscillator {
    double omega_rad_s = 0, damping_ratio = 0;
    double gain = 0;  ///< ω²/k
    Eigen::Vector3d along{0, 0, 0};
  };
  std::vector<Eigen::Matrix3d> over_pitch_;
  double strongest_n_mm_ = 0;  ///< norm
  std::vector<Oscillator> oscillators_;
};

}  // namespace rmac::gateway
