#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string>

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

/// Whether each parameter that is given is of `known` and numbers. False, with the reason in `error`, at the first that
/// is not: misspelt, it would be passed over.
[[nodiscard]] inline bool are_known_numbers(Parameters parameters, std::initializer_list<const char*> known,
                                            char* error, std::size_t error_size) {
  for (const Parameter& parameter : parameters) {
    const auto names_it = [&](const char* name) { return std::strcmp(name, parameter.name) == 0; };
    if (std::any_of(known.begin(), known.end(), names_it)) {
      if (parameter.text == nullptr) continue;
      std::snprintf(error, error_size, "parameter %s must be a number, and is a text", parameter.name);
      return false;
    }
    std::string names;
    for (const char* name : known) names += (names.empty() ? "" : ", ") + std::string(name);
    std::snprintf(error, error_size, "parameter %s is not understood; there are %s", parameter.name, names.c_str());
    return false;
  }
  return true;
}

}  // namespace rmac::sdk
