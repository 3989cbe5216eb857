#pragma once

#include "gateway/bodies/body.hpp"
#include "gateway/bodies/triangle_mesh.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Reads the surface of a solid from an STL (text or binary) or OBJ file, or takes the one that the shape has itself,
/// its corners made one where they meet. Refused where it is not the closed surface of something. An error begins with
/// the file's name.
[[nodiscard]] Expected<TriangleMesh> read_mesh_file(const MeshShape& mesh);

}  // namespace rmac::gateway
