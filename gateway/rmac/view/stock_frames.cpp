#include "gateway/rmac/view/stock_frames.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "gateway/material/surface.hpp"
#include "gateway/rmac/view/drawn_bodies.hpp"
#include "gateway/rmac/view/rounded.hpp"

namespace rmac::cli {
namespace {

gateway::TriangleMesh mesh_of(const gateway::DexelGrid& grid, std::uint32_t each_nth) {
  gateway::TriangleMesh mesh;
  gateway::surface(grid, each_nth, [&mesh](const gateway::SurfaceTriangle& triangle) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    for (const auto& p : triangle) mesh.points.push_back({double{p[0]}, double{p[1]}, double{p[2]}});
    mesh.triangles.push_back({first, first + 1, first + 2});
  });
  constexpr double kOnePoint_mm = 1e-4;
  return gateway::welded(mesh, kOnePoint_mm);
}

double apart_mm(const gateway::DexelGrid& grid, std::uint32_t each_nth) {
  return *std::ranges::max_element(grid.layout().pitch) * each_nth;
}

/// As a box of the size of the stock would need it: marching cubes make two triangles a cell.
std::uint32_t first_guess(const gateway::DexelGrid& grid) {
  const auto& count = grid.layout().count;
  const double x = count[0], y = count[1], z = count[2];
  const double triangles = 4 * (x * y + y * z + z * x);
  return static_cast<std::uint32_t>(std::ceil(std::sqrt(std::max(triangles / StockFrames::kMostTriangles, 1.0))));
}

}  // namespace

void StockFrames::look(double t_s, const gateway::Material& material) {
  if (!frames_.empty() && t_s < frames_.back().t_s + every_s_) return;
  if (const double removed = material.removed().mm3; std::exchange(removed_mm3_, removed) == removed) return;
  const gateway::DexelGrid& grid = material.grid();
  if (nth_ == 0) nth_ = first_guess(grid);
  constexpr double kCoarser = 1.3;
  gateway::TriangleMesh mesh = mesh_of(grid, nth_);
  while (mesh.triangles.size() > kMostTriangles) {
    nth_ = static_cast<std::uint32_t>(std::ceil(nth_ * kCoarser));
    mesh = mesh_of(grid, nth_);
  }
  frames_.push_back({t_s, apart_mm(grid, nth_), std::move(mesh)});
  if (frames_.size() <= kMost) return;
  every_s_ *= 2;
  std::vector<Frame> fewer;
  for (std::size_t i = 0; i < frames_.size(); i += 2) fewer.push_back(std::move(frames_[i]));
  frames_ = std::move(fewer);
}

nlohmann::json StockFrames::to_json() const {
  nlohmann::json list = nlohmann::json::array();
  for (const Frame& frame : frames_) {
    list.push_back(drawn_mesh(frame.mesh));
    list.back()["t"] = rounded(frame.t_s, kTimeDigits);
    list.back()["apart_mm"] = frame.apart_mm;
  }
  return list;
}

nlohmann::json drawn_stock(const gateway::DexelGrid& grid, std::size_t most_triangles) {
  const std::uint32_t nth = gateway::finest(grid, most_triangles).each_nth;
  nlohmann::json drawn = drawn_mesh(mesh_of(grid, nth));
  drawn["apart_mm"] = apart_mm(grid, nth);
  return drawn;
}

}  // namespace rmac::cli
