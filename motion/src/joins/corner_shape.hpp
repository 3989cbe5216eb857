#pragma once

#include <span>

namespace rmac {

/// How a blend of two lines of direction T0 and T1 runs on the parameter u in [-1, 1], for a reach of 1
/// (docs/derivations/joins.md, section 2): P(u) = -f(-u) T0 + f(u) T1 about the corner, the third derivative of f
/// constant on stretches. Either that derivative is odd: then the blend is travelled at constant speed, and may swing
/// out on an outer stretch of length `lobe` before the corner, and turn evenly on a middle one of half length `flat`.
/// Or it has two values, and the blend takes up braking before the corner, and acceleration behind it.
struct CornerShape {
  double lobe = 0;
  double flat = 0;
  double entry_speed = 1;         ///< f'(1): of the path at the blend's ends, per du/dt
  double entry_acceleration = 0;  ///< f''(1): braking into the blend, and acceleration out of it
  double acceleration = 0;        ///< f''(0): along T1 - T0, at the corner
  double jerk_far = 0;            ///< f''' for u < 0: along T1 before the corner, along T0 behind it
  double jerk_near = 0;           ///< f''' for u > 0: along T0 before the corner, along T1 behind it
  double deviation = 0;           ///< largest distance from the lines, as a part of |T1 - T0|
};

/// Every shape worth trying; the first stays inside the corner and at constant speed.
[[nodiscard]] std::span<const CornerShape> corner_shapes();

}  // namespace rmac
