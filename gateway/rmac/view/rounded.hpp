#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

namespace rmac::cli {

/// A number with as many digits behind the point as are worth a place in the page.
[[nodiscard]] inline double rounded(double value, int digits) {
  const double scale = std::pow(10.0, digits);
  return std::round(value * scale) / scale + 0.0;  // no -0
}

inline constexpr int kPlaceDigits = 3;  ///< µm
inline constexpr int kTurnDigits = 6;   ///< of a quaternion: 1 µm at 0.5 m
inline constexpr int kTimeDigits = 6;

[[nodiscard]] inline nlohmann::json rounded(std::span<const double> values, int digits) {
  nlohmann::json list = nlohmann::json::array();
  for (const double value : values) list.push_back(rounded(value, digits));
  return list;
}

}  // namespace rmac::cli
