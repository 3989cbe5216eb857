#include "gateway/bodies/meshes/mesh_file.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <system_error>

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestFile = 512u << 20;
constexpr std::size_t kMostTriangles = 4'000'000;
constexpr double kFarthest_mm = 1e5;

tl::unexpected<Error> wrong(const fs::path& file, const std::string& what) {
  return failure(MinorCode::InvalidParameterValue, fmt::format("{}: {}", file.string(), what));
}

/// Files are told apart by their endings, and other formats of assimp's many are not tried: nobody asked for them.
bool known_ending(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending == ".stl" || ending == ".obj";
}

/// False where a corner is not finite, or farther away than any machine reaches.
bool append(const aiMesh& part, double unit_mm, TriangleMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    const Vector point{v.x * unit_mm, v.y * unit_mm, v.z * unit_mm};
    for (const double c : point) {
      if (!(std::abs(c) < kFarthest_mm)) return false;
    }
    mesh.points.push_back(point);
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines
    mesh.triangles.push_back({first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
  }
  return true;
}

/// Opens one file alone: an .obj names others (materials), which may be anything on this computer.
class OnlyThisFile final : public Assimp::IOSystem {
 public:
  explicit OnlyThisFile(std::string file) : file_(std::move(file)) {}

  bool Exists(const char* file) const override { return file_ == file; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return Exists(file) ? files_.Open(file, mode) : nullptr;
  }
  void Close(Assimp::IOStream* stream) override { files_.Close(stream); }

 private:
  std::string file_;
  Assimp::DefaultIOSystem files_;
};

/// Corners that are the same to the last digit first. Programs that write text round, so that an open mesh may be
/// closed after all.
TriangleMesh closed(const TriangleMesh& read, std::string& fault) {
  constexpr double kSame_mm = 1e-9, kRounded_mm = 1e-3;
  TriangleMesh mesh = welded(read, kSame_mm);
  fault = fault_of(mesh);
  if (fault.empty()) return mesh;
  TriangleMesh closer = welded(read, kRounded_mm);
  if (!fault_of(closer).empty()) return mesh;
  fault.clear();
  return closer;
}

Expected<TriangleMesh> surface_of(TriangleMesh read, double unit_mm) {
  for (Vector& point : read.points) {
    for (double& c : point) c *= unit_mm;
  }
  std::string fault;
  TriangleMesh mesh = closed(read, fault);
  if (!fault.empty()) return failure(MinorCode::InvalidParameterValue, "its surface " + fault);
  return mesh;
}

}  // namespace

Expected<TriangleMesh> read_mesh_file(const MeshShape& shape) {
  if (shape.surface) return surface_of(*shape.surface, shape.unit_mm);
  const fs::path& file = shape.file;
  if (!known_ending(file)) return wrong(file, "is neither an .stl nor an .obj file");
  std::error_code code;
  if (const auto size = fs::file_size(file, code); code || size > kLargestFile) {
    return wrong(file, code ? "cannot be read: " + code.message() : "is larger than 512 MiB; export it coarser");
  }
  Assimp::Importer importer;
  importer.SetIOHandler(new OnlyThisFile(file.string()));  // which it owns then
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_SortByPType);
  if (scene == nullptr) return wrong(file, fmt::format("is no mesh: {}", importer.GetErrorString()));
  TriangleMesh read;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    if (!append(*scene->mMeshes[i], shape.unit_mm, read)) {
      return wrong(file,
                   fmt::format("has a corner that is not finite, or farther than {} m away", kFarthest_mm / 1000));
    }
  }
  if (read.triangles.size() > kMostTriangles) {
    return wrong(file, fmt::format("has {} triangles; at most {} are taken: export it coarser", read.triangles.size(),
                                   kMostTriangles));
  }
  std::string fault;
  TriangleMesh mesh = closed(read, fault);
  if (!fault.empty()) return wrong(file, fault);
  return mesh;
}

}  // namespace rmac::gateway
