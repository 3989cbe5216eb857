#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "gateway/material/dexel_grid.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

using SurfaceTriangle = std::array<Eigen::Vector3f, 3>;

/// The surface of the material as triangles, in the part frame, their corners counter-clockwise from outside: marching
/// cubes over the points where rays of all three families meet, each n-th of them. Every corner is where a ray enters
/// or leaves the material. The surface is closed. What is thinner than the points are apart may be missing, and edges
/// are cut off by up to that.
void surface(const DexelGrid& grid, std::uint32_t each_nth, const std::function<void(const SurfaceTriangle&)>& visit);

/// The finest `each_nth` that makes no more triangles than are wanted, and how many it makes.
struct Fineness {
  std::uint32_t each_nth = 1;
  std::size_t triangles = 0;
};
[[nodiscard]] Fineness finest(const DexelGrid& grid, std::size_t most_triangles);

/// What was written.
struct SurfaceFile {
  std::size_t triangles = 0;
  double apart_mm = 0;  ///< the points, at most
};

/// Writes it as binary STL, as fine as `most_triangles` allow. Refused where the file cannot be written; nothing of it
/// stays then.
[[nodiscard]] Expected<SurfaceFile> write_stl(const DexelGrid& grid, const std::filesystem::path& file,
                                              std::size_t most_triangles);

}  // namespace rmac::gateway
