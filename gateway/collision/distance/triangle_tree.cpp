#include "gateway/collision/distance/triangle_tree.hpp"

#include <algorithm>
#include <numeric>

namespace rmac::gateway {

using Eigen::Vector3d;
namespace {

constexpr std::uint32_t kLeaf = 4;  ///< triangles

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  std::vector<Vector3d> middles;
  for (const auto& triangle : mesh.triangles) {
    std::array<Vector3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector& p = mesh.points[triangle[i]];
      corners[i] = {p[0], p[1], p[2]};
    }
    middles.emplace_back((corners[0] + corners[1] + corners[2]) / 3);
    corners_.push_back(corners);
  }
  nodes_.reserve(corners_.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(corners_.size()), middles);
  for (const auto& [a, b, c] : corners_) triangles_.push_back(Convex::triangle(a, b, c));
}

/// At the median of the middles along the longest side, so that the tree is balanced whatever the mesh.
void TriangleTree::split(std::uint32_t node, std::uint32_t first, std::uint32_t last, std::vector<Vector3d>& middles) {
  Box box, spread;
  for (std::uint32_t i = first; i < last; ++i) {
    for (const Vector3d& corner : corners_[i]) box.extend(corner);
    spread.extend(middles[i]);
  }
  nodes_[node].box = box;
  if (last - first <= kLeaf) {
    nodes_[node].first = first;
    nodes_[node].count = last - first;
    return;
  }
  Eigen::Index axis = 0;
  spread.sizes().maxCoeff(&axis);
  const std::uint32_t half = first + (last - first) / 2;
  std::vector<std::uint32_t> order(last - first);
  std::iota(order.begin(), order.end(), first);
  std::nth_element(order.begin(), order.begin() + (half - first), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return middles[a][axis] < middles[b][axis]; });
  std::vector<std::array<Vector3d, 3>> corners;
  std::vector<Vector3d> ordered;
  for (const std::uint32_t i : order) corners.push_back(corners_[i]), ordered.push_back(middles[i]);
  std::copy(corners.begin(), corners.end(), corners_.begin() + first);
  std::copy(ordered.begin(), ordered.end(), middles.begin() + first);
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = children;
  split(children, first, half, middles);
  split(children + 1, half, last, middles);
}

bool TriangleTree::encloses(const Vector3d& point) const {
  if (!bounds().contains(point)) return false;
  int votes = 0;
  for (const Vector3d& direction :
       {Vector3d(0.3713, 0.2617, 0.8909), Vector3d(-0.6151, 0.7121, -0.3386), Vector3d(0.1337, -0.9211, 0.3657)}) {
    if (odd_crossings(point, direction)) ++votes;
  }
  return votes >= 2;
}

bool TriangleTree::odd_crossings(const Vector3d& point, const Vector3d& direction) const {
  bool odd = false;
  std::vector<std::uint32_t> open{0};
  const auto crosses_box = [&](const Box& box) {
    double from = 0, to = 1e300;
    for (int c = 0; c < 3; ++c) {
      const double a = (box.min()[c] - point[c]) / direction[c], b = (box.max()[c] - point[c]) / direction[c];
      from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
    }
    return from <= to + 1e-9;
  };
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    if (!crosses_box(node.box)) continue;
    if (node.count == 0) {
      open.push_back(node.first), open.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      // Möller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
      const auto& [a, b, c] = corners_[i];
      const Vector3d ab = b - a, ac = c - a, side = direction.cross(ac), from = point - a;
      const double volume = ab.dot(side);
      if (volume == 0) continue;
      const double u = from.dot(side) / volume, v = direction.dot(from.cross(ab)) / volume;
      if (u >= 0 && v >= 0 && u + v <= 1 && ac.dot(from.cross(ab)) / volume > 0) odd = !odd;
    }
  }
  return odd;
}

}  // namespace rmac::gateway
