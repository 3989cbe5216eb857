#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

namespace rmac::cli {

struct Sample {
  double t_s = 0, value = 0;
};

/// How far the farthest of some values is from a plot of the page, which is straight between its keys.
inline double farthest(const nlohmann::json& plot, const std::vector<Sample>& values) {
  const auto t = plot.at("t").get<std::vector<double>>(), is = plot.at("is").get<std::vector<double>>();
  double most = 0;
  for (const auto& [t_s, value] : values) {
    const auto after = static_cast<std::size_t>(std::ranges::lower_bound(t, t_s - 1e-9) - t.begin());
    const std::size_t j = std::min(after, t.size() - 1), i = j > 0 ? j - 1 : 0;
    const double share = t[j] > t[i] ? std::clamp((t_s - t[i]) / (t[j] - t[i]), 0.0, 1.0) : 0;
    most = std::max(most, std::abs(is[i] + share * (is[j] - is[i]) - value));
  }
  return most;
}

}  // namespace rmac::cli
