#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <limits>
#include <span>
#include <vector>

#include "gateway/chatter/vibration_mode.hpp"

namespace rmac::gateway {

/// Where a cut begins to chatter.
struct ChatterLimit {
  double share = std::numeric_limits<double>::infinity();  ///< of what it takes now: below 1 it chatters
  double frequency_hz = 0;                                 ///< at which it does
};

/// Whether the waves that a tooth leaves grow from one tooth to the next: Altintas and Budak's solution by the mean
/// over a turn of what chips change (Analytical prediction of stability lobes in milling, CIRP Annals 44/1, 1995; in
/// three directions Altintas, J. Manuf. Sci. Eng. 123, 2001), for any number of modes in any directions and any
/// engagement, of which `cutting` is the `chip_stiffness`. Its lobes are those of Hopf: a cut of few degrees, whose
/// teeth knock rather than push, has others that are not in it (docs/dynamics.md has how near it is).
class CutStability {
 public:
  /// N/mm; the mode's directions and `cutting` in one frame.
  CutStability(const Eigen::Matrix3d& cutting_n_mm, std::span<const VibrationMode> modes);

  /// With so long from one tooth to the next.
  [[nodiscard]] ChatterLimit at(double tooth_period_s) const;

  /// What no cut goes below whose `ChipStiffness` has at most this norm at each moment, found at once: waves that come
  /// back weaker than they went cannot grow.
  [[nodiscard]] static double least_share(double strongest_n_mm, std::span<const VibrationMode> modes);

 private:
  /// At one frequency: the inverses of the loop's eigenvalues with a tooth that meets no wave. A loop that is `share`
  /// as strong and meets its own waves later by `phase` swings on at that frequency where share·(1 - e^(-i·phase)) is
  /// one.
  struct Point {
    double omega_rad_s = 0;
    std::array<std::complex<double>, 3> inverse{};
  };
  [[nodiscard]] static double share_of(const std::complex<double>& inverse);
  [[nodiscard]] static double phase_of(const std::complex<double>& inverse);
  [[nodiscard]] Point point(double omega_rad_s) const;
  /// Adds what lies between the last one and this, as close as the three ways of neighbours go on from each other, and
  /// this.
  void add_up_to(Point next, int halvings);

  Eigen::Matrix3d cutting_;
  std::vector<VibrationMode> modes_;
  std::vector<Point> points_;  ///< from low frequencies to high; each way in the place of its neighbour's
};

}  // namespace rmac::gateway
