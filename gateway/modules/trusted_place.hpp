#pragma once

#include <filesystem>
#include <span>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Whether what lies in `file` may run in this process: to load code is to trust whoever may write it. Only root and
/// the user of this process (under sudo, the one who called it as well) may be able to write the file, or to put
/// another one into its place; and it lies in one of `folders`, also where links lead. The error says who may, and what
/// to do.
[[nodiscard]] Expected<> check_trusted(const std::filesystem::path& file,
                                       std::span<const std::filesystem::path> folders);

}  // namespace rmac::gateway
