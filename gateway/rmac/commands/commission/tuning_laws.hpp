#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"

// What `rmac tune` puts in force: for a while, and for good. `found` is what `tune.py` answers.

namespace rmac::cli {

/// A law, its parameters and gains, and whatever else the draft holds, come in force.
[[nodiscard]] Result<> put_law(Connection& connection, int joint, const std::string& law,
                               const nlohmann::json& parameters, const nlohmann::json& gains);
/// Into the draft.
[[nodiscard]] Result<> set_filters(Connection& connection, int joint, const nlohmann::json& filters);

/// Does `work` under a law that `put` puts in force; what was in force is put back, also where something fails.
[[nodiscard]] Result<> under_law(Connection& connection, int joint, const nlohmann::json& found,
                                 const std::function<Result<>()>& put, const std::function<Result<>()>& work);
/// A PID with the gains and filters that are proposed.
[[nodiscard]] Result<> put_proposed(Connection& connection, int joint, const nlohmann::json& found);

/// Gains and filters that were found, for good; with what creeping has shown where that is known.
[[nodiscard]] Result<> apply_found(Connection& connection, int joint, const nlohmann::json& found);

}  // namespace rmac::cli
