#pragma once

#include <Eigen/Geometry>

#include "gateway/bodies/body.hpp"
#include "gateway/bodies/triangle_mesh.hpp"
#include "gateway/material/dexel_grid.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// A solid of a set-up as rays see it: its shape in closed form, or the surface of its mesh. Part frame, mm.
class Stock {
 public:
  /// Reads the file of a mesh. Errors name the body.
  [[nodiscard]] static Expected<Stock> read(const Body& body);

  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const noexcept { return bounds_; }
  /// Puts it on the empty rays of a grid.
  void fill(DexelGrid& grid) const;
  /// Of a mesh, in the part frame; none where the shape is not one.
  [[nodiscard]] const TriangleMesh& mesh() const noexcept { return mesh_; }

 private:
  SolidShape shape_;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  TriangleMesh mesh_;
  Eigen::AlignedBox3d bounds_;
};

}  // namespace rmac::gateway
