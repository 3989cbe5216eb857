#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <span>

#include "rmac/sdk/module.hpp"

namespace rmac::sdk {

/// One number among a module's parameters: its bounds, and what it is where `device.json` does not give it.
struct NumberParameter {
  const char* name;
  double otherwise;
  double min;
  double max;
  const char* unit;
};

/// Reads one number; false, with the reason in `error`, when it is out of its bounds or more than one.
[[nodiscard]] inline bool read_number(Parameters parameters, const NumberParameter& wanted, double& value, char* error,
                                      std::size_t error_size) noexcept {
  const std::span<const double> given = find_numbers(parameters, wanted.name);
  value = given.empty() ? wanted.otherwise : given[0];
  if (given.size() <= 1 && std::isfinite(value) && value >= wanted.min && value <= wanted.max) return true;
  std::snprintf(error, error_size, "parameter %s must be one number from %g to %g %s", wanted.name, wanted.min,
                wanted.max, wanted.unit);
  return false;
}

}  // namespace rmac::sdk
