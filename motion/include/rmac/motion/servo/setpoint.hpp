#pragma once

#include <array>
#include <cstdint>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac {

/// The motion wanted in one cycle.
struct Setpoint {
  std::array<double, kMaxJoints> position{};
  std::array<double, kMaxJoints> velocity{};
  std::array<double, kMaxJoints> acceleration{};
  ToolPose pose;  ///< part frame
  std::int64_t move_id = 0;
  double s_mm = 0;               ///< within the client's move
  double feed_mm_s = 0;          ///< speed along the path
  bool moving = false;           ///< a plan is under way
  std::uint32_t moves_done = 0;  ///< moves whose end was reached since the cycle before, in the order they were queued
};

}  // namespace rmac
