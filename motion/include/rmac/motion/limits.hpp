#pragma once

#include <string>

#include "rmac/motion/axis.hpp"

namespace rmac {

enum class JointLimitType { Limited = 0, Infinite = 1, InfinitePositive = 2, InfiniteNegative = 3 };

/// Bounds of one joint, in mm and s, or degrees and s for a rotary one.
struct JointLimits {
  std::string name;
  JointType type = JointType::Linear;
  JointLimitType limit_type = JointLimitType::Limited;
  double min = 0;
  double max = 0;
  double max_speed = 0;
  double max_acceleration = 0;
  double max_jerk = 0;
};

}  // namespace rmac
