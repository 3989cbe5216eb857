#include "gateway/bodies/triangle_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace rmac::gateway {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const noexcept {
    std::uint64_t hash = 0;
    for (const std::int64_t c : cell)
      hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15u, hash ^= hash >> 29;
    return hash;
  }
};

/// Number of a point for whatever lies closer to it than the cells are wide.
class Points {
 public:
  explicit Points(double apart_mm) : apart_mm_(apart_mm) {}

  std::uint32_t number_of(const Vector& point, std::vector<Vector>& points) {
    Cell cell;
    for (std::size_t c = 0; c < 3; ++c) cell[c] = static_cast<std::int64_t>(std::floor(point[c] / apart_mm_));
    if (const auto here = near(cell, point, points); here != kNone) return here;
    for (int n = 0; n < 27; ++n) {
      const Cell beside{cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1};
      if (const auto there = near(beside, point, points); there != kNone) return there;
    }
    points.push_back(point);
    return cells_.emplace(cell, static_cast<std::uint32_t>(points.size() - 1))->second;
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  [[nodiscard]] std::uint32_t near(const Cell& cell, const Vector& point, const std::vector<Vector>& points) const {
    const auto [first, last] = cells_.equal_range(cell);
    for (auto it = first; it != last; ++it) {
      const Vector& other = points[it->second];
      if (std::hypot(other[0] - point[0], other[1] - point[1], other[2] - point[2]) < apart_mm_) return it->second;
    }
    return kNone;
  }

  double apart_mm_;
  std::unordered_multimap<Cell, std::uint32_t, CellHash> cells_;
};

std::string shown(const Vector& point) {
  return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", point[0], point[1], point[2]);
}

}  // namespace

TriangleMesh welded(const TriangleMesh& mesh, double apart_mm) {
  TriangleMesh result;
  Points numbers(apart_mm);
  std::vector<std::uint32_t> number;
  number.reserve(mesh.points.size());
  for (const Vector& point : mesh.points) number.push_back(numbers.number_of(point, result.points));
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<std::uint32_t, 3> triangle{number[a], number[b], number[c]};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    result.triangles.push_back(triangle);
  }
  return result;
}

double volume_mm3(const TriangleMesh& mesh) {
  double six_times = 0;
  const Vector& o = mesh.points.front();  // near: far from the origin the terms would cancel
  const auto from = [&](std::uint32_t i) {
    const Vector& p = mesh.points[i];
    return Vector{p[0] - o[0], p[1] - o[1], p[2] - o[2]};
  };
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vector a = from(i), b = from(j), c = from(k);
    six_times +=
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six_times / 6;
}

std::string fault_of(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return "has no triangles";
  std::unordered_map<std::uint64_t, int> sense;  // of an edge: how often it is run up, less how often down
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint64_t from = triangle[e], to = triangle[(e + 1) % 3];
      sense[std::min(from, to) << 32 | std::max(from, to)] += from < to ? 1 : -1;
    }
  }
  std::size_t open = 0, turned = 0;
  Vector where{};
  for (const auto& [edge, sum] : sense) {
    if (sum == 0) continue;
    ++(sum % 2 != 0 ? open : turned);
    where = mesh.points[edge >> 32];
  }
  if (open > 0) {
    return fmt::format(
        "is open: {} edges have a triangle on one side only, one of them at {} mm; close it where it is "
        "drawn, and export it again",
        open, shown(where));
  }
  if (turned > 0) {
    return fmt::format(
        "has triangles that are wound in opposite senses, at {} mm among others; make its normals point "
        "outwards, and export it again",
        shown(where));
  }
  const double volume = volume_mm3(mesh);
  constexpr double kNothing_mm3 = 1e-9;
  if (std::abs(volume) < kNothing_mm3) return "has no volume: it is flat";
  if (volume < 0) return "is inside out: its normals point inwards; flip them where it is drawn, and export it again";
  return {};
}

}  // namespace rmac::gateway
