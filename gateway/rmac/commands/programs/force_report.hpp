#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "gateway/rmac/simulator/collision_watch.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

// What `rmac simulate` says of cutting forces.

/// "not told" where nobody asked, by a set-up with Stock and Material; `by_move`: of each move too.
[[nodiscard]] nlohmann::json forces_json(const CollisionWatch* watch, bool by_move);
[[nodiscard]] nlohmann::json to_json(const std::vector<gateway::Overload>& overloads);
void add_force_rows(const CollisionWatch* watch, std::vector<std::vector<std::string>>& rows);
/// Where the spindle has not what cutting takes, and what is not told.
void print_forces(const CollisionWatch& watch);

}  // namespace rmac::cli
