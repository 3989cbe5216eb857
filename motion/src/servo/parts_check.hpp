#pragma once

#include "rmac/motion/error.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"

namespace rmac {

/// Whether a servo loop can be made of these parts; the error says which do not fit together.
[[nodiscard]] Expected<> check_servo_loop_parts(const ServoLoopParts& parts);

}  // namespace rmac
