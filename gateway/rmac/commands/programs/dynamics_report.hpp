#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gateway/rmac/simulator/dynamics_watch.hpp"

namespace rmac::cli {

/// `"dynamics"` of --json; "not asked" where `watch` is null. `keeps_at`: the feed override at which the axes keep to a
/// program that they do not keep to at its own feed, %; none: not known to, or they keep to it.
[[nodiscard]] nlohmann::json dynamics_json(const DynamicsWatch* watch, std::optional<double> keeps_at);
/// Rows of the table: what, how much, and a remark.
void add_dynamics_rows(const DynamicsWatch& watch, std::vector<std::vector<std::string>>& rows);
/// Where it fails, and what joints and motors do.
void print_dynamics(const DynamicsWatch& watch, std::optional<double> keeps_at);

}  // namespace rmac::cli
