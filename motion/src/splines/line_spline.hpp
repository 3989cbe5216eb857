#pragma once

#include <optional>
#include <vector>

#include "rmac/motion/pose.hpp"
#include "splines/smoothing_spline.hpp"

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

/// A quintic spline along a polyline, its parameter the length along it. Found window by window, each going on from
/// `before`: what the window before leaves it, or an empty one where nothing comes before.
struct LineSpline {
  std::vector<double> knots;
  std::vector<Vector> points;
  std::vector<double> deviations;     ///< bound of its distance from each line
  std::vector<SplineSample> samples;  ///< what shaped it where the lines are dense

  [[nodiscard]] bool empty() const noexcept { return knots.empty(); }
  /// Where it begins.
  [[nodiscard]] double begin() const noexcept;
  /// Where the next window, going on from it, may lay knots of its own.
  [[nodiscard]] double free_from() const noexcept;
  /// Control points that the next window takes over: with those, nothing jumps up to the fourth derivative.
  [[nodiscard]] std::size_t kept_points() const noexcept;

  /// Knots and control points that go on from `before`: its own, these knots, and the end of the polyline. Control
  /// points that are not kept are to be found. False where there are too few.
  [[nodiscard]] bool go_on(const LineSpline& before, const std::vector<double>& inner, const Polyline& polyline);
  /// What the next window goes on from: all from this knot on, its parameter counted from `place`.
  void leave(std::size_t knot, double place);
};

}  // namespace rmac
