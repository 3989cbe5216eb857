#pragma once

#include <nlohmann/json.hpp>
#include <string>

// What `tune.py` found, for a person.

namespace rmac::cli {

/// The joint, its loop before and after, the filters that belong to it, and what device.json is to say to keep it.
void print_tuning(const nlohmann::json& found, const std::string& picture);

}  // namespace rmac::cli
