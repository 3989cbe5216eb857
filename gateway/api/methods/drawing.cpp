// RMAC_CAM.*: what there is to draw of the machine.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "gateway/animation/drawing_json.hpp"
#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"
#include "gateway/bodies/meshes/mesh_file.hpp"
#include "gateway/json/printable.hpp"

namespace rmac::gateway {

namespace {

constexpr std::uintmax_t kLargestMeshFile = 16U << 20U;
constexpr std::size_t kMostTriangles = 50'000;

tl::unexpected<Error> no_mesh(const std::string& body, const std::string& why) {
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("GetMesh: \"{}\" {}", printable(body, kLongestName), why));
}

Expected<nlohmann::json> mesh_of(const MachineDrawing& drawing, const std::string& name) {
  const std::vector<Body>& bodies = drawing.bodies->bodies;
  std::vector<std::string> meshes;
  for (const Body& body : bodies) {
    if (std::holds_alternative<MeshShape>(body.shape)) meshes.push_back(body.name);
  }
  const auto body = std::ranges::find(bodies, name, &Body::name);
  if (body == bodies.end() || !std::holds_alternative<MeshShape>(body->shape)) {
    return no_mesh(name, meshes.empty()
                             ? "is no mesh: the machine that is loaded has none"
                             : fmt::format("is no mesh of this machine; there are {}", fmt::join(meshes, ", ")));
  }
  const auto& shape = std::get<MeshShape>(body->shape);
  std::error_code unknown;
  // It led to where it lay when the machine was loaded.
  if (const auto now = std::filesystem::weakly_canonical(shape.file, unknown); !unknown && now != shape.file) {
    return no_mesh(name, fmt::format("is in {}, which leads elsewhere since the machine was loaded; load it anew",
                                     shape.file.filename().string()));
  }
  const std::uintmax_t bytes = std::filesystem::file_size(shape.file, unknown);
  if (!unknown && bytes > kLargestMeshFile) {
    return no_mesh(name, fmt::format("is in a file of {} MiB, and at most {} MiB are sent; take {} of the folder of "
                                     "the machine's device.json",
                                     bytes >> 20U, kLargestMeshFile >> 20U, shape.file.filename().string()));
  }
  return read_mesh_file(shape).and_then([&](const TriangleMesh& mesh) -> Expected<nlohmann::json> {
    if (mesh.triangles.size() <= kMostTriangles) return to_json(mesh);
    return no_mesh(name, fmt::format("has {} triangles, and at most {} are sent; take {} of the folder of the "
                                     "machine's device.json",
                                     mesh.triangles.size(), kMostTriangles, shape.file.filename().string()));
  });
}

}  // namespace

void add_drawing_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add(method(
          "RMAC_CAM.GetGeometry",
          "What there is to draw of the loaded machine: the solids of its links, each with its pose while all joints "
          "stand at 0, names of links and joints, and where the tool interface is; `missing` says what is not known. "
          "Asked for once, and again when `geometry` in the topic animation is another number.")
          .gives(WireType::Object)
          .extension()
          .does([](Call& call) { return to_json(*call.machine.shape().drawing()); }));
  add(method("RMAC_CAM.GetMesh",
             "The surface of a body of GetGeometry that is a mesh, in mm: `Points` and `Triangles`. At most 50000 "
             "triangles, from a file of at most 16 MiB.")
          .takes(text("Body").noted("its Name"))
          .gives(WireType::Object)
          .runs_apart()
          .extension()
          .does([](Call& call, const std::string& body) { return mesh_of(*call.machine.shape().drawing(), body); }));
}

}  // namespace rmac::gateway
