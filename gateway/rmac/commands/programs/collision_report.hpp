#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "gateway/rmac/simulator/collision_watch.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

// What `rmac simulate` says of collisions.

/// "none", or how many there are.
[[nodiscard]] std::string summary(const CollisionWatch& watch);
void print_collisions(const CollisionWatch& watch);
/// `collisions`, `near_misses` and `collisions_not_checked`.
void add_collisions(const CollisionWatch& watch, nlohmann::json& report);

}  // namespace rmac::cli
