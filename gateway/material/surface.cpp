#include "gateway/material/surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "gateway/files/whole_file.hpp"
#include "gateway/material/marching_cubes.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Vector3f;

/// Points of the lattice, every n-th along each axis, and one more on each side that is outside.
class Points {
 public:
  using Place = std::array<std::size_t, 3>;

  Points(const DexelGrid& grid, std::uint32_t each_nth) : grid_(grid), layout_(grid.layout()), nth_(each_nth) {
    for (std::size_t a = 0; a < 3; ++a) count_[a] = (layout_.count[a] + nth_ - 1) / nth_ + 2;
  }
  [[nodiscard]] std::size_t count(std::size_t axis) const { return count_[axis]; }

  /// By the rays along z: the others agree but for rounding.
  void inside(std::size_t layer, std::vector<char>& in) const {
    in.assign(count_[0] * count_[1], 0);
    if (beyond(2, layer)) return;
    for (std::size_t j = 1; j + 1 < count_[1]; ++j) {
      for (std::size_t i = 1; i + 1 < count_[0]; ++i) {
        const auto z = static_cast<float>(at(2, layer) - layout_.low[2]);
        in[j * count_[0] + i] = grid_.holds(2, ray(2, {i, j, layer}), z) ? 1 : 0;
      }
    }
  }

  /// Where the surface passes between a point and the next one along an axis, of which one is inside: where the ray
  /// begins or ends there. Where rounding has it do so beyond one of the two, which other rays have on their other
  /// side, it is that point; half-way, where the ray sees no such place near them.
  [[nodiscard]] Vector3f crossing(const Place& place, std::size_t axis, bool leaves) const {
    const double low = at(axis, place[axis]), high = at(axis, place[axis] + 1);
    double found = (low + high) / 2;
    Place on_ray = place;
    if (beyond(axis, place[axis])) ++on_ray[axis];
    const auto from = static_cast<float>(low - layout_.low[axis]), to = static_cast<float>(high - layout_.low[axis]);
    float least = (to - from) / 2;
    grid_.pieces(axis, ray(axis, on_ray), [&](const DexelGrid::Piece& piece) {
      const float end = leaves ? piece.to : piece.from;
      const float between = std::clamp(end, from, to), away = std::abs(end - between);
      if (away > least) return;
      least = away;
      found = layout_.low[axis] + double{between};
    });
    Vector3f point;
    for (std::size_t a = 0; a < 3; ++a) {
      point[static_cast<Eigen::Index>(a)] = static_cast<float>(a == axis ? found : at(a, place[a]));
    }
    return point;
  }

 private:
  [[nodiscard]] bool beyond(std::size_t axis, std::size_t i) const { return i == 0 || i + 1 == count_[axis]; }
  [[nodiscard]] std::size_t cell(std::size_t i) const { return (i - 1) * nth_; }
  [[nodiscard]] double at(std::size_t axis, std::size_t i) const {
    if (i == 0) return layout_.low[axis] - layout_.pitch[axis];
    if (i + 1 == count_[axis]) return layout_.line(axis, layout_.count[axis]);
    return layout_.line(axis, cell(i));
  }
  [[nodiscard]] std::size_t ray(std::size_t axis, const Place& place) const {
    return grid_.ray(axis, cell(place[DexelLayout::across(axis, 0)]), cell(place[DexelLayout::across(axis, 1)]));
  }

  const DexelGrid& grid_;
  const DexelLayout& layout_;
  std::uint32_t nth_;
  Place count_{};
};

constexpr std::size_t kHead = 80, kTriangle = 50;

}  // namespace

void surface(const DexelGrid& grid, std::uint32_t each_nth, const std::function<void(const SurfaceTriangle&)>& visit) {
  static const MarchingCubes kCubes;
  const Points points(grid, each_nth);
  const std::size_t columns = points.count(0);
  std::vector<char> low, high;
  points.inside(0, low);
  for (std::size_t k = 0; k + 1 < points.count(2); ++k, std::swap(low, high)) {
    points.inside(k + 1, high);
    for (std::size_t j = 0; j + 1 < points.count(1); ++j) {
      for (std::size_t i = 0; i + 1 < columns; ++i) {
        std::size_t inside = 0;
        for (std::size_t c = 0; c < 8; ++c) {
          const std::vector<char>& layer = (c >> 2) != 0 ? high : low;
          if (layer[(j + (c >> 1 & 1)) * columns + i + (c & 1)] != 0) inside |= std::size_t{1} << c;
        }
        for (const MarchingCubes::Triangle& edges : kCubes.triangles(inside)) {
          SurfaceTriangle triangle;
          for (std::size_t n = 0; n < 3; ++n) {
            const std::size_t begin = MarchingCubes::begin_of(edges[n]);
            triangle[n] = points.crossing({i + (begin & 1), j + (begin >> 1 & 1), k + (begin >> 2)}, edges[n] / 4U,
                                          (inside >> begin & 1) != 0);
          }
          visit(triangle);
        }
      }
    }
  }
}

Fineness finest(const DexelGrid& grid, std::size_t most_triangles) {
  for (std::uint32_t nth = 1;;) {
    std::size_t triangles = 0;
    surface(grid, nth, [&](const SurfaceTriangle&) { ++triangles; });
    if (triangles <= most_triangles) return {nth, triangles};
    // There are as many fewer as the square of how much coarser it is.
    const double too_many = static_cast<double>(triangles) / static_cast<double>(most_triangles);
    nth = std::max(nth + 1, static_cast<std::uint32_t>(nth * std::sqrt(too_many)));
  }
}

Expected<SurfaceFile> write_stl(const DexelGrid& grid, const std::filesystem::path& file, std::size_t most_triangles) {
  SurfaceFile written;
  const auto [nth, triangles] = finest(grid, most_triangles);
  written.triangles = triangles;
  written.apart_mm = *std::ranges::max_element(grid.layout().pitch) * nth;
  WholeFile out(file);
  std::array<char, kHead> head{};
  std::strncpy(head.data(), "what is left of the stock, mm", head.size() - 1);
  out.write({head.data(), head.size()});
  const auto count = static_cast<std::uint32_t>(written.triangles);
  std::array<char, kTriangle> record{};
  std::memcpy(record.data(), &count, sizeof count);
  out.write({record.data(), sizeof count});
  surface(grid, nth, [&](const SurfaceTriangle& triangle) {
    const Vector3f normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
    std::array<float, 12> numbers{};
    for (std::size_t n = 0; n < 12; ++n) {
      const Vector3f& from = n < 3 ? normal : triangle[n / 3 - 1];
      numbers[n] = from[static_cast<Eigen::Index>(n % 3)];
    }
    std::memcpy(record.data(), numbers.data(), sizeof numbers);
    record[kTriangle - 2] = record[kTriangle - 1] = 0;
    out.write({record.data(), record.size()});
  });
  return out.finish().map([&] { return written; });
}

}  // namespace rmac::gateway
