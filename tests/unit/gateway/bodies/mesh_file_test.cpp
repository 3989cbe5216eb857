#include "gateway/bodies/meshes/mesh_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "gateway/processes/temporary_folder.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

/// A box as CAD programs export it: three corners a triangle, none shared.
std::vector<std::array<Vector, 3>> box(double x, double y, double z) {
  const auto corner = [&](int i) { return Vector{i & 1 ? x : 0, i & 2 ? y : 0, i & 4 ? z : 0}; };
  constexpr std::array<std::array<int, 4>, 6> kFaces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  std::vector<std::array<Vector, 3>> triangles;
  for (const auto& [a, b, c, d] : kFaces) {
    triangles.push_back({corner(a), corner(b), corner(c)});
    triangles.push_back({corner(a), corner(c), corner(d)});
  }
  return triangles;
}

std::string binary_stl(const std::vector<std::array<Vector, 3>>& triangles, const char* header) {
  std::string data(80, ' ');
  data.replace(0, std::strlen(header), header);
  const auto put = [&](const auto& value) { data.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(triangles.size()));
  for (const auto& triangle : triangles) {
    for (int i = 0; i < 3; ++i) put(0.0F);
    for (const Vector& corner : triangle) {
      for (const double c : corner) put(static_cast<float>(c));
    }
    put(std::uint16_t{0});
  }
  return data;
}

std::string text_stl(const std::vector<std::array<Vector, 3>>& triangles) {
  std::string text = "solid part\n";
  for (const auto& triangle : triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const auto& [x, y, z] : triangle) text += fmt::format("vertex {:.6e} {:.6e} {:.6e}\n", x, y, z);
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid part\n";
}

class MeshFile : public testing::Test {
 protected:
  Expected<TriangleMesh> read(const char* name, const std::string& data, double unit_mm = 1) {
    std::ofstream(folder_.path() / name, std::ios::binary) << data;
    return read_mesh_file({folder_.path() / name, unit_mm});
  }
  std::string refusal(const char* name, const std::string& data) {
    const auto mesh = read(name, data);
    return mesh ? "taken" : mesh.error().message;
  }
  TemporaryFolder folder_{"meshes"};
};

TEST_F(MeshFile, MakesCornersThatMeetOneInTextAndBinary) {
  for (const std::string& data : {text_stl(box(10, 20, 30)), binary_stl(box(10, 20, 30), "made by a program")}) {
    const auto mesh = read("box.stl", data);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->points.size(), 8u);
    EXPECT_EQ(mesh->triangles.size(), 12u);
    EXPECT_NEAR(volume_mm3(*mesh), 6000, 1e-6);
  }
}

TEST_F(MeshFile, ReadsABinaryFileWhoseHeaderBeginsAsTextWould) {
  const auto mesh = read("box.STL", binary_stl(box(1, 2, 3), "solid exported by a CAD program"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_NEAR(volume_mm3(*mesh), 6, 1e-6);
}

TEST_F(MeshFile, ReadsFacesOfAnObjectFileWithMoreThanThreeCorners) {
  const auto mesh = read("box.obj",
                         "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
                         "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_NEAR(volume_mm3(*mesh), 1, 1e-9);
}

TEST_F(MeshFile, TakesInchesWhereTheyAreSaid) {
  const auto mesh = read("box.stl", text_stl(box(1, 1, 1)), 25.4);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_NEAR(volume_mm3(*mesh), 25.4 * 25.4 * 25.4, 1e-3);
}

TEST_F(MeshFile, ClosesWhatIsOpenOnlyByRounding) {
  auto triangles = box(10, 20, 30);
  triangles[3][1][0] += 4e-4;
  const auto mesh = read("box.stl", text_stl(triangles));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->points.size(), 8u);
}

TEST_F(MeshFile, RefusesWhatIsNoSurfaceOfASolid) {
  auto open = box(10, 20, 30);
  open.pop_back();
  EXPECT_THAT(refusal("a.stl", text_stl(open)), HasSubstr("is open: 3 edges"));
  auto inverted = box(10, 20, 30);
  for (auto& triangle : inverted) std::swap(triangle[0], triangle[1]);
  EXPECT_THAT(refusal("a.stl", text_stl(inverted)), HasSubstr("is inside out"));
  auto mixed = box(10, 20, 30);
  std::swap(mixed[4][0], mixed[4][1]);
  EXPECT_THAT(refusal("a.stl", text_stl(mixed)), HasSubstr("wound in opposite senses"));
  EXPECT_THAT(refusal("a.stl", text_stl(box(10, 20, 0))), HasSubstr("flat"));
}

TEST_F(MeshFile, RefusesWhatIsNoMesh) {
  EXPECT_THAT(refusal("a.stl", ""), HasSubstr("is no mesh"));
  EXPECT_THAT(refusal("a.stl", "solid nothing\nendsolid nothing\n"), HasSubstr("a.stl"));
  EXPECT_THAT(refusal("a.step", "ISO-10303-21;"), HasSubstr("is neither an .stl nor an .obj file"));
  EXPECT_THAT(refusal("a.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"), HasSubstr("a.obj"));
  std::string cut = binary_stl(box(1, 2, 3), "x");
  cut.resize(cut.size() - 30);
  EXPECT_THAT(refusal("a.stl", cut), HasSubstr("a.stl"));
  EXPECT_THAT(read_mesh_file({folder_.path() / "none.stl", 1}).error().message, HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace rmac::gateway
