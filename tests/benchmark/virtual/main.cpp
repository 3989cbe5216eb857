#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <numbers>
#include <string_view>

#include "benchmark/motion/figures.hpp"
#include "benchmark/virtual/forces.hpp"
#include "gateway/collision/checker.hpp"
#include "rmac/modules/chain_kinematics.hpp"

// How fast collisions are checked: a five-axis machine of 20 bodies finishes a dome of 100 000 triangles along a
// spiral, the tool on the surface in every cycle, which is the most work there is; and the same path 30 mm off, as
// positioning.

namespace {

using namespace rmac;
using namespace rmac::gateway;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPeriod_s = 0.001, kTarget = 50;
constexpr double kRadius_mm = 40, kCentre_mm = -60, kLength_mm = 80, kFeed_mm_s = 50, kClearance_mm = 0.1;

modules::ChainKinematics trunnion() {
  using modules::ScrewAxis;
  const std::vector<ScrewAxis> axes{{JointType::Linear, {1, 0, 0}, {}},
                                    {JointType::Linear, {0, 1, 0}, {}},
                                    {JointType::Linear, {0, 0, 1}, {}},
                                    {JointType::Rotary, {1, 0, 0}, {0, 0, -60}},
                                    {JointType::Rotary, {0, 0, 1}, {}}};
  return {axes, {4, 3, 0, 1, 2}, Frame{}};
}

/// A ball of about 100 000 triangles.
TriangleMesh ball() {
  constexpr std::uint32_t kAround = 320, kUp = 158;
  TriangleMesh mesh;
  const auto point = [](double around, double lean) {
    return Vector{kRadius_mm * std::cos(around) * std::sin(lean), kRadius_mm * std::sin(around) * std::sin(lean),
                  kCentre_mm + kRadius_mm * std::cos(lean)};
  };
  for (std::uint32_t j = 0; j <= kUp; ++j) {
    for (std::uint32_t i = 0; i < kAround; ++i) {
      mesh.points.push_back(point(2 * std::numbers::pi * i / kAround, std::numbers::pi * j / kUp));
    }
  }
  for (std::uint32_t j = 0; j < kUp; ++j) {
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const std::uint32_t a = j * kAround + i, b = j * kAround + (i + 1) % kAround;
      mesh.triangles.push_back({a, a + kAround, b + kAround});
      mesh.triangles.push_back({a, b + kAround, b});
    }
  }
  return welded(mesh, 1e-9);
}

SceneBody box(SceneBody::Kind kind, std::string name, std::size_t link, const Vector3d& from, const Vector3d& to) {
  return {kind, std::move(name), link, Solid(Convex::box((to - from) / 2)),
          Isometry3d(Eigen::Translation3d((from + to) / 2))};
}

/// Twenty with the tool's: the machine's ten, four clamps, the part, and five of the tool.
std::vector<SceneBody> bodies(const TriangleMesh& part) {
  using Kind = SceneBody::Kind;
  std::vector<SceneBody> scene;
  scene.push_back(box(Kind::Machine, "turntable", 0, {-90, -90, -130}, {90, 90, -105}));
  scene.push_back(box(Kind::Machine, "cradle", 1, {-180, -90, -165}, {180, 90, -135}));
  scene.push_back(box(Kind::Machine, "left arm", 1, {-180, -60, -135}, {-150, 60, -25}));
  scene.push_back(box(Kind::Machine, "right arm", 1, {150, -60, -135}, {180, 60, -25}));
  scene.push_back(box(Kind::Machine, "left trunnion", 2, {-280, -100, -400}, {-200, 100, -20}));
  scene.push_back(box(Kind::Machine, "right trunnion", 2, {200, -100, -400}, {280, 100, -20}));
  scene.push_back(box(Kind::Machine, "bed", 2, {-450, -350, -500}, {450, 550, -400}));
  scene.push_back(box(Kind::Machine, "column", 3, {-150, 400, -400}, {150, 550, 500}));
  scene.push_back(box(Kind::Machine, "ram", 4, {-100, -100, 360}, {100, 600, 500}));
  scene.push_back(box(Kind::Machine, "head", 5, {-75, -75, 70}, {75, 75, 320}));
  for (int k = 0; k < 4; ++k) {
    const double x = k % 2 == 0 ? -70 : 70, y = k / 2 == 0 ? -70 : 70;
    scene.push_back(box(Kind::Fixture, fmt::format("clamp {}", k), 0, {x - 8, y - 8, -105}, {x + 8, y + 8, -90}));
  }
  scene.push_back({Kind::Part, "part", 0, Solid(part), Isometry3d::Identity()});
  return scene;
}

Tool ball_mill() {
  Tool tool{.number = 1, .length_mm = kLength_mm};
  tool.shape = ToolShape{.dc = 6,
                         .re = 3,
                         .apmx = 12,
                         .lcf = 12,
                         .oal = 57,
                         .zefp = 2,
                         .shank = {{3, 3, 45}},
                         .holder = {{10, 14, 30}, {20, 20, 15}}};
  return tool;
}

std::vector<std::array<double, 5>> spiral(std::size_t cycles, double off_mm) {
  const auto kinematics = trunnion();
  std::vector<std::array<double, 5>> path;
  std::array<double, 5> seed{};
  double around = 0, lean = 0.3;
  for (std::size_t i = 0; i < cycles; ++i) {
    const Vector n{std::cos(around) * std::sin(lean), std::sin(around) * std::sin(lean), std::cos(lean)};
    const double r = kRadius_mm + off_mm;
    std::array<double, 5> joints{};
    static_cast<void>(kinematics.inverse({{r * n[0], r * n[1], kCentre_mm + r * n[2]}, n},
                                         {{0, 0, -kLength_mm}, {1, 0, 0, 0}}, seed, joints));
    path.push_back(seed = joints);
    around += kFeed_mm_s * kPeriod_s / (kRadius_mm * std::sin(lean));
    lean = 0.3 + 0.7 * static_cast<double>(i) / static_cast<double>(cycles);
  }
  return path;
}

void measure(const char* name, std::size_t cycles, double off_mm, const TriangleMesh& part, bench::Figures& figures) {
  const std::vector<std::string> chain{"C", "A", "base", "X", "Y", "Z"}, names{"X", "Y", "Z", "A", "C"};
  const std::vector<std::pair<double, double>> limits(5, {-200, 200});
  CollisionChecker checker(LinkChain::make(trunnion(), chain, names, limits).value(), bodies(part), Frame{},
                           kClearance_mm);
  checker.set_tool(ball_mill());
  const auto path = spiral(cycles, off_mm);
  const std::clock_t began = std::clock();
  for (std::size_t i = 0; i < path.size(); ++i) {
    checker.advance(static_cast<double>(i) * kPeriod_s, path[i], {.id = 1, .line = 1, .cutting = off_mm == 0});
  }
  const double took_s = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  const double times = static_cast<double>(cycles) * kPeriod_s / took_s;
  std::size_t collisions = 0;
  for (const Finding& f : checker.findings().sorted()) collisions += f.collision ? 1 : 0;
  figures.at_least(
      name, times, kTarget, "times real time",
      fmt::format("{} cycles, 20 bodies, {} triangles, clearance {} mm; {:.2f} distances a cycle, {} collisions",
                  cycles, part.triangles.size(), kClearance_mm,
                  static_cast<double>(checker.distances_computed()) / static_cast<double>(cycles), collisions));
}

}  // namespace

int main(int count, char** words) {
  const bool quick = count > 1 && std::string_view(words[1]) == "--quick";
  const std::size_t cycles = quick ? 20'000 : 1'000'000;
  if (quick) fmt::print("quick: {} cycles instead of 1000000\n", cycles);
  const TriangleMesh part = ball();
  bench::Figures figures;
  measure("collisions: tool on the surface", cycles, 0, part, figures);
  measure("collisions: positioning, 30 mm off", cycles, 30, part, figures);
  bench::measure_forces(figures);
  figures.print_table();
  return figures.all_ok() ? 0 : 1;
}
