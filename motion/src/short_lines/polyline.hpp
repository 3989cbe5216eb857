#pragma once

#include <optional>
#include <vector>

#include "rmac/motion/pose.hpp"

namespace rmac {

/// A polyline, and the parameter of a spline at each of its vertices. Line k goes from vertex k to k + 1.
struct Polyline {
  std::vector<Vector> vertices;
  std::vector<double> places;
  std::vector<double> off_mm;      ///< by how much each line misses what was sent
  std::optional<Vector> previous;  ///< the vertex before the first, where a spline comes from there

  /// The next vertex, and how long the line to it is.
  void add(const Vector& vertex, double length, double missed_mm = 0) {
    vertices.push_back(vertex);
    places.push_back(places.back() + length);
    off_mm.push_back(missed_mm);
  }
  [[nodiscard]] std::size_t lines() const noexcept { return vertices.size() - 1; }
};

}  // namespace rmac
