#include "gateway/material/marching_cubes.hpp"

namespace rmac::gateway {
namespace {

constexpr std::uint8_t kNoEdge = 255;

std::uint8_t edge_between(std::size_t a, std::size_t b) {
  for (std::uint8_t edge = 0; edge < 12; ++edge) {
    const std::size_t from = MarchingCubes::begin_of(edge), to = from | std::size_t{1} << (edge / 4);
    if ((from == a && to == b) || (from == b && to == a)) return edge;
  }
  return kNoEdge;
}

/// The corners of a face, counter-clockwise from outside of the cube.
std::array<std::size_t, 4> face(std::size_t axis, bool high) {
  const std::size_t u = std::size_t{1} << ((axis + 1) % 3), v = std::size_t{1} << ((axis + 2) % 3);
  const std::size_t base = high ? std::size_t{1} << axis : 0;
  if (high) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

/// For each edge on which the surface comes into a face, the one on which it leaves it.
std::array<std::uint8_t, 12> ways(std::size_t inside) {
  std::array<std::uint8_t, 12> next;
  next.fill(kNoEdge);
  for (std::size_t f = 0; f < 6; ++f) {
    const auto corners = face(f / 2, f % 2 == 1);
    const auto in = [&](std::size_t i) { return (inside >> corners[i % 4] & 1) != 0; };
    // Each run of corners inside is cut off by itself, in the sense that has the solid below the surface.
    for (std::size_t i = 0; i < 4; ++i) {
      if (in(i) || !in(i + 1)) continue;
      std::size_t end = i + 1;
      while (in(end + 1)) ++end;
      next[edge_between(corners[i], corners[(i + 1) % 4])] = edge_between(corners[end % 4], corners[(end + 1) % 4]);
    }
  }
  return next;
}

}  // namespace

MarchingCubes::MarchingCubes() {
  for (std::size_t inside = 0; inside < cases_.size(); ++inside) {
    auto next = ways(inside);
    for (std::uint8_t first = 0; first < 12; ++first) {
      // A loop, as a fan from its first edge.
      std::vector<std::uint8_t> loop;
      for (std::uint8_t at = first; next[at] != kNoEdge;) {
        loop.push_back(at);
        const std::uint8_t following = next[at];
        next[at] = kNoEdge;
        at = following;
      }
      for (std::size_t i = 1; i + 1 < loop.size(); ++i) cases_[inside].push_back({loop[0], loop[i], loop[i + 1]});
    }
  }
}

}  // namespace rmac::gateway
