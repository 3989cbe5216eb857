#pragma once

#include <vector>

namespace rmac {

/// Torque that a motor has of itself, with its current or without: slots and magnets pull it to certain angles. At the
/// shaft, in the drive's own sense (positive towards larger counts), at the angle φ = 2π · counts / counts a turn:
///
///     Σ cosine·cos(order·φ) + sine·sin(order·φ)
struct Cogging {
  struct Harmonic {
    int order = 0;  ///< periods a turn
    double cosine_nm = 0, sine_nm = 0;
  };
  std::vector<Harmonic> harmonics{};
  double lead_s = 0;  ///< from the cycle in which a torque is worked out until it acts
};

}  // namespace rmac
