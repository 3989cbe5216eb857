#pragma once

#include <cstdint>

namespace rmac {

enum class JointType { Rotary = 0, Linear = 1, Screw = 2 };
enum class ControlMethod { Position = 0, Velocity = 1, Force = 2 };

/// How the words of one drive become shaft values: counts to rad, per mille of rated torque to N·m.
struct DriveScale {
  double counts_per_revolution = 0;
  double rated_torque_nm = 0;
  int direction = 1;             ///< +1 or -1: the shaft's sense against the drive's
  std::int32_t home_counts = 0;  ///< encoder reading where the shaft angle is zero
};

}  // namespace rmac
