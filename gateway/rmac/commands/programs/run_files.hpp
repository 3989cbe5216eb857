#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gateway/collision/setup/setup.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// The meshes that a set-up reads.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const gateway::Setup& setup);
/// The meshes that a machine's shape is read from.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const gateway::MachineBodies& machine);
/// The files of a folder; none where there is no such folder.
[[nodiscard]] std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder);
/// Refuses what could not be written, and what is no regular file. `option` named it.
[[nodiscard]] Result<> refuse_unwritable(const std::string& file, const char* option);
/// Refuses to write a file that the run reads, or writes otherwise, under whatever name. `option` named it.
[[nodiscard]] Result<> refuse_used(const std::string& file, const char* option,
                                   const std::vector<std::filesystem::path>& used);

}  // namespace rmac::cli
