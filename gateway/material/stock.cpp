#include "gateway/material/stock.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <variant>
#include <vector>

#include "gateway/bodies/isometry.hpp"
#include "gateway/bodies/meshes/mesh_file.hpp"
#include "gateway/material/mesh_rays.hpp"
#include "gateway/material/sweep/axis_frame.hpp"
#include "gateway/material/sweep/swept_ball.hpp"
#include "gateway/material/sweep/swept_cone.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A box that stands anywhere, as lines along an axis see it.
class BoxLines {
 public:
  BoxLines(const Isometry3d& pose, const Vector3d& half, std::size_t axis)
      : to_box_(pose.inverse()), half_(half), axis_(static_cast<Eigen::Index>(axis)) {}

  [[nodiscard]] bool operator()(double first, double second, double& from, double& to) const {
    Vector3d point = Vector3d::Zero();
    point[(axis_ + 1) % 3] = first, point[(axis_ + 2) % 3] = second;
    const Vector3d begin = to_box_ * point, line = to_box_.linear().col(axis_);
    constexpr double kFar = 1e9, kNone = 1e-12;
    from = -kFar, to = kFar;
    for (Eigen::Index a = 0; a < 3; ++a) {
      if (std::abs(line[a]) < kNone) {
        if (std::abs(begin[a]) > half_[a]) return false;
        continue;
      }
      const double one = (-half_[a] - begin[a]) / line[a], other = (half_[a] - begin[a]) / line[a];
      from = std::max(from, std::min(one, other)), to = std::min(to, std::max(one, other));
    }
    return from < to;
  }

 private:
  Isometry3d to_box_;
  Vector3d half_;
  Eigen::Index axis_;
};

template <class Lines>
void fill_family(DexelGrid& grid, std::size_t axis, const Lines& lines) {
  const DexelLayout& layout = grid.layout();
  const std::size_t u = DexelLayout::across(axis, 0), v = DexelLayout::across(axis, 1);
  for (std::uint32_t j = 0; j < layout.count[v]; ++j) {
    for (std::uint32_t i = 0; i < layout.count[u]; ++i) {
      double from = 0, to = 0;
      if (!lines(layout.line(u, i), layout.line(v, j), from, to)) continue;
      const DexelGrid::Piece piece{static_cast<float>(from - layout.low[axis]),
                                   static_cast<float>(to - layout.low[axis])};
      if (piece.from < piece.to) grid.put(axis, grid.ray(axis, i, j), std::array{piece});
    }
  }
}

void fill_family(DexelGrid& grid, std::size_t axis, const TriangleMesh& mesh) {
  std::vector<DexelGrid::Piece> pieces;
  ray_by_ray(mesh, grid.layout(), axis, [&](std::span<const Crossing> of_ray) {
    pieces.clear();
    for (const auto& [in, out] : inside(of_ray)) {
      // What touches is one piece.
      if (!pieces.empty() && pieces.back().to >= of_ray[in].at) {
        pieces.back().to = of_ray[out].at;
      } else {
        pieces.push_back({of_ray[in].at, of_ray[out].at});
      }
    }
    grid.put(axis, of_ray.front().ray, pieces);
  });
}

SweptCone standing(const ConeShape& cone, const Isometry3d& pose) {
  return {pose.translation(),
          Vector3d::Zero(),
          pose.linear().col(2).normalized(),
          {cone.bottom_radius, cone.top_radius, cone.height}};
}

}  // namespace

Expected<Stock> Stock::read(const Body& body) {
  Stock stock;
  stock.shape_ = body.shape;
  stock.pose_ = to_isometry(body.pose);
  if (const auto* file = std::get_if<MeshShape>(&body.shape)) {
    auto mesh = read_mesh_file(*file);
    if (!mesh) return failure(mesh.error().code, fmt::format("body \"{}\": {}", body.name, mesh.error().message));
    stock.mesh_ = std::move(*mesh);
    for (Vector& point : stock.mesh_.points) {
      const Vector3d there = stock.pose_ * Vector3d(point[0], point[1], point[2]);
      point = {there[0], there[1], there[2]};
      stock.bounds_.extend(there);
    }
  } else if (const auto* box = std::get_if<BoxShape>(&body.shape)) {
    const Vector3d half(box->size[0] / 2, box->size[1] / 2, box->size[2] / 2);
    stock.bounds_ = Eigen::AlignedBox3d(-half, half).transformed(stock.pose_);
  } else if (const auto* sphere = std::get_if<SphereShape>(&body.shape)) {
    stock.bounds_ = SweptBall(stock.pose_.translation(), Vector3d::Zero(), sphere->radius).bounds();
  } else {
    stock.bounds_ = standing(std::get<ConeShape>(body.shape), stock.pose_).bounds();
  }
  return stock;
}

void Stock::fill(DexelGrid& grid) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (const auto* box = std::get_if<BoxShape>(&shape_)) {
      fill_family(grid, axis, BoxLines(pose_, Vector3d(box->size[0], box->size[1], box->size[2]) / 2, axis));
    } else if (const auto* sphere = std::get_if<SphereShape>(&shape_)) {
      fill_family(grid, axis, SweptBall(pose_.translation(), Vector3d::Zero(), sphere->radius).along(axis));
    } else if (const auto* cone = std::get_if<ConeShape>(&shape_)) {
      fill_family(grid, axis, standing(*cone, pose_).along(axis));
    } else {
      fill_family(grid, axis, mesh_);
    }
  }
  grid.tighten();
}

}  // namespace rmac::gateway
