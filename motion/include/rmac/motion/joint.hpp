#pragma once

namespace rmac {

enum class JointType { Rotary = 0, Linear = 1, Screw = 2 };
enum class ControlMethod { Position = 0, Velocity = 1, Force = 2 };

}  // namespace rmac
