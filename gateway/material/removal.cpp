#include "gateway/material/removal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

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

/// One family of rays and some sweeps of one piece.
template <class Swept>
class Pass {
 public:
  Pass(DexelGrid& grid, std::span<const Sweep> sweeps, std::size_t axis, Cut what)
      : grid_(grid),
        layout_(grid.layout()),
        axis_(axis),
        u_(DexelLayout::across(axis, 0)),
        v_(DexelLayout::across(axis, 1)),
        what_(what) {
    sweeps_.reserve(sweeps.size());
    for (const Sweep& sweep : sweeps) add(std::get<Swept>(sweep));
  }

  void run() {
    constexpr std::uint32_t kTile = DexelGrid::kTile;
    for (std::uint32_t j = rows_.first / kTile; j * kTile < rows_.end; ++j) {
      for (std::uint32_t i = columns_.first / kTile; i * kTile < columns_.end; ++i) tile(i, j);
    }
  }

  double removed_mm = 0;  ///< of all rays
  double longest_mm = 0;
  Eigen::Vector3d place{0, 0, 0};

 private:
  struct One {
    typename Swept::Lines lines, wide;
    Range columns, rows;
    double low = 0, high = 0;  ///< from the lattice's corner
  };
  /// Where a sweep is on a tile's rays, at most.
  struct Meeting {
    const One* one = nullptr;
    double from = 0, to = 0;
  };

  void add(const Swept& swept) {
    const Eigen::AlignedBox3d box = swept.bounds();
    const auto index = [](std::size_t a) { return static_cast<Eigen::Index>(a); };
    const double aside = std::hypot(layout_.pitch[u_], layout_.pitch[v_]) * (DexelGrid::kTile - 1) / 2;
    One one{.lines = swept.along(axis_), .wide = swept.wider(aside).along(axis_), .columns = {}, .rows = {}};
    one.columns = lines_between(layout_, u_, box.min()[index(u_)], box.max()[index(u_)]);
    one.rows = lines_between(layout_, v_, box.min()[index(v_)], box.max()[index(v_)]);
    one.low = box.min()[index(axis_)] - layout_.low[axis_], one.high = box.max()[index(axis_)] - layout_.low[axis_];
    if (one.columns.first >= one.columns.end || one.rows.first >= one.rows.end) return;
    const bool first = sweeps_.empty();
    const auto join = [&](Range& all, const Range& more) {
      all = first ? more : Range{std::min(all.first, more.first), std::max(all.end, more.end)};
    };
    join(columns_, one.columns), join(rows_, one.rows);
    sweeps_.push_back(one);
  }

  void tile(std::uint32_t i, std::uint32_t j) {
    constexpr std::uint32_t kTile = DexelGrid::kTile;
    constexpr double kMiddle = (kTile - 1) / 2.0;
    const double u = layout_.line(u_, i * kTile) + kMiddle * layout_.pitch[u_];
    const double v = layout_.line(v_, j * kTile) + kMiddle * layout_.pitch[v_];
    const DexelGrid::Tile& there = grid_.tile(axis_, i, j);
    const auto beside = [](const Range& range, std::uint32_t first) {
      return range.end <= first || range.first >= first + kTile;
    };
    meetings_.clear();
    for (const One& one : sweeps_) {
      if (beside(one.columns, i * kTile) || beside(one.rows, j * kTile) || !there.may_have(one.low, one.high)) continue;
      Meeting met{&one};
      if (!one.wide(u, v, met.from, met.to)) continue;
      met.from -= layout_.low[axis_], met.to -= layout_.low[axis_];
      if (there.may_have(met.from, met.to)) meetings_.push_back(met);
    }
    if (meetings_.size() > 1) {
      std::ranges::sort(meetings_, [](const Meeting& a, const Meeting& b) { return a.to - a.from > b.to - b.from; });
    }
    for (const Meeting& met : meetings_) {
      if (!there.may_have(met.from, met.to)) continue;  // not any more
      rays_of_tile(*met.one, i, j);
      if (what_ == Cut::Remove) grid_.tighten(axis_, i, j, static_cast<float>((met.from + met.to) / 2));
    }
  }

  void rays_of_tile(const One& one, std::uint32_t i, std::uint32_t j) {
    constexpr std::uint32_t kTile = DexelGrid::kTile;
    const std::uint32_t column_end = std::min(one.columns.end, (i + 1) * kTile);
    const std::uint32_t row_end = std::min(one.rows.end, (j + 1) * kTile);
    for (std::uint32_t row = std::max(one.rows.first, j * kTile); row < row_end; ++row) {
      const double v = layout_.line(v_, row);
      for (std::uint32_t column = std::max(one.columns.first, i * kTile); column < column_end; ++column) {
        const std::size_t ray = grid_.ray(axis_, column, row);
        if (!grid_.reaches(axis_, ray, one.low, one.high)) continue;
        double from = 0, to = 0;
        if (!one.lines(layout_.line(u_, column), v, from, to)) continue;
        removed_mm += at_ray(ray, from, to, column, row);
      }
    }
  }

  double at_ray(std::size_t ray, double from, double to, std::uint32_t column, std::uint32_t row) {
    const auto a = static_cast<float>(from - layout_.low[axis_]), b = static_cast<float>(to - layout_.low[axis_]);
    const DexelGrid::Piece first = grid_.first(axis_, ray);
    const float met = what_ == Cut::Remove ? grid_.remove(axis_, ray, a, b) : grid_.between(axis_, ray, a, b);
    if (what_ == Cut::Remove && met > 0) grid_.touch(axis_, ray);
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
  std::vector<One> sweeps_;
  Range columns_, rows_;
  std::vector<Meeting> meetings_;  ///< of the tile at hand
};

template <class Swept>
Removal cut_sweeps(DexelGrid& grid, std::span<const Sweep> sweeps, Cut what) {
  Removal total;
  total.depth_mm = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Pass<Swept> pass(grid, sweeps, axis, what);
    pass.run();
    total.volumes_mm3[axis] = pass.removed_mm * grid.layout().cell_area(axis);
    if (pass.longest_mm < total.depth_mm) total.depth_mm = pass.longest_mm, total.place = pass.place;
  }
  return total;
}

}  // namespace

Removal cut(DexelGrid& grid, std::span<const Sweep> sweeps, Cut what) {
  if (sweeps.empty()) return {};
  return std::visit(
      [&](const auto& swept) { return cut_sweeps<std::remove_cvref_t<decltype(swept)>>(grid, sweeps, what); },
      sweeps.front());
}

}  // namespace rmac::gateway
