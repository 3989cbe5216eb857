#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// Where the files lie that a page is made of.
[[nodiscard]] std::filesystem::path page_folder();

/// Writes one page that shows `data` and needs no other file. Gives its size. What was there stays where it cannot be
/// written.
[[nodiscard]] Result<std::size_t> write_page(const nlohmann::json& data, const std::string& file);

}  // namespace rmac::cli
