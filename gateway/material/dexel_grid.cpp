#include "gateway/material/dexel_grid.hpp"

#include <algorithm>

namespace rmac::gateway {

DexelGrid::DexelGrid(const DexelLayout& layout) : layout_(layout) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    families_[axis].rays.resize(layout_.rays(axis));
    families_[axis].touched.resize(layout_.rays(axis));
    families_[axis].tiles.resize(std::size_t{tiles_along(axis, 0)} * tiles_along(axis, 1));
  }
}

std::uint32_t DexelGrid::keep(const Piece& piece, std::uint32_t next) {
  if (free_ == kNone) {
    if (more_.size() >= kMostMore) {
      overflowed_ = true;
      return next;
    }
    more_.push_back({piece, next});
    return static_cast<std::uint32_t>(more_.size() - 1);
  }
  const std::uint32_t at = free_;
  free_ = more_[at].next;
  more_[at] = {piece, next};
  return at;
}

void DexelGrid::release(std::uint32_t at) {
  more_[at].next = free_;
  free_ = at;
}

void DexelGrid::put(std::size_t axis, std::size_t ray, std::span<const Piece> pieces) {
  std::uint32_t next = kNone;
  for (std::size_t i = pieces.size(); i-- > 1;) next = keep(pieces[i], next);
  if (!pieces.empty()) families_[axis].rays[ray] = {pieces.front(), next};
}

void DexelGrid::tighten() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::uint32_t j = 0; j < tiles_along(axis, 1); ++j) {
      for (std::uint32_t i = 0; i < tiles_along(axis, 0); ++i) tighten(axis, i, j, 0);
    }
  }
}

void DexelGrid::tighten(std::size_t axis, std::uint32_t first, std::uint32_t second, float gap_at) {
  constexpr float kFar = std::numeric_limits<float>::max();
  Tile tile{{kFar, -kFar}, {-kFar, kFar}};
  const std::uint32_t columns = layout_.count[DexelLayout::across(axis, 0)];
  const std::uint32_t rows = layout_.count[DexelLayout::across(axis, 1)];
  for (std::uint32_t j = second * kTile; j < std::min(rows, (second + 1) * kTile); ++j) {
    for (std::uint32_t i = first * kTile; i < std::min(columns, (first + 1) * kTile); ++i) {
      pieces(axis, ray(axis, i, j), [&](const Piece& piece) {
        tile.material.from = std::min(tile.material.from, piece.from);
        tile.material.to = std::max(tile.material.to, piece.to);
        if (piece.to <= gap_at) {
          tile.gap.from = std::max(tile.gap.from, piece.to);
        } else if (piece.from >= gap_at) {
          tile.gap.to = std::min(tile.gap.to, piece.from);
        } else {
          tile.gap = {kFar, -kFar};
        }
      });
    }
  }
  families_[axis].tiles[second * tiles_along(axis, 0) + first] = tile;
}

bool DexelGrid::holds(std::size_t axis, std::size_t ray, float at) const noexcept {
  bool inside = false;
  pieces(axis, ray, [&](const Piece& piece) { inside = inside || (piece.from <= at && at < piece.to); });
  return inside;
}

float DexelGrid::between(std::size_t axis, std::size_t ray, float from, float to) const noexcept {
  float sum = 0;
  pieces(axis, ray,
         [&](const Piece& piece) { sum += std::max(0.0F, std::min(to, piece.to) - std::max(from, piece.from)); });
  return sum;
}

float DexelGrid::remove(std::size_t axis, std::size_t ray, float from, float to) {
  Ray& first = families_[axis].rays[ray];
  if (!(from < to) || first.piece.from >= to) return 0;
  if (first.next == kNone) {
    Piece& piece = first.piece;
    if (piece.to <= from || piece.from >= piece.to) return 0;
    const float removed = std::min(piece.to, to) - std::max(piece.from, from);
    if (piece.from < from && piece.to > to) {
      first.next = keep({to, piece.to}, kNone);
      if (first.next == kNone) return 0;
      piece.to = from;
    } else if (piece.from < from) {
      piece.to = from;
    } else if (piece.to > to) {
      piece.from = to;
    } else {
      piece = kNothing;
    }
    return removed;
  }
  return remove_of_several(axis, ray, from, to);
}

/// In place: a ray through a slot has two pieces, and the next cut along the slot's side changes an end of one.
float DexelGrid::remove_of_several(std::size_t axis, std::size_t ray, float from, float to) {
  Ray& first = families_[axis].rays[ray];
  const auto ray_at = [&](std::uint32_t at) -> Ray& { return at == kNone ? first : more_[at]; };
  float removed = 0;
  std::uint32_t at = kNone, before = kNone;  // `kNone` is the first piece
  while (true) {
    Piece& piece = ray_at(at).piece;
    const std::uint32_t next = ray_at(at).next;
    if (piece.from >= to) return removed;
    if (piece.from < from && piece.to > to) {
      const std::uint32_t rest = keep({to, piece.to}, next);  // what `piece` refers to may have moved
      if (rest == next) return 0;
      ray_at(at).piece.to = from, ray_at(at).next = rest;
      return to - from;
    }
    if (piece.to > to) {
      removed += to - std::max(piece.from, from);
      piece.from = std::max(piece.from, to);
      return removed;
    }
    if (piece.from >= from) {
      removed += piece.to - piece.from;
      if (at != kNone) {
        ray_at(before).next = next;
        release(at);
      } else if (next != kNone) {
        first = more_[next];
        release(next);
        continue;  // with what is the first piece now
      } else {
        piece = kNothing;
      }
    } else {
      if (piece.to > from) removed += piece.to - from, piece.to = from;
      before = at;
    }
    if (next == kNone) return removed;
    at = next;
  }
}

double DexelGrid::touched_area_mm2(std::size_t axis) const {
  return static_cast<double>(std::ranges::count(families_[axis].touched, 1)) * layout_.cell_area(axis);
}

double DexelGrid::volume_mm3(std::size_t axis) const {
  double length = 0;
  for (std::size_t i = 0; i < families_[axis].rays.size(); ++i) {
    pieces(axis, i, [&](const Piece& piece) { length += double{piece.to} - double{piece.from}; });
  }
  return length * layout_.cell_area(axis);
}

std::uint64_t DexelGrid::bytes() const noexcept {
  std::uint64_t bytes = more_.capacity() * sizeof(Ray);
  for (const Family& family : families_) {
    bytes += family.rays.capacity() * sizeof(Ray) + family.tiles.capacity() * sizeof(Tile) + family.touched.capacity();
  }
  return bytes;
}

}  // namespace rmac::gateway
