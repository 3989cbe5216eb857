#include "gateway/material/dexel_grid.hpp"

#include <gtest/gtest.h>

#include <bitset>
#include <random>
#include <vector>

namespace rmac::gateway {
namespace {

constexpr std::size_t kPlaces = 40;
using Places = std::bitset<kPlaces>;  ///< between each whole number and the next: whether there is material

std::vector<DexelGrid::Piece> pieces_of(const Places& places) {
  std::vector<DexelGrid::Piece> pieces;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    if (!places[i]) continue;
    if (i == 0 || !places[i - 1]) pieces.push_back({static_cast<float>(i), 0});
    pieces.back().to = static_cast<float>(i + 1);
  }
  return pieces;
}

/// Rays of one grid share the room for what is behind their first pieces: each is cut in turn with the others.
TEST(DexelGrid, TakesFromARayWhatLiesBetweenTwoPlacesAndNothingElse) {
  std::mt19937_64 random(31);
  const std::size_t axis = 0;
  for (int n = 0; n < 200; ++n) {
    DexelGrid grid(DexelLayout::of({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(kPlaces, 3, 3)}, 1));
    std::vector<Places> rays(grid.layout().rays(axis));
    for (std::size_t ray = 0; ray < rays.size(); ++ray) {
      rays[ray] = Places(random() | random());
      grid.put(axis, ray, pieces_of(rays[ray]));
    }
    for (int k = 0; k < 60; ++k) {
      const std::size_t ray = random() % rays.size(), from = random() % kPlaces;
      const std::size_t to = std::min(kPlaces, from + random() % 6);
      const std::size_t before = rays[ray].count();
      for (std::size_t i = from; i < to; ++i) rays[ray].reset(i);
      EXPECT_EQ(grid.remove(axis, ray, static_cast<float>(from), static_cast<float>(to)),
                static_cast<float>(before - rays[ray].count()));
    }
    for (std::size_t ray = 0; ray < rays.size(); ++ray) {
      std::vector<DexelGrid::Piece> left;
      grid.pieces(axis, ray, [&](const DexelGrid::Piece& piece) { left.push_back(piece); });
      EXPECT_EQ(left, pieces_of(rays[ray])) << n << ", ray " << ray;
    }
  }
}

}  // namespace
}  // namespace rmac::gateway
