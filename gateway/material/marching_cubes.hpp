#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rmac::gateway {

/// On which edges of a cube a surface goes through, by which of its corners are inside. Corner c lies at x = c & 1,
/// y = c >> 1 & 1, z = c >> 2. Edge e = 4·a + k runs along axis a; k counts the four along it by the coordinates
/// across, the next axis' first. Of a face of which only two corners across are inside, these two are kept apart, by
/// both cubes that share it: so surfaces close.
class MarchingCubes {
 public:
  /// Edges of one triangle, counter-clockwise from outside.
  using Triangle = std::array<std::uint8_t, 3>;

  MarchingCubes();
  [[nodiscard]] const std::vector<Triangle>& triangles(std::size_t corners_inside) const {
    return cases_[corners_inside];
  }
  /// The corner at which an edge begins.
  [[nodiscard]] static std::size_t begin_of(std::size_t edge) noexcept {
    const std::size_t axis = edge / 4, k = edge % 4;
    return (k & 1) << ((axis + 1) % 3) | (k >> 1) << ((axis + 2) % 3);
  }

 private:
  std::array<std::vector<Triangle>, 256> cases_;
};

}  // namespace rmac::gateway
