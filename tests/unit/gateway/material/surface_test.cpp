#include "gateway/material/surface.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "gateway/bodies/meshes/mesh_file.hpp"
#include "gateway/material/marching_cubes.hpp"
#include "places.hpp"
#include "unit/gateway/material/solids.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;
using test::block, test::body_of, test::direction, test::filled;

TriangleMesh mesh_of(const DexelGrid& grid, std::uint32_t each_nth) {
  TriangleMesh mesh;
  surface(grid, each_nth, [&](const SurfaceTriangle& triangle) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    for (const Eigen::Vector3f& p : triangle) mesh.points.push_back({double{p[0]}, double{p[1]}, double{p[2]}});
    mesh.triangles.push_back({first, first + 1, first + 2});
  });
  return welded(mesh, 1e-9);
}

TEST(Surface, OfABlockWithBallsCutOutOfItIsClosedAndHoldsWhatIsLeft) {
  std::mt19937_64 random(21);
  const ProfilePiece ball{.kind = ProfilePiece::Kind::Ball, .middle = 2, .rounded = 2};
  for (int n = 0; n < 8; ++n) {
    DexelGrid grid = block(10, 0.25);
    for (int k = 0; k < 6; ++k) {
      const Vector3d a = 5 * direction(random), b = 5 * direction(random);
      cut(grid, sweep_of(ball, {a, b, Vector3d::UnitZ()}), Cut::Remove);
    }
    for (const std::uint32_t nth : {1U, 3U}) {
      const TriangleMesh mesh = mesh_of(grid, nth);
      EXPECT_EQ(fault_of(mesh), "") << n << ", every " << nth;
      EXPECT_NEAR(volume_mm3(mesh) / grid.volume_mm3(), 1, nth == 1 ? 0.01 : 0.06) << n << ", every " << nth;
    }
  }
}

TEST(Surface, OfABallHasItsCornersOnTheBall) {
  const DexelGrid grid = filled(Stock::read(body_of(SphereShape{5})).value(), 0.2);
  const TriangleMesh mesh = mesh_of(grid, 1);
  ASSERT_EQ(fault_of(mesh), "");
  for (const Vector& p : mesh.points) EXPECT_NEAR(std::hypot(p[0], p[1], p[2]), 5, 2e-5);
  EXPECT_NEAR(volume_mm3(mesh) / (4.0 / 3 * std::numbers::pi * 125), 1, 0.002);
}

// Red where a ray that sees no end between two points, of which rounding has one inside, ends half-way between them.
TEST(Surface, HasItsCornersOnABallThatGoesThroughPointsOfTheLattice) {
  std::mt19937_64 random(22);
  std::uniform_real_distribution<double> nearly(-1e-6, 1e-6);
  for (int n = 0; n < 20; ++n) {
    DexelGrid grid = block(10, 0.25);
    const DexelLayout& layout = grid.layout();
    Vector3d through;
    for (std::size_t a = 0; a < 3; ++a)
      through[static_cast<Eigen::Index>(a)] = layout.line(a, random() % layout.count[a]);
    const double radius = std::clamp(through.norm() + nearly(random), 2.0, 5.0);
    const ProfilePiece ball{.kind = ProfilePiece::Kind::Ball, .middle = radius, .rounded = radius};
    cut(grid, sweep_of(ball, {Vector3d::Zero(), Vector3d::Zero(), Vector3d::UnitZ()}), Cut::Remove);
    for (const Vector& p : mesh_of(grid, 1).points) {
      const bool on_block = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}) > 4.999;
      EXPECT_TRUE(on_block || std::abs(std::hypot(p[0], p[1], p[2]) - radius) < 1e-3)
          << p[0] << ' ' << p[1] << ' ' << p[2] << ", radius " << radius;
    }
  }
}

TEST(Surface, GoesIntoAFileAsFineAsTrianglesAllowAndComesBackAsTheSameStock) {
  const DexelGrid grid = block(10, 0.1);
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "rmac-surface-test.stl";
  const auto fine = write_stl(grid, file, 1'000'000);
  ASSERT_TRUE(fine) << fine.error().message;
  EXPECT_NEAR(fine->apart_mm, 0.1, 1e-9);
  const auto coarse = write_stl(grid, file, 10'000);
  ASSERT_TRUE(coarse);
  EXPECT_LE(coarse->triangles, 10'000U);
  EXPECT_EQ(std::filesystem::file_size(file), 84 + 50 * coarse->triangles);
  const auto stock = Stock::read(body_of(MeshShape{file, 1}));
  ASSERT_TRUE(stock) << stock.error().message;
  EXPECT_NEAR(filled(*stock, 0.1).volume_mm3(), 1000, 10);
  std::filesystem::remove(file);
  EXPECT_FALSE(write_stl(grid, "/no/such/folder/a.stl", 1000));
}

/// Neighbours in a lattice of random points agree on every face that they share, or edges would be open.
TEST(MarchingCubes, CloseWhateverIsInside) {
  std::mt19937_64 random(22);
  std::uniform_real_distribution<double> nearly(-1e-6, 1e-6);
  for (int n = 0; n < 20; ++n) {
    DexelGrid grid(DexelLayout::of(Eigen::AlignedBox3d(Vector3d::Zero(), Vector3d::Constant(6)), 1));
    bool in[6][6][6];
    for (auto& plane : in) {
      for (auto& row : plane) {
        for (bool& each : row) each = random() % 2 == 0;
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t j = 0; j < 6; ++j) {
        for (std::size_t i = 0; i < 6; ++i) {
          std::vector<DexelGrid::Piece> pieces;
          for (std::size_t k = 0; k < 6; ++k) {
            std::array<std::size_t, 3> at{};
            at[axis] = k, at[(axis + 1) % 3] = i, at[(axis + 2) % 3] = j;
            if (!in[at[0]][at[1]][at[2]]) continue;
            const auto from = static_cast<float>(k);
            if (!pieces.empty() && pieces.back().to == from) {
              pieces.back().to = from + 1;
            } else {
              pieces.push_back({from, from + 1});
            }
          }
          grid.put(axis, grid.ray(axis, i, j), pieces);
        }
      }
    }
    grid.tighten();
    EXPECT_EQ(fault_of(mesh_of(grid, 1)), "") << n;
  }
}

}  // namespace
}  // namespace rmac::gateway
