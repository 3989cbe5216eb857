#include "gateway/rmac/view/drawn_bodies.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

namespace rmac::cli {
namespace {

using gateway::Body;

constexpr double kRadius_mm = 50;
constexpr int kRound = 200, kUp = 100;  // pieces

Vector on_ball(int around, int up) {
  const double a = 2 * std::numbers::pi * around / kRound, b = std::numbers::pi * up / kUp;
  return {kRadius_mm * std::sin(b) * std::cos(a), kRadius_mm * std::sin(b) * std::sin(a), -kRadius_mm * std::cos(b)};
}

/// A ball of 39 600 triangles as text STL, gone when this goes.
class BallFile {
 public:
  BallFile() : path_(std::filesystem::temp_directory_path() / ("ball-" + std::to_string(::getpid()) + ".stl")) {
    std::ofstream out(path_);
    const auto facet = [&out](const Vector& a, const Vector& b, const Vector& c) {
      out << "facet normal 0 0 0\nouter loop\n";
      for (const Vector& p : {a, b, c}) out << "vertex " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
      out << "endloop\nendfacet\n";
    };
    out << "solid ball\n";
    for (int i = 0; i < kRound; ++i) {
      const int next = (i + 1) % kRound;
      for (int k = 0; k < kUp; ++k) {
        if (k > 0) facet(on_ball(i, k), on_ball(next, k), on_ball(next, k + 1));
        if (k + 1 < kUp) facet(on_ball(i, k), on_ball(next, k + 1), on_ball(i, k + 1));
      }
    }
    out << "endsolid ball\n";
  }
  ~BallFile() { std::filesystem::remove(path_); }
  BallFile(const BallFile&) = delete;
  BallFile& operator=(const BallFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

gateway::MachineBodies machine_of(const BallFile& file) {
  return {{"base", "X"},
          {Body{"bed", "base", gateway::BoxShape{{100, 20, 30}}, Frame{{1, 2, 3}, {1, 0, 0, 0}}, "#123456"},
           Body{"ball", "X", gateway::MeshShape{file.path(), 1}, Frame{{0, 0, 200}, {1, 0, 0, 0}}, ""}}};
}

TEST(DrawnBodies, StandOnTheirLinksWithWhatTheyAreMadeOf) {
  const BallFile file;
  gateway::Setup setup;
  setup.part_frame = Frame{{10, 0, 0}, {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}};  // a quarter about z
  setup.stock = Body{"stock", "", gateway::ConeShape{8, 4, 12}, Frame{{5, 0, 0}, {1, 0, 0, 0}}, ""};
  const auto drawn = drawn_bodies(machine_of(file), &setup);
  ASSERT_TRUE(drawn) << drawn.error().message;
  ASSERT_EQ(drawn->bodies.size(), 3U);
  EXPECT_EQ(drawn->coarser_mm, 0);
  const nlohmann::json &bed = drawn->bodies[0].json, &ball = drawn->bodies[1].json, &stock = drawn->bodies[2].json;
  EXPECT_EQ(bed["box"], nlohmann::json({100, 20, 30}));
  EXPECT_EQ(bed["colour"], "#123456");
  EXPECT_EQ(bed["p"], nlohmann::json({1, 2, 3}));
  EXPECT_EQ(ball["link"], 1);
  EXPECT_EQ(ball["mesh"]["triangles"].size(), 3U * 2 * kRound * (kUp - 1));
  EXPECT_NEAR(drawn->bodies[1].reach.middle[2], 200, 1e-3);
  EXPECT_GE(drawn->bodies[1].reach.radius, kRadius_mm);
  EXPECT_EQ(stock["turned"], nlohmann::json::parse("[[0,-6],[8,-6],[4,6],[0,6]]"));
  EXPECT_EQ(stock["p"], nlohmann::json({10, 5, 0})) << "the part frame turns it";
  EXPECT_EQ(stock["kind"], "stock");
}

// Red when a mesh has more triangles than it may, or is off its true surface by more than is told.
TEST(DrawnBodies, AreCoarserWhereThereAreTooManyTriangles) {
  const BallFile file;
  constexpr std::size_t kMost = 5000;
  const auto drawn = drawn_bodies(machine_of(file), nullptr, kMost);
  ASSERT_TRUE(drawn) << drawn.error().message;
  const nlohmann::json& mesh = drawn->bodies[1].json["mesh"];
  EXPECT_LE(mesh["triangles"].size(), 3 * kMost);
  EXPECT_GE(mesh["triangles"].size(), 3 * kMost / 10) << "so coarse it need not be";
  EXPECT_GT(drawn->coarser_mm, 0);
  EXPECT_LT(drawn->coarser_mm, kRadius_mm / 3);
  const auto points = mesh["points"].get<std::vector<double>>();
  for (int i = 0; i < kRound; ++i) {
    for (int k = 0; k <= kUp; ++k) {
      const Vector p = on_ball(i, k);
      double nearest = 1e9;
      for (std::size_t n = 0; n < points.size(); n += 3) {
        nearest = std::min(nearest, std::hypot(points[n] - p[0], points[n + 1] - p[1], points[n + 2] - p[2]));
      }
      ASSERT_LE(nearest, drawn->coarser_mm + 0.01) << i << ' ' << k;
    }
  }
}

TEST(DrawnBodies, NameTheFileOfAMeshThatCannotBeRead) {
  gateway::MachineBodies machine{{"base", "X"},
                                 {Body{"bed", "base", gateway::MeshShape{"nowhere.stl", 1}, Frame{}, ""}}};
  const auto drawn = drawn_bodies(machine, nullptr);
  ASSERT_FALSE(drawn);
  EXPECT_THAT(drawn.error().message, testing::AllOf(testing::HasSubstr("bed"), testing::HasSubstr("nowhere.stl")));
}

}  // namespace
}  // namespace rmac::cli
