#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "gateway/bodies/triangle_mesh.hpp"
#include "gateway/collision/distance/convex.hpp"

namespace rmac::gateway {

/// The triangles of a closed surface in a tree of boxes along the axes of its frame.
class TriangleTree {
 public:
  using Vector3d = Eigen::Vector3d;
  using Box = Eigen::AlignedBox3d;
  struct Node {
    Box box;
    std::uint32_t first = 0;  ///< of a leaf its first triangle, else the first of two nodes that follow each other
    std::uint32_t count = 0;  ///< triangles of a leaf; 0: no leaf
  };

  explicit TriangleTree(const TriangleMesh& mesh);

  [[nodiscard]] const std::vector<Node>& nodes() const noexcept { return nodes_; }
  [[nodiscard]] const Box& bounds() const noexcept { return nodes_.front().box; }
  [[nodiscard]] const Convex& triangle(std::size_t i) const noexcept { return triangles_[i]; }
  [[nodiscard]] std::size_t size() const noexcept { return triangles_.size(); }
  /// A point on the surface.
  [[nodiscard]] const Vector3d& corner(std::size_t triangle = 0) const noexcept { return corners_[triangle][0]; }

  /// Whether the surface encloses a point, which is on the surface only by chance: by the parity of what a ray crosses,
  /// the majority of three rays that point nowhere in particular.
  [[nodiscard]] bool encloses(const Vector3d& point) const;

 private:
  void split(std::uint32_t node, std::uint32_t first, std::uint32_t last, std::vector<Vector3d>& middles);
  [[nodiscard]] bool odd_crossings(const Vector3d& point, const Vector3d& direction) const;

  std::vector<Node> nodes_;
  std::vector<std::array<Vector3d, 3>> corners_;
  std::vector<Convex> triangles_;
};

}  // namespace rmac::gateway
