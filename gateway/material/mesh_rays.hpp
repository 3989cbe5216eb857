#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "gateway/bodies/triangle_mesh.hpp"
#include "gateway/material/dexel_layout.hpp"

namespace rmac::gateway {

/// Where a ray of one family goes through the surface of a mesh.
struct Crossing {
  std::uint32_t ray = 0;
  float at = 0;  ///< along the ray, from the lattice's corner
  std::uint32_t triangle = 0;
  bool enters = false;  ///< the solid, in the sense of the axis
};

/// Those of a family's rays in some rows, ray by ray and in ascending order along each. Which rays a triangle covers is
/// decided in whole numbers, with rays on an edge on one side of it for both of its triangles, so that each ray enters
/// a closed surface as often as it leaves it.
struct Rows {
  std::uint32_t first = 0, end = 0;
};
[[nodiscard]] std::vector<Crossing> crossings(const TriangleMesh& mesh, const DexelLayout& layout, std::size_t axis,
                                              const Rows& rows);

/// Calls `visit(crossings of one ray)` for each ray of a family that goes through the surface, with some million
/// crossings at hand at a time.
void ray_by_ray(const TriangleMesh& mesh, const DexelLayout& layout, std::size_t axis,
                const std::function<void(std::span<const Crossing>)>& visit);

/// Which crossings begin and end the pieces of a ray that are inside of a closed surface, wherever it is at least once
/// around them.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> inside(std::span<const Crossing> of_one_ray);

}  // namespace rmac::gateway
