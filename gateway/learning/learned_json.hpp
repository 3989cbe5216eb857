#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "rmac/motion/servo/learned_path.hpp"

namespace rmac::gateway {

/// What was learned, and with which machine.
struct Learned {
  std::string machine;        ///< its name
  std::string configuration;  ///< tells this one from all others of it
  LearnedPath::Parts path;
};

/// Reads `{"Machine", "Configuration", "Moves": [[id, mm], …], "End": mm, "Places": [mm, …], "Joints": [{"Offsets":
/// [mm or deg, …]}, …]}`. The error names the member. What the numbers mean together, `LearnedPath::create` checks.
[[nodiscard]] Expected<Learned> read_learned(const nlohmann::json& object);
[[nodiscard]] nlohmann::json to_json(const Learned& learned);

}  // namespace rmac::gateway
