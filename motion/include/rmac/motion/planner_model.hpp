#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/ports/kinematics.hpp"

namespace rmac {

/// The mechanism as the planner sees it.
struct PlannerModel {
  std::shared_ptr<const Kinematics> kinematics;
  std::vector<JointLimits> joints;  ///< kinematic joints only
  double period_s = 0.001;
  double max_feed_mm_s = std::numeric_limits<double>::infinity();  ///< of the tool tip, whatever the override says
};

}  // namespace rmac
