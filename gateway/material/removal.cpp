#include "gateway/material/removal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

namespace rmac::gateway {
namespace {

static_assert(RayRow::kRays == DexelGrid::kTile);

constexpr double kNowhere = std::numeric_limits<double>::infinity();

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

/// Along rays, mm from the lattice's corner.
struct Stretch {
  double from = 0, to = 0;
  [[nodiscard]] double length() const noexcept { return to - from; }
  [[nodiscard]] double middle() const noexcept { return (from + to) / 2; }
};

/// Where no ray of a tile has material, or will have any.
class Covered {
 public:
  void begin_with(const DexelGrid::Tile& tile) {
    stretches_.assign({{-kNowhere, double{tile.material.from}}, {double{tile.material.to}, kNowhere}});
    if (tile.gap.from < tile.gap.to) add({double{tile.gap.from}, double{tile.gap.to}});
  }
  void add(Stretch more) {
    std::erase_if(stretches_, [&](const Stretch& one) {
      if (one.from > more.to || one.to < more.from) return false;
      more = {std::min(one.from, more.from), std::max(one.to, more.to)};
      return true;
    });
    stretches_.push_back(more);
  }
  [[nodiscard]] bool all(const Stretch& stretch) const {
    // Walls of sweeps in line differ by rounding, and pieces are kept to far less than this.
    constexpr double kRounding_mm = 1e-8;
    return std::ranges::any_of(stretches_, [&](const Stretch& one) {
      return one.from <= stretch.from + kRounding_mm && one.to >= stretch.to - kRounding_mm;
    });
  }

 private:
  std::vector<Stretch> stretches_;  ///< none touches another
};

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
    Stretch most{};
  };
  struct Rays {
    Range columns, rows;
  };
  /// The outermost of some rays.
  struct Square {
    std::array<double, 2> u{}, v{};
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
    const double u = layout_.line(u_, std::size_t{i} * kTile) + kMiddle * layout_.pitch[u_];
    const double v = layout_.line(v_, std::size_t{j} * kTile) + kMiddle * layout_.pitch[v_];
    const DexelGrid::Tile& there = grid_.tile(axis_, i, j);
    const auto beside = [](const Range& range, std::uint32_t first) {
      return range.end <= first || range.first >= first + kTile;
    };
    meetings_.clear();
    for (const One& one : sweeps_) {
      if (beside(one.columns, i * kTile) || beside(one.rows, j * kTile) || !there.may_have(one.low, one.high)) continue;
      Meeting met{&one};
      if (!one.wide(u, v, met.most.from, met.most.to)) continue;
      met.most.from -= layout_.low[axis_], met.most.to -= layout_.low[axis_];
      if (there.may_have(met.most.from, met.most.to)) meetings_.push_back(met);
    }
    if (meetings_.empty()) return;
    if (what_ == Cut::Remove) {
      const Rays rays = rays_met(i, j);
      const double gap_at = choose(square_of(rays), there);
      if (chosen_.empty()) return;
      take_chosen(rays);
      grid_.tighten(axis_, i, j, static_cast<float>(gap_at));
    } else {
      one_by_one(i, j, there);
    }
  }

  /// What is as deep as told is the one sweep's that took it, so none may be put together with others.
  void one_by_one(std::uint32_t i, std::uint32_t j, const DexelGrid::Tile& there) {
    std::ranges::sort(meetings_, [](const Meeting& a, const Meeting& b) { return a.most.length() > b.most.length(); });
    for (const Meeting& met : meetings_) {
      if (!there.may_have(met.most.from, met.most.to)) continue;  // not any more
      rays_of_tile(*met.one, i, j);
      if (what_ == Cut::RemoveAndTell) grid_.tighten(axis_, i, j, static_cast<float>(met.most.middle()));
    }
  }

  /// The rays of a tile that the sweeps at hand may meet.
  [[nodiscard]] Rays rays_met(std::uint32_t i, std::uint32_t j) const {
    constexpr std::uint32_t kTile = DexelGrid::kTile;
    Rays all = {{(i + 1) * kTile, i * kTile}, {(j + 1) * kTile, j * kTile}};
    for (const Meeting& met : meetings_) {
      const One& one = *met.one;
      all.columns.first = std::min(all.columns.first, std::max(one.columns.first, i * kTile));
      all.columns.end = std::max(all.columns.end, std::min(one.columns.end, (i + 1) * kTile));
      all.rows.first = std::min(all.rows.first, std::max(one.rows.first, j * kTile));
      all.rows.end = std::max(all.rows.end, std::min(one.rows.end, (j + 1) * kTile));
    }
    return all;
  }

  [[nodiscard]] Square square_of(const Rays& rays) const {
    return {{layout_.line(u_, rays.columns.first), layout_.line(u_, rays.columns.end - 1)},
            {layout_.line(v_, rays.rows.first), layout_.line(v_, rays.rows.end - 1)}};
  }

  /// Of the sweeps that may take something of a tile so many that on each of its rays the others take nothing that
  /// these do not. Told is where a gap of all rays is to be looked for.
  double choose(const Square& square, const DexelGrid::Tile& there) {
    chosen_.clear();
    covered_.begin_with(there);
    Stretch widest{0, 0};
    double gap_at = meetings_.front().most.middle(), reach = -kNowhere;
    while (!meetings_.empty()) {
      const auto next = next_after(reach);
      Meeting met = *next;
      *next = meetings_.back();
      meetings_.pop_back();
      const Stretch least = look_closer(*met.one, square, met.most);
      if (covered_.all(met.most)) continue;
      chosen_.push_back(met.one);
      if (!(least.from < least.to)) continue;
      reach = least.to;
      if (least.length() > widest.length()) widest = least, gap_at = least.middle();
      covered_.add(least);
      std::erase_if(meetings_, [this](const Meeting& other) { return covered_.all(other.most); });
    }
    return gap_at;
  }

  /// Few sweeps cover a stretch when each begins where those before have come to and goes the farthest.
  [[nodiscard]] auto next_after(double reach) {
    auto farthest = meetings_.end();
    for (auto it = meetings_.begin(); it != meetings_.end(); ++it) {
      if (it->most.from <= reach && (farthest == meetings_.end() || it->most.to > farthest->most.to)) farthest = it;
    }
    if (farthest != meetings_.end()) return farthest;
    return std::ranges::min_element(meetings_, {}, [](const Meeting& met) { return met.most.from; });
  }

  /// What a sweep takes of each ray of some at least, nothing where it may miss one; `most` becomes less.
  ///
  /// A sweep is convex, so where it begins on a ray is a convex function f of the ray's place, and where it ends a
  /// concave one. On a square f is greatest in a corner. And as f(middle) <= (f(p) + f(p'))/2 for p' opposite to p,
  /// f(p) >= 2 f(middle) - max f(corners). This leaves no more than the slope across the tile, where a sweep that is
  /// wider by half a tile leaves that half, however it slopes.
  [[nodiscard]] Stretch look_closer(const One& one, const Square& square, Stretch& most) const {
    Stretch middle, least{-kNowhere, kNowhere};
    most.from = std::max(most.from, one.low), most.to = std::min(most.to, one.high);
    for (const double u : square.u) {
      for (const double v : square.v) {
        Stretch corner;
        if (!one.lines(u, v, corner.from, corner.to)) return {};
        least.from = std::max(least.from, corner.from - layout_.low[axis_]);
        least.to = std::min(least.to, corner.to - layout_.low[axis_]);
      }
    }
    if constexpr (Swept::kClosedForm) {
      if (!one.lines((square.u[0] + square.u[1]) / 2, (square.v[0] + square.v[1]) / 2, middle.from, middle.to))
        return {};
      most.from = std::max(most.from, 2 * (middle.from - layout_.low[axis_]) - least.from);
      most.to = std::min(most.to, 2 * (middle.to - layout_.low[axis_]) - least.to);
    }
    return least;
  }

  void take_chosen(const Rays& rays) {
    double low = kNowhere, high = -kNowhere;
    for (const One* one : chosen_) low = std::min(low, one->low), high = std::max(high, one->high);
    const std::uint32_t count = rays.columns.end - rays.columns.first;
    RayRow lines;
    for (std::uint32_t i = 0; i < RayRow::kRays; ++i) lines.first[i] = layout_.line(u_, rays.columns.first + i);
    for (std::uint32_t row = rays.rows.first; row < rays.rows.end; ++row) {
      const std::size_t first = grid_.ray(axis_, rays.columns.first, row);
      bool any = false;
      for (std::uint32_t i = 0; i < count && !any; ++i) any = grid_.reaches(axis_, first + i, low, high);
      if (!any) continue;
      lines.second = layout_.line(v_, row);
      take_chosen_of(lines, first, count);
    }
  }

  /// What sweeps that overlap take is one piece, and taken once.
  void take_chosen_of(const RayRow& lines, std::size_t first, std::uint32_t count) {
    RowMet met, more;
    met.none();
    for (const One* one : chosen_) {
      one->lines(lines, more);
      for (std::uint32_t i = 0; i < RayRow::kRays; ++i) {
        if (more.from[i] > met.to[i] || more.to[i] < met.from[i]) {
          if (more.from[i] > more.to[i]) continue;
          if (i < count) take(first + i, met.from[i], met.to[i]);
          met.from[i] = more.from[i], met.to[i] = more.to[i];
        } else {
          met.from[i] = std::min(met.from[i], more.from[i]), met.to[i] = std::max(met.to[i], more.to[i]);
        }
      }
    }
    for (std::uint32_t i = 0; i < count; ++i) take(first + i, met.from[i], met.to[i]);
  }

  void take(std::size_t ray, double from, double to) {
    if (from > to) return;
    const float met = grid_.remove(axis_, ray, static_cast<float>(from - layout_.low[axis_]),
                                   static_cast<float>(to - layout_.low[axis_]));
    if (met > 0) grid_.touch(axis_, ray);
    removed_mm += double{met};
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
    const bool remove = what_ != Cut::Look;
    const float met = remove ? grid_.remove(axis_, ray, a, b) : grid_.between(axis_, ray, a, b);
    if (remove && met > 0) grid_.touch(axis_, ray);
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

  // Of the tile at hand.
  std::vector<Meeting> meetings_;
  std::vector<const One*> chosen_;
  Covered covered_;
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
