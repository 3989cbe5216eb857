#pragma once

#include <Eigen/Core>

#include "gateway/bodies/triangle_mesh.hpp"

namespace rmac::gateway::test {

/// A box of triangles, `parts` by `parts` on each side.
inline TriangleMesh box_mesh(const Eigen::Vector3d& half, int parts = 1) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int side : {-1, 1}) {
      for (int i = 0; i < parts; ++i) {
        for (int j = 0; j < parts; ++j) {
          const auto first = static_cast<std::uint32_t>(mesh.points.size());
          for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
            Eigen::Vector3d point;
            point[axis] = side * half[axis];
            point[u] = half[u] * (2.0 * (i + a) / parts - 1);
            point[v] = half[v] * (2.0 * (j + b) / parts - 1);
            mesh.points.push_back({point[0], point[1], point[2]});
          }
          const std::uint32_t b = side > 0 ? 1 : 3, d = side > 0 ? 3 : 1;
          mesh.triangles.push_back({first, first + b, first + 2});
          mesh.triangles.push_back({first, first + 2, first + d});
        }
      }
    }
  }
  return welded(mesh, 1e-9);
}

}  // namespace rmac::gateway::test
