#include "gateway/material/deviation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "gateway/material/mesh_rays.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> normals_of(const TriangleMesh& mesh) {
  std::vector<Vector3d> normals;
  normals.reserve(mesh.triangles.size());
  const auto at = [&](std::uint32_t i) { return Vector3d(mesh.points[i][0], mesh.points[i][1], mesh.points[i][2]); };
  for (const auto& [a, b, c] : mesh.triangles) {
    normals.push_back((at(b) - at(a)).cross(at(c) - at(a)).normalized());
  }
  return normals;
}

/// From the part's surface outwards along a ray to where material ends; below 0: from there to the surface. `inner` is
/// where the ray comes into the part, or leaves it, on its other side: if nothing is left, all up to there is gone.
double along_ray(const DexelGrid& left, std::size_t axis, std::size_t ray, float surface, float inner) {
  const bool upwards = inner < surface;
  double found = -std::abs(double{surface} - double{inner});
  left.pieces(axis, ray, [&](const DexelGrid::Piece& piece) {
    const double end = double{upwards ? piece.to : piece.from}, begin = double{upwards ? piece.from : piece.to};
    const double past = upwards ? end - double{surface} : double{surface} - end;
    const bool reaches_below = upwards ? begin <= double{surface} : begin >= double{surface};
    if (!reaches_below) return;
    // The piece that holds the surface, or else the nearest one below it.
    found = found >= 0 && past >= 0 ? std::min(found, past) : std::max(found, past);
  });
  return found;
}

/// From a place to where material begins or ends on the ray of a family that passes it the nearest; what has no limit
/// where that ray does not see there what it should.
double along_other_ray(const DexelGrid& left, std::size_t axis, const Vector3d& place, bool in_material) {
  const DexelLayout& layout = left.layout();
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  std::array<std::size_t, 2> line{};
  for (std::size_t n = 0; n < 2; ++n) {
    const std::size_t a = DexelLayout::across(axis, n);
    const double cell = std::floor((place[static_cast<Eigen::Index>(a)] - layout.low[a]) / layout.pitch[a]);
    line[n] = static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(layout.count[a] - 1)));
  }
  const std::size_t ray = left.ray(axis, line[0], line[1]);
  const double at = place[static_cast<Eigen::Index>(axis)] - layout.low[axis];
  if (left.holds(axis, ray, static_cast<float>(at)) != in_material) return kNoLimit;
  double nearest = kNoLimit;
  left.pieces(axis, ray, [&](const DexelGrid::Piece& piece) {
    nearest = std::min({nearest, std::abs(double{piece.from} - at), std::abs(double{piece.to} - at)});
  });
  return nearest;
}

}  // namespace

Deviation deviation_of(const DexelGrid& left, const TriangleMesh& part, double tolerance_mm) {
  Deviation found;
  const DexelLayout& layout = left.layout();
  const std::vector<Vector3d> normals = normals_of(part);
  double within_mm2 = 0;
  const auto take = [&](std::size_t axis, const Crossing& here, const Crossing& other) {
    const Vector3d& normal = normals[here.triangle];
    Eigen::Index steepest = 0;
    const double cosine = normal.cwiseAbs().maxCoeff(&steepest);
    if (steepest != static_cast<Eigen::Index>(axis)) return;
    const std::size_t u = DexelLayout::across(axis, 0), v = DexelLayout::across(axis, 1);
    Vector3d place;
    place[static_cast<Eigen::Index>(axis)] = layout.low[axis] + double{here.at};
    place[static_cast<Eigen::Index>(u)] = layout.line(u, here.ray % layout.count[u]);
    place[static_cast<Eigen::Index>(v)] = layout.line(v, here.ray / layout.count[u]);
    double off = cosine * along_ray(left, axis, here.ray, here.at, other.at);
    if (std::abs(off) > tolerance_mm) {
      const double nearer =
          std::min(along_other_ray(left, u, place, off > 0), along_other_ray(left, v, place, off > 0));
      off = std::clamp(off, -nearer, nearer);
    }
    const double area = layout.cell_area(axis) / cosine;
    found.surface_mm2 += area;
    if (std::abs(off) <= tolerance_mm) within_mm2 += area;
    double& most = off > 0 ? found.rest_mm : found.gouge_mm;
    if (std::abs(off) <= most) return;
    most = std::abs(off);
    (off > 0 ? found.rest_at : found.gouge_at) = place;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ray_by_ray(part, layout, axis, [&](std::span<const Crossing> of_ray) {
      for (const auto& [in, out] : inside(of_ray)) {
        take(axis, of_ray[in], of_ray[out]);
        take(axis, of_ray[out], of_ray[in]);
      }
    });
  }
  if (found.surface_mm2 > 0) found.within_share = within_mm2 / found.surface_mm2;
  return found;
}

}  // namespace rmac::gateway
