#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "gateway/material/dexel_layout.hpp"

namespace rmac::gateway {

/// Material as what three families of rays see of it: along each ray the pieces that are in material. Pieces are kept
/// as single precision from the lattice's corner: to a ten-millionth of its extent. Nothing but what is told to is
/// ever added.
class DexelGrid {
 public:
  struct Piece {
    float from = 0, to = 0;  ///< mm from the lattice's corner
    [[nodiscard]] bool operator==(const Piece&) const = default;
  };
  /// Rays lie in square tiles. Of each is known between where and where there may be material, and a gap in between
  /// where no ray of it has any: so much need not be looked at ray by ray.
  static constexpr std::uint32_t kTile = 8;
  struct Tile {
    Piece material{1, 0};  ///< `from` > `to`: there is none
    Piece gap{0, 0};
    [[nodiscard]] bool may_have(double from, double to) const noexcept {
      return material.from <= material.to && to > double{material.from} && from < double{material.to} &&
             !(from >= double{gap.from} && to <= double{gap.to});
    }
  };

  explicit DexelGrid(const DexelLayout& layout);

  [[nodiscard]] const DexelLayout& layout() const noexcept { return layout_; }
  /// Number of a ray within its family.
  [[nodiscard]] std::size_t ray(std::size_t axis, std::size_t first, std::size_t second) const noexcept {
    return second * layout_.count[DexelLayout::across(axis, 0)] + first;
  }

  /// Puts material on an empty ray: pieces in ascending order that do not touch. `tighten` when all rays have theirs.
  void put(std::size_t axis, std::size_t ray, std::span<const Piece> pieces);
  void tighten();

  /// Calls `visit(piece)` for each piece of a ray, in ascending order.
  template <class Visit>
  void pieces(std::size_t axis, std::size_t ray, Visit&& visit) const {
    const Ray& r = families_[axis].rays[ray];
    if (r.piece.from >= r.piece.to) return;
    visit(r.piece);
    for (std::uint32_t next = r.next; next != kNone; next = more_[next].next) visit(more_[next].piece);
  }
  [[nodiscard]] bool holds(std::size_t axis, std::size_t ray, float at) const noexcept;

  /// Of a ray that has any.
  [[nodiscard]] const Piece& first(std::size_t axis, std::size_t ray) const noexcept {
    return families_[axis].rays[ray].piece;
  }
  /// Whether a ray has anything between two places.
  [[nodiscard]] bool reaches(std::size_t axis, std::size_t ray, double from, double to) const noexcept {
    const Ray& r = families_[axis].rays[ray];
    if (r.piece.from >= r.piece.to) return false;
    if (double{r.piece.to} > from) return double{r.piece.from} < to;
    for (std::uint32_t next = r.next; next != kNone; next = more_[next].next) {
      const Piece& piece = more_[next].piece;
      if (double{piece.to} > from) return double{piece.from} < to;
    }
    return false;
  }
  /// Takes away what lies between `from` and `to`: how much that was, mm. `tighten` of its tile is the caller's.
  float remove(std::size_t axis, std::size_t ray, float from, float to);
  /// Notes that something of a ray was taken away.
  void touch(std::size_t axis, std::size_t ray) noexcept { families_[axis].touched[ray] = 1; }
  /// How large that, of all rays of a family, looks along them.
  [[nodiscard]] double touched_area_mm2(std::size_t axis) const;
  /// How much there is between `from` and `to`, mm.
  [[nodiscard]] float between(std::size_t axis, std::size_t ray, float from, float to) const noexcept;

  // Tiles of a family, counted as rays are.
  [[nodiscard]] std::uint32_t tiles_along(std::size_t axis, std::size_t which) const noexcept {
    return (layout_.count[DexelLayout::across(axis, which)] + kTile - 1) / kTile;
  }
  [[nodiscard]] const Tile& tile(std::size_t axis, std::uint32_t first, std::uint32_t second) const noexcept {
    return families_[axis].tiles[second * tiles_along(axis, 0) + first];
  }
  /// What is known of a tile, anew; the gap is looked for around a place.
  void tighten(std::size_t axis, std::uint32_t first, std::uint32_t second, float gap_at);

  /// By the rays of one family.
  [[nodiscard]] double volume_mm3(std::size_t axis) const;
  /// The mean of the three families.
  [[nodiscard]] double volume_mm3() const { return (volume_mm3(0) + volume_mm3(1) + volume_mm3(2)) / 3; }
  /// So many pieces that there was no room for more: where material should have become two pieces it was left whole.
  [[nodiscard]] bool overflowed() const noexcept { return overflowed_; }
  /// What rays and pieces take now.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::size_t kMostMore = 100'000'000;
  static constexpr Piece kNothing{1, 0};
  /// Its first piece; `kNothing` where there is none.
  struct Ray {
    Piece piece = kNothing;
    std::uint32_t next = kNone;
  };
  struct Family {
    std::vector<Ray> rays;
    std::vector<Tile> tiles;
    std::vector<std::uint8_t> touched;  ///< of each ray
  };
  [[nodiscard]] std::uint32_t keep(const Piece& piece, std::uint32_t next);
  void release(std::uint32_t at);
  float remove_of_several(std::size_t axis, std::size_t ray, float from, float to);

  DexelLayout layout_;
  std::array<Family, 3> families_;
  std::vector<Ray> more_;  ///< pieces behind a ray's first one
  std::uint32_t free_ = kNone;
  bool overflowed_ = false;
};

}  // namespace rmac::gateway
