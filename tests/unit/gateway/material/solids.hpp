#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <random>

#include "gateway/material/removal.hpp"
#include "gateway/material/stock.hpp"
#include "gateway/material/sweep/stroke_maker.hpp"

namespace rmac::gateway::test {

inline Eigen::Vector3d direction(std::mt19937_64& random) {
  std::normal_distribution<double> any;
  return Eigen::Vector3d(any(random), any(random), any(random)).normalized();
}

inline Body body_of(const SolidShape& shape, const Frame& pose = {}) {
  return {.name = "stock", .link = "", .shape = shape, .pose = pose, .colour = ""};
}

inline DexelGrid filled(const Stock& stock, double resolution_mm) {
  DexelGrid grid(DexelLayout::of(stock.bounds(), resolution_mm));
  stock.fill(grid);
  return grid;
}

/// A cube about the origin.
inline DexelGrid block(double size_mm, double resolution_mm) {
  return filled(Stock::read(body_of(BoxShape{{size_mm, size_mm, size_mm}})).value(), resolution_mm);
}

/// The mean of what the families of rays see.
inline double volume_of(const Removal& removal) {
  return (removal.volumes_mm3[0] + removal.volumes_mm3[1] + removal.volumes_mm3[2]) / 3;
}

/// Takes away what a piece passes on a curve of tool positions, t from 0 to 1, in so many steps; what went, mm³.
inline double remove_along(DexelGrid& grid, const ProfilePiece& piece, double tolerance_mm, int steps,
                           const std::function<ToolAt(double)>& at) {
  StrokeMaker strokes(piece, tolerance_mm);
  double removed = 0;
  const auto take = [&](const std::optional<Stroke>& stroke) {
    if (stroke) removed += volume_of(cut(grid, sweep_of(piece, *stroke), Cut::Remove));
  };
  for (int i = 0; i <= steps; ++i) take(strokes.go_to(at(static_cast<double>(i) / steps)));
  take(strokes.end());
  return removed;
}

}  // namespace rmac::gateway::test
