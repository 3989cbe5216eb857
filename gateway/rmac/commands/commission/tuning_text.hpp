#pragma once

#include <nlohmann/json.hpp>
#include <string>

// What `tune.py` found, for a person.

namespace rmac::cli {

/// The joint, its loop before and after, and the filters that belong to it.
void print_tuning(const nlohmann::json& found, const std::string& picture);

/// Filters as `device.json` has them.
[[nodiscard]] std::string filters_text(const nlohmann::json& filters);

}  // namespace rmac::cli
