#pragma once

#include <cmath>
#include <string>

#include "rmac/motion/error.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac {

/// Refuses a frame that is not finite, or whose quaternion's length is further than 1e-6 from 1. `name` says which
/// frame in the message.
[[nodiscard]] inline Expected<> check_frame(const Frame& frame, const std::string& name) {
  double sum = 0;
  for (const double c : frame.p) {
    if (!std::isfinite(c)) {
      return failure(MinorCode::InvalidParameterValue, name + ": the origin p holds a number that is not finite");
    }
  }
  for (const double c : frame.q) sum += c * c;
  if (!std::isfinite(sum)) {
    return failure(MinorCode::InvalidParameterValue, name + ": the quaternion q holds a number that is not finite");
  }
  if (std::abs(std::sqrt(sum) - 1) > 1e-6) {
    return failure(MinorCode::InvalidParameterValue, name + ": the quaternion q has length " +
                                                         std::to_string(std::sqrt(sum)) +
                                                         ", it must be 1 (to 1e-6): divide w, x, y, z by its length");
  }
  return {};
}

}  // namespace rmac
