#pragma once

#include <random>
#include <string>
#include <vector>

#include "rmac/motion/move.hpp"
#include "rmac/motion/planner_model.hpp"

namespace rmac::bench {

/// A program of any kind that a CAM system, or a person, may send, for a machine of any limits.
struct RandomProgram {
  std::string name;  ///< its kind and numbers, for who looks for it again
  PlannerModel model;
  std::vector<Move> moves;  ///< end to end
  double tolerance_mm = 0;
};

/// The program of a number: always the same.
[[nodiscard]] RandomProgram random_program(unsigned long number);

}  // namespace rmac::bench
