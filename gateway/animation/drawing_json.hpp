#pragma once

#include <nlohmann/json_fwd.hpp>

#include "gateway/animation/machine_drawing.hpp"
#include "gateway/bodies/triangle_mesh.hpp"

namespace rmac::gateway {

/// What `RMAC_CAM.GetGeometry` tells: bodies as in `device.json`, all with a frame's quaternion; of a mesh the name of
/// its file, without the folder.
[[nodiscard]] nlohmann::json to_json(const MachineDrawing& drawing);

/// `Points` in mm and `Triangles`, as a set-up's meshes have them.
[[nodiscard]] nlohmann::json to_json(const TriangleMesh& mesh);

}  // namespace rmac::gateway
