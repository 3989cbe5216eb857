#pragma once

#include <nlohmann/json.hpp>
#include <string>

// What `tune.py` found, for a person.

namespace rmac::cli {

/// The joint, its loop before and after, the filters that belong to it, and what device.json is to say to keep it.
void print_tuning(const nlohmann::json& found, const std::string& picture);

/// Whether the joint has filters that were not looked at, because it was taken for rigid.
[[nodiscard]] bool loses_filters(const nlohmann::json& found);

}  // namespace rmac::cli
