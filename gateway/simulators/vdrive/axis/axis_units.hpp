#pragma once

#include "gateway/simulators/vdrive/objects/dictionary.hpp"

namespace rmac::vdrive {

/// Units and sense of what the master says and hears (CiA 402-2, 608Fh, 6091h, 6092h, 607Eh), for each count of the
/// encoder and as the dictionary has them now.
class AxisUnits {
 public:
  explicit AxisUnits(const Dictionary& dictionary) : dictionary_(dictionary) {}

  /// For lengths and their derivatives, whichever way these go.
  [[nodiscard]] double per_count() const;
  /// Negative where positions are turned round.
  [[nodiscard]] double of_position() const;
  /// Negative where velocities are turned round.
  [[nodiscard]] double of_velocity() const;

 private:
  const Dictionary& dictionary_;
};

}  // namespace rmac::vdrive
