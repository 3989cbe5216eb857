#pragma once

#include <cstdio>
#include <string>

#include "rmac/motion/vector.hpp"

namespace rmac::curves {

using rmac::along, rmac::cross, rmac::difference, rmac::distance, rmac::dot, rmac::finite, rmac::norm, rmac::scaled,
    rmac::unit;

/// A number for a message: as many digits as a person needs.
[[nodiscard]] inline std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.7g", value);
  return buffer;
}

}  // namespace rmac::curves
