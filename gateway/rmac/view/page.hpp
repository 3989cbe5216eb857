#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// Writes one page that shows `data` and needs no other file. Gives its size. Nothing of it stays where it cannot be
/// written.
[[nodiscard]] Result<std::size_t> write_page(const nlohmann::json& data, const std::string& file);

}  // namespace rmac::cli
