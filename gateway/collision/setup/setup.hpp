#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gateway/bodies/body.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// What is machined, and what holds it. Poses of bodies are in the part frame.
struct Setup {
  std::string machine;
  Frame part_frame;  ///< in the machine frame
  std::optional<Body> stock, part;
  std::vector<Body> fixtures;
  std::string material;
  std::optional<double> resolution_mm;  ///< of what is left of the stock
  double tolerance_mm = 0.05;           ///< of what is made, on either side
  double clearance_mm = 1;              ///< nearer than this is told; deeper than this is surely found
};

/// Reads a `setup.json` and checks it against etc/setup.schema.json. Files of meshes lie beside it or below. An error
/// begins with the file's name.
[[nodiscard]] Expected<Setup> read_setup(const std::filesystem::path& file);
/// The same of an object that came over a socket: meshes are in it, and no file is read. An error begins with the JSON
/// pointer of what is wrong.
[[nodiscard]] Expected<Setup> read_setup_object(const nlohmann::json& document);

}  // namespace rmac::gateway
