#pragma once

namespace rmac {

/// What holds motors together that move one joint side by side (docs/servo.md, "Gantries"). mm, N and s at the joint,
/// or degrees, N·m and s.
struct Gantry {
  double max_skew = 0;   ///< between the foremost and the hindmost of them; beyond it the machine stops
  double stiffness = 0;  ///< N/mm or N·m/deg, of each against where the joint stands; 0: the machine's frame alone
  double damping = 0;    ///< N·s/mm or N·m·s/deg, the same
};

}  // namespace rmac
