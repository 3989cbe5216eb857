#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "rmac/motion/pose.hpp"

namespace rmac::gateway {

/// A surface of triangles; seen from outside the corners of each go round counter-clockwise. mm.
struct TriangleMesh {
  std::vector<Vector> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Makes one point of those that are closer than `apart_mm`, and drops triangles that have no area left: a file of
/// triangles has each corner once a triangle, and programs that write them round.
[[nodiscard]] TriangleMesh welded(const TriangleMesh& mesh, double apart_mm);

/// The volume inside, negative where the surface is turned inside out.
[[nodiscard]] double volume_mm3(const TriangleMesh& mesh);

/// Why a mesh is not the surface of a solid, in words that follow the name of it: open, wound in both senses, inside
/// out, or nothing inside. Empty: it is one.
[[nodiscard]] std::string fault_of(const TriangleMesh& mesh);

}  // namespace rmac::gateway
