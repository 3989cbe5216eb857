#pragma once

#include <optional>
#include <vector>

#include "rmac/motion/pose.hpp"

namespace rmac {

/// A polyline, and the parameter of a spline at each of its vertices. Line k goes from vertex k to k + 1.
struct Polyline {
  std::vector<Vector> vertices;
  std::vector<double> places;
  std::optional<Vector> previous;  ///< the vertex before the first, where a spline comes from there
  [[nodiscard]] std::size_t lines() const noexcept { return vertices.size() - 1; }
};

}  // namespace rmac
