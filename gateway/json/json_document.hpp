#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "gateway/json/json_schema.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Reads a JSON file and checks it against `schema`. Stricter than JSON where leniency hides mistakes: a key that
/// stands twice, a number too large for a double and a file over 1 MiB are errors. A syntax error is told by line and
/// column, a wrong value by its JSON pointer, with what is allowed.
[[nodiscard]] Expected<nlohmann::json> read_json_document(const std::filesystem::path& file, const JsonSchema& schema);

}  // namespace rmac::gateway
