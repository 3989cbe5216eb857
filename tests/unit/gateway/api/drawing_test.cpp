// What there is to draw: GetGeometry and GetMesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "gateway/processes/temporary_folder.hpp"
#include "session.hpp"

namespace rmac::gateway {
namespace {

using fakes::Api;
using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// The closed surface of a ball of `rings` times twice as many quadrilaterals, as an OBJ file.
void write_ball(const fs::path& file, int rings) {
  constexpr double kPi = 3.14159265358979323846;
  std::ofstream out(file);
  out << "v 0 0 1\nv 0 0 -1\n";
  for (int ring = 1; ring < rings; ++ring) {
    for (int i = 0; i < 2 * rings; ++i) {
      const double t = kPi * ring / rings, f = kPi * i / rings;
      out << "v " << std::sin(t) * std::cos(f) << ' ' << std::sin(t) * std::sin(f) << ' ' << std::cos(t) << '\n';
    }
  }
  const auto at = [&](int ring, int i) { return 3 + (ring - 1) * 2 * rings + i % (2 * rings); };
  for (int i = 0; i < 2 * rings; ++i) {
    out << "f 1 " << at(1, i) << ' ' << at(1, i + 1) << "\nf 2 " << at(rings - 1, i + 1) << ' ' << at(rings - 1, i)
        << '\n';
    for (int ring = 1; ring + 1 < rings; ++ring) {
      out << "f " << at(ring, i) << ' ' << at(ring + 1, i) << ' ' << at(ring + 1, i + 1) << "\nf " << at(ring, i) << ' '
          << at(ring + 1, i + 1) << ' ' << at(ring, i + 1) << '\n';
    }
  }
}

void show(Api& api, std::vector<Body> bodies) {
  MachineDrawing drawing;
  drawing.machine = "Fake";
  drawing.bodies = std::make_shared<const MachineBodies>(MachineBodies{{"base"}, std::move(bodies)});
  api.machine.shape_fake.now = std::make_shared<const MachineDrawing>(std::move(drawing));
}

TEST(GetGeometry, SaysOfAMachineWithoutWhatIsMissing) {
  Api api;
  MachineDrawing drawing;
  drawing.missing = "no machine is loaded; load one with Device.Load";
  api.machine.shape_fake.now = std::make_shared<const MachineDrawing>(drawing);
  api.session.authority = false;
  const json told = api.result("RMAC_CAM.GetGeometry");
  EXPECT_EQ(told["missing"], drawing.missing);
  EXPECT_TRUE(told["bodies"].empty());
}

TEST(GetMesh, GivesTheSurfaceOfABodyInMillimetres) {
  const TemporaryFolder folder("mesh");
  write_ball(folder.path() / "ball.obj", 8);
  Api api;
  show(api, {{"ball", "base", MeshShape{folder.path() / "ball.obj", 25.4}, {}, ""}});
  const json mesh = api.result("RMAC_CAM.GetMesh", R"({"Body": "ball"})");
  EXPECT_EQ(mesh["Points"].size(), 2U + 7 * 16);
  EXPECT_EQ(mesh["Triangles"].size(), 2U * 16 * 7);
  double lowest = 0;
  for (const json& point : mesh["Points"]) lowest = std::min(lowest, point[2].get<double>());
  EXPECT_NEAR(lowest, -25.4, 1e-6);
}

TEST(GetMesh, RefusesWhatIsNoneWithThoseThatThereAre) {
  Api api;
  show(api, {{"box", "base", BoxShape{{1, 1, 1}}, {}, ""}});
  EXPECT_THAT(api.refusal("RMAC_CAM.GetMesh", R"({"Body": "box"})", rpc_code::kMachineBase - 14),
              HasSubstr("\"box\" is no mesh: the machine that is loaded has none"));
  show(api, {{"head", "base", MeshShape{"/none/head.stl"}, {}, ""}, {"arm", "base", MeshShape{"/none/a.stl"}, {}, ""}});
  EXPECT_THAT(api.refusal("RMAC_CAM.GetMesh", R"({"Body": "/etc/passwd"})", rpc_code::kMachineBase - 14),
              HasSubstr("is no mesh of this machine; there are head, arm"));
}

TEST(GetMesh, SendsNothingThatALinkLeadsToSinceTheMachineWasLoaded) {
  const TemporaryFolder folder("mesh"), elsewhere("elsewhere");
  write_ball(elsewhere.path() / "other.obj", 8);
  fs::create_symlink(elsewhere.path() / "other.obj", folder.path() / "ball.obj");
  Api api;
  show(api, {{"ball", "base", MeshShape{folder.path() / "ball.obj"}, {}, ""}});
  EXPECT_THAT(api.refusal("RMAC_CAM.GetMesh", R"({"Body": "ball"})", rpc_code::kMachineBase - 14),
              HasSubstr("is in ball.obj, which leads elsewhere"));
}

TEST(GetMesh, RefusesMoreThanASocketShouldCarry) {
  const TemporaryFolder folder("mesh");
  write_ball(folder.path() / "fine.obj", 113);
  std::ofstream(folder.path() / "huge.stl") << "solid";
  fs::resize_file(folder.path() / "huge.stl", (16U << 20U) + 1);
  Api api;
  show(api, {{"fine", "base", MeshShape{folder.path() / "fine.obj"}, {}, ""},
             {"huge", "base", MeshShape{folder.path() / "huge.stl"}, {}, ""}});
  EXPECT_THAT(api.refusal("RMAC_CAM.GetMesh", R"({"Body": "fine"})", rpc_code::kMachineBase - 14),
              HasSubstr("has 50624 triangles, and at most 50000 are sent; take fine.obj"));
  EXPECT_THAT(api.refusal("RMAC_CAM.GetMesh", R"({"Body": "huge"})", rpc_code::kMachineBase - 14),
              HasSubstr("is in a file of 16 MiB, and at most 16 MiB are sent; take huge.stl"));
}

}  // namespace
}  // namespace rmac::gateway
