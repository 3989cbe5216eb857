#include "gateway/material/removal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rmac::gateway {
namespace {

/// Rays, or tiles, from `first` on and below `end`.
struct Range {
  std::uint32_t first = 0, end = 0;
};

/// The lines along an axis that cross it between two places.
Range lines_between(const DexelLayout& layout, std::size_t axis, double low, double high) {
  const double pitch = layout.pitch[axis], n = layout.count[axis];
  const double first = std::ceil((low - layout.low[axis]) / pitch - 0.5);
  const double end = std::floor((high - layout.low[axis]) / pitch - 0.5) + 1;
  return {static_cast<std::uint32_t>(std::clamp(first, 0.0, n)), static_cast<std::uint32_t>(std::clamp(end, 0.0, n))};
}

/// One family of rays and one sweep.
template <class Swept>
class Pass {
 public:
  Pass(DexelGrid& grid, const Swept& swept, std::size_t axis, Cut what)
      : grid_(grid),
        layout_(grid.layout()),
        axis_(axis),
        u_(DexelLayout::across(axis, 0)),
        v_(DexelLayout::across(axis, 1)),
        what_(what),
        lines_(swept.along(axis)),
        wide_(swept.wider(std::hypot(layout_.pitch[u_], layout_.pitch[v_]) * (DexelGrid::kTile - 1) / 2).along(axis)) {
    const Eigen::AlignedBox3d box = swept.bounds();
    const auto index = [](std::size_t a) { return static_cast<Eigen::Index>(a); };
    columns_ = lines_between(layout_, u_, box.min()[index(u_)], box.max()[index(u_)]);
    rows_ = lines_between(layout_, v_, box.min()[index(v_)], box.max()[index(v_)]);
    low_ = box.min()[index(axis)] - layout_.low[axis], high_ = box.max()[index(axis)] - layout_.low[axis];
  }

  void run() {
    constexpr std::uint32_t kTile = DexelGrid::kTile;
    if (columns_.first >= columns_.end || rows_.first >= rows_.end) return;
    for (std::uint32_t j = rows_.first / kTile; j <= (rows_.end - 1) / kTile; ++j) {
      for (std::uint32_t i = columns_.first / kTile; i <= (columns_.end - 1) / kTile; ++i) {
        if (may_meet(i, j)) tile(i, j);
      }
    }
  }

  double removed_mm = 0;  ///< of all rays
  double longest_mm = 0;
  Eigen::Vector3d place{0, 0, 0};

 private:
  [[nodiscard]] bool may_meet(std::uint32_t i, std::uint32_t j) const {
    const DexelGrid::Piece& there = grid_.tile(axis_, i, j);
    if (there.from > there.to || high_ <= double{there.from} || low_ >= double{there.to}) return false;
    constexpr double kMiddle = (DexelGrid::kTile - 1) / 2.0;
    const double u = layout_.line(u_, i * DexelGrid::kTile) + kMiddle * layout_.pitch[u_];
    const double v = layout_.line(v_, j * DexelGrid::kTile) + kMiddle * layout_.pitch[v_];
    double from = 0, to = 0;
    if (!wide_(u, v, from, to)) return false;
    return from - layout_.low[axis_] < double{there.to} && to - layout_.low[axis_] > double{there.from};
  }

  void tile(std::uint32_t i, std::uint32_t j) {
    constexpr std::uint32_t kTile = DexelGrid::kTile;
    const std::uint32_t column_end = std::min(columns_.end, (i + 1) * kTile);
    const std::uint32_t row_end = std::min(rows_.end, (j + 1) * kTile);
    double removed = 0;
    for (std::uint32_t row = std::max(rows_.first, j * kTile); row < row_end; ++row) {
      const double v = layout_.line(v_, row);
      for (std::uint32_t column = std::max(columns_.first, i * kTile); column < column_end; ++column) {
        const std::size_t ray = grid_.ray(axis_, column, row);
        if (!grid_.reaches(axis_, ray, low_, high_)) continue;
        double from = 0, to = 0;
        if (!lines_(layout_.line(u_, column), v, from, to)) continue;
        removed += at_ray(ray, from, to, column, row);
      }
    }
    if (removed > 0 && what_ == Cut::Remove) grid_.tighten(axis_, i, j);
    removed_mm += removed;
  }

  double at_ray(std::size_t ray, double from, double to, std::uint32_t column, std::uint32_t row) {
    const auto a = static_cast<float>(from - layout_.low[axis_]), b = static_cast<float>(to - layout_.low[axis_]);
    const DexelGrid::Piece first = grid_.first(axis_, ray);
    const float met = what_ == Cut::Remove ? grid_.remove(axis_, ray, a, b) : grid_.between(axis_, ray, a, b);
    if (double{met} > longest_mm) {
      longest_mm = double{met};
      const bool there = first.from < b && first.to > a;
      const float middle = there ? (std::max(a, first.from) + std::min(b, first.to)) / 2 : (a + b) / 2;
      place[static_cast<Eigen::Index>(axis_)] = layout_.low[axis_] + double{middle};
      place[static_cast<Eigen::Index>(u_)] = layout_.line(u_, column);
      place[static_cast<Eigen::Index>(v_)] = layout_.line(v_, row);
    }
    return double{met};
  }

  DexelGrid& grid_;
  const DexelLayout& layout_;
  std::size_t axis_, u_, v_;
  Cut what_;
  typename Swept::Lines lines_, wide_;
  Range columns_, rows_;
  double low_ = 0, high_ = 0;  ///< of the sweep, from the lattice's corner
};

template <class Swept>
Removal cut_with(DexelGrid& grid, const Swept& swept, Cut what) {
  Removal total;
  total.depth_mm = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Pass<Swept> pass(grid, swept, axis, what);
    pass.run();
    total.volume_mm3 += pass.removed_mm * grid.layout().cell_area(axis) / 3;
    if (pass.longest_mm < total.depth_mm) total.depth_mm = pass.longest_mm, total.place = pass.place;
  }
  return total;
}

}  // namespace

Removal cut(DexelGrid& grid, const Sweep& sweep, Cut what) {
  return std::visit([&](const auto& swept) { return cut_with(grid, swept, what); }, sweep);
}

}  // namespace rmac::gateway
