#pragma once

#include <cmath>
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

/// Whether the travel has an upper, or a lower, end.
[[nodiscard]] inline bool ends_above(JointLimitType type) noexcept {
  return type == JointLimitType::Limited || type == JointLimitType::InfiniteNegative;
}
[[nodiscard]] inline bool ends_below(JointLimitType type) noexcept {
  return type == JointLimitType::Limited || type == JointLimitType::InfinitePositive;
}
[[nodiscard]] inline bool ends_above(const JointLimits& joint) noexcept {
  return ends_above(joint.limit_type);
}
[[nodiscard]] inline bool ends_below(const JointLimits& joint) noexcept {
  return ends_below(joint.limit_type);
}

/// The position of a rotary joint, brought by as few whole turns as it takes into its travel, or to beyond the other
/// end where its travel is shorter than that.
[[nodiscard]] inline double unwound(const JointLimits& joint, double position) noexcept {
  constexpr double kTurn = 360;
  if (joint.type != JointType::Rotary) return position;
  if (ends_above(joint) && position > joint.max) return position - kTurn * std::ceil((position - joint.max) / kTurn);
  if (ends_below(joint) && position < joint.min) return position + kTurn * std::ceil((joint.min - position) / kTurn);
  return position;
}

}  // namespace rmac
