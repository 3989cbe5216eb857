#pragma once

#include <limits>
#include <string>
#include <string_view>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Which numbers a value may be.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_excluded = false;

  [[nodiscard]] bool contains(double value) const noexcept {
    return (min_excluded ? value > min : value >= min) && value <= max;
  }
  /// "0 to 200", "more than 0", "" when everything goes.
  [[nodiscard]] std::string text() const;
};

/// What `device.json` allows for a number, as etc/device.schema.json declares it: "MaxFeedrate", "joint/MaxJerk".
/// Files, the API's setters and the check of a draft all have it from here.
[[nodiscard]] Range device_range(std::string_view key);

/// Refuses a value that `device_range(key)` does not contain; `what` names it in the message.
[[nodiscard]] Expected<> check_device_range(std::string_view key, double value, const std::string& what);

}  // namespace rmac::gateway
