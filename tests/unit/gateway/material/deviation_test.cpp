#include "gateway/material/deviation.hpp"

#include <gtest/gtest.h>

#include "gateway/material/mesh_rays.hpp"
#include "unit/gateway/collision/shapes.hpp"
#include "unit/gateway/material/solids.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;
using test::block, test::box_mesh;

const ProfilePiece kSlotCutter{
    .kind = ProfilePiece::Kind::Cone, .middle = 10, .bottom_radius = 2, .top_radius = 2, .height = 20};

TEST(Deviation, OfABlockThatNobodyCutIsWhatItIsLargerThanThePart) {
  const Deviation found = deviation_of(block(10, 0.1), box_mesh({4, 4.5, 4.8}), 0.6);
  EXPECT_NEAR(found.rest_mm, 1, 1e-5);
  EXPECT_NEAR(std::abs(found.rest_at[0]), 4, 1e-5);
  EXPECT_EQ(found.gouge_mm, 0);
  EXPECT_NEAR(found.surface_mm2, 8 * (4 * 4.5 + 4.5 * 4.8 + 4.8 * 4), 6);
  // All but what of the sides at 4 is farther than 0.6 from the block's other sides, too.
  EXPECT_NEAR(found.within_share, 1 - 4.4 * 4.4 / (4 * 4.5 + 4.5 * 4.8 + 4.8 * 4), 0.01);
}

TEST(Deviation, OfASlotThatIsTooDeepIsAGouge) {
  DexelGrid grid = block(10, 0.1);
  // The part's top is at 4; the slot's bottom at 3.75.
  cut(grid, sweep_of(kSlotCutter, {{-20, 1, 13.75}, {20, 1, 13.75}, Vector3d::UnitZ()}), Cut::Remove);
  const Deviation found = deviation_of(grid, box_mesh({5, 5, 4}), 0.05);
  EXPECT_NEAR(found.gouge_mm, 0.25, 1e-5);
  EXPECT_NEAR(found.gouge_at[2], 4, 0.1);
  EXPECT_NEAR(found.rest_mm, 1, 1e-5);
  EXPECT_LT(std::abs(found.gouge_at[1] - 1), 2);
}

TEST(Deviation, OfABlockTurnedInItselfIsMeasuredAcrossItsFaces) {
  TriangleMesh part = box_mesh({3, 3, 3}), larger = box_mesh({3.3, 3.3, 3.3}, 4);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()));
  for (TriangleMesh* mesh : {&part, &larger}) {
    for (Vector& p : mesh->points) {
      const Vector3d q = turn * Vector3d(p[0], p[1], p[2]);
      p = {q[0], q[1], q[2]};
    }
  }
  DexelGrid grid(DexelLayout::of(Eigen::AlignedBox3d(Vector3d::Constant(-6), Vector3d::Constant(6)), 0.1));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ray_by_ray(larger, grid.layout(), axis, [&](std::span<const Crossing> of_ray) {
      for (const auto& [in, out] : inside(of_ray)) {
        grid.put(axis, of_ray.front().ray, std::array{DexelGrid::Piece{of_ray[in].at, of_ray[out].at}});
      }
    });
  }
  grid.tighten();
  const Deviation found = deviation_of(grid, part, 0.301);
  EXPECT_NEAR(found.rest_mm, 0.3, 0.02);
  EXPECT_GT(found.within_share, 0.95);
  EXPECT_NEAR(found.surface_mm2, 6 * 36, 3);
}

}  // namespace
}  // namespace rmac::gateway
