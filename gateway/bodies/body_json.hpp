#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/bodies/body.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

// Bodies from a document that a schema of etc/ has passed: what it requires is there and has its type. An error begins
// with the JSON pointer of what is wrong.

/// `{"p": …, "q": …}` or `{"p": …, "axis": …}`; `pointer` is where it stands.
[[nodiscard]] Expected<Frame> read_frame(const nlohmann::json& object, const std::string& pointer);

/// Where files of meshes are looked for, and nowhere else; none: there may be no files, as in what comes over a socket.
using MeshFolder = std::optional<std::filesystem::path>;

/// `{"Box": …}`, `{"Cylinder": …}`, `{"Cone": …}`, `{"Sphere": …}` or `{"Mesh": …}`, that by its file or with its
/// points and triangles.
[[nodiscard]] Expected<SolidShape> read_shape(const nlohmann::json& object, const std::string& pointer,
                                              const MeshFolder& folder);

/// `Shape`, `Pose`, `Name`, `Link` and `Colour` of one body.
[[nodiscard]] Expected<Body> read_body(const nlohmann::json& object, const std::string& pointer,
                                       const MeshFolder& folder);

/// `Chain` and `Geometry` of a `device.json` whose mechanism has these joints; neither: no bodies.
[[nodiscard]] Expected<MachineBodies> read_machine_bodies(const nlohmann::json& device_json,
                                                          std::span<const std::string> joints,
                                                          const std::filesystem::path& folder);

}  // namespace rmac::gateway
