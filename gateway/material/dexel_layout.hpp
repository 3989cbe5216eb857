#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>

namespace rmac::gateway {

/// Where the rays of a tri-dexel model run: three families, each along one axis of the part frame, through the middles
/// of the cells of one lattice, so that rays of all three meet in each middle. mm.
struct DexelLayout {
  std::array<double, 3> low{};           ///< corner of the lattice
  std::array<double, 3> pitch{};         ///< of its cells: the resolution or a little less, so that cells fill the box
  std::array<std::uint32_t, 3> count{};  ///< cells along each axis

  /// Bytes of a ray, with room for one more piece of material on every second ray.
  static constexpr std::uint64_t kBytesOfRay = 19;

  /// The axes across a family's rays, in the order in which the rays are counted.
  [[nodiscard]] static constexpr std::size_t across(std::size_t axis, std::size_t which) {
    return (axis + 1 + which) % 3;
  }

  /// `resolution_mm` > 0; the box has an extent along each axis.
  [[nodiscard]] static DexelLayout of(const Eigen::AlignedBox3d& box, double resolution_mm);

  /// Where the i-th rays of the other families cross an axis.
  [[nodiscard]] double line(std::size_t axis, std::size_t i) const noexcept {
    return low[axis] + (static_cast<double>(i) + 0.5) * pitch[axis];
  }
  [[nodiscard]] double cell_area(std::size_t axis) const noexcept {
    return pitch[across(axis, 0)] * pitch[across(axis, 1)];
  }
  [[nodiscard]] std::uint64_t rays(std::size_t axis) const noexcept {
    return std::uint64_t{count[across(axis, 0)]} * count[across(axis, 1)];
  }
  [[nodiscard]] std::uint64_t bytes() const noexcept { return kBytesOfRay * (rays(0) + rays(1) + rays(2)); }
};

/// What the model of a box takes at a resolution, also where that is more than can be counted in integers.
[[nodiscard]] double dexel_bytes(const Eigen::AlignedBox3d& box, double resolution_mm);

/// The finest resolution of 1, 2 or 5 times a power of ten that takes at most so much, mm.
[[nodiscard]] double finest_resolution(const Eigen::AlignedBox3d& box, double bytes);

}  // namespace rmac::gateway
