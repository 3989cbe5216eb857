#include "gateway/material/mesh_rays.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace rmac::gateway {
namespace {

using Whole = std::int64_t;

/// A point across a family's rays, in whole steps so fine that products of two still fit into 64 bits.
struct Spot {
  Whole u = 0, v = 0;
};

/// What it takes to say on which side of an edge a ray is: positive on its left. Rays lie an infinitely small step to
/// the right of where they are, and a smaller one upwards, so that none is on an edge.
bool left_of(const Spot& from, const Spot& to, const Spot& ray) {
  const Whole side = (to.u - from.u) * (ray.v - from.v) - (to.v - from.v) * (ray.u - from.u);
  if (side != 0) return side > 0;
  if (from.v != to.v) return to.v < from.v;
  return to.u > from.u;
}

/// One family's view of a mesh.
class MeshFamily {
 public:
  MeshFamily(const TriangleMesh& mesh, const DexelLayout& layout, std::size_t axis)
      : mesh_(mesh), layout_(layout), axis_(axis), u_(DexelLayout::across(axis, 0)), v_(DexelLayout::across(axis, 1)) {
    double farthest = 0;
    for (const Vector& point : mesh.points) {
      for (const std::size_t a : {u_, v_}) farthest = std::max(farthest, std::abs(point[a] - layout.low[a]));
    }
    for (const std::size_t a : {u_, v_}) farthest = std::max(farthest, layout.pitch[a] * (layout.count[a] + 1));
    constexpr double kSteps = 1 << 29;
    per_mm_ = kSteps / farthest;
    spots_.reserve(mesh.points.size());
    for (const Vector& point : mesh.points) spots_.push_back(spot(point[u_], point[v_]));
  }

  void cross(std::uint32_t triangle, const Rows& rows, std::vector<Crossing>& found) const {
    const auto& corners = mesh_.triangles[triangle];
    std::array<Spot, 3> at;
    for (std::size_t c = 0; c < 3; ++c) at[c] = spots_[corners[c]];
    const Whole area = (at[1].u - at[0].u) * (at[2].v - at[0].v) - (at[1].v - at[0].v) * (at[2].u - at[0].u);
    if (area == 0) return;  // seen from its edge
    const auto [low_u, high_u] = std::minmax({at[0].u, at[1].u, at[2].u});
    const auto [low_v, high_v] = std::minmax({at[0].v, at[1].v, at[2].v});
    for (std::uint32_t j = std::max(rows.first, first_line(v_, low_v)); j < rows.end; ++j) {
      const Spot row = spot(layout_.line(u_, 0), layout_.line(v_, j));
      if (row.v > high_v) break;
      for (std::uint32_t i = first_line(u_, low_u); i < layout_.count[u_]; ++i) {
        const Spot ray = spot(layout_.line(u_, i), layout_.line(v_, j));
        if (ray.u > high_u) break;
        const bool left = area > 0;
        if (left_of(at[0], at[1], ray) != left || left_of(at[1], at[2], ray) != left ||
            left_of(at[2], at[0], ray) != left) {
          continue;
        }
        found.push_back({j * layout_.count[u_] + i, height(corners, i, j), triangle, area < 0});
      }
    }
  }

 private:
  [[nodiscard]] Spot spot(double u, double v) const {
    return {std::llround((u - layout_.low[u_]) * per_mm_), std::llround((v - layout_.low[v_]) * per_mm_)};
  }
  [[nodiscard]] std::uint32_t first_line(std::size_t a, Whole from) const {
    const double i = std::floor(static_cast<double>(from) / per_mm_ / layout_.pitch[a] - 0.5) - 1;
    return static_cast<std::uint32_t>(std::clamp(i, 0.0, static_cast<double>(layout_.count[a])));
  }
  /// Where the ray meets the triangle's plane, within the triangle.
  [[nodiscard]] float height(const std::array<std::uint32_t, 3>& corners, std::uint32_t i, std::uint32_t j) const {
    const Vector &a = mesh_.points[corners[0]], &b = mesh_.points[corners[1]], &c = mesh_.points[corners[2]];
    const double u = layout_.line(u_, i) - a[u_], v = layout_.line(v_, j) - a[v_];
    const double bu = b[u_] - a[u_], bv = b[v_] - a[v_], cu = c[u_] - a[u_], cv = c[v_] - a[v_];
    const double area = bu * cv - bv * cu, bh = b[axis_] - a[axis_], ch = c[axis_] - a[axis_];
    const double height = area != 0 ? ((u * cv - v * cu) * bh + (bu * v - bv * u) * ch) / area : 0;
    const auto [low, high] = std::minmax({0.0, bh, ch});
    return static_cast<float>(a[axis_] + std::clamp(height, low, high) - layout_.low[axis_]);
  }

  const TriangleMesh& mesh_;
  const DexelLayout& layout_;
  std::size_t axis_, u_, v_;
  double per_mm_ = 1;
  std::vector<Spot> spots_;
};

}  // namespace

std::vector<Crossing> crossings(const TriangleMesh& mesh, const DexelLayout& layout, std::size_t axis,
                                const Rows& rows) {
  std::vector<Crossing> found;
  const MeshFamily family(mesh, layout, axis);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) family.cross(t, rows, found);
  // Where two are at one place the ray leaves before it enters: what touches is two pieces or one, and never less.
  std::ranges::sort(found, [](const Crossing& a, const Crossing& b) {
    return std::tie(a.ray, a.at, a.enters) < std::tie(b.ray, b.at, b.enters);
  });
  return found;
}

void ray_by_ray(const TriangleMesh& mesh, const DexelLayout& layout, std::size_t axis,
                const std::function<void(std::span<const Crossing>)>& visit) {
  constexpr std::uint32_t kRaysAtATime = 2'000'000;
  const std::uint32_t columns = layout.count[DexelLayout::across(axis, 0)];
  const std::uint32_t rows = layout.count[DexelLayout::across(axis, 1)];
  const std::uint32_t band = std::max(1U, kRaysAtATime / columns);
  for (std::uint32_t first = 0; first < rows; first += band) {
    const std::vector<Crossing> all = crossings(mesh, layout, axis, {first, std::min(rows, first + band)});
    for (std::size_t i = 0; i < all.size();) {
      std::size_t end = i + 1;
      while (end < all.size() && all[end].ray == all[i].ray) ++end;
      visit(std::span(all).subspan(i, end - i));
      i = end;
    }
  }
}

std::vector<std::pair<std::size_t, std::size_t>> inside(std::span<const Crossing> of_one_ray) {
  std::vector<std::pair<std::size_t, std::size_t>> pieces;
  int around = 0;
  std::size_t since = 0;
  for (std::size_t i = 0; i < of_one_ray.size(); ++i) {
    const int before = around;
    around += of_one_ray[i].enters ? 1 : -1;
    if (before == 0 && around == 1) since = i;
    if (before == 1 && around == 0 && of_one_ray[since].at < of_one_ray[i].at) pieces.emplace_back(since, i);
  }
  return pieces;
}

}  // namespace rmac::gateway
