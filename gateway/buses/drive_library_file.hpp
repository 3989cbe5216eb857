#pragma once

#include <filesystem>

#include "rmac/fieldbus/canopen/drive_library.hpp"

namespace rmac::gateway {

/// Reads all drives that a folder describes (etc/drive.schema.json). A file that is wrong refuses the drives that it is
/// for, or is told of where it does not even say for which; so a mistake in one file harms no other drive's machine.
/// Without a folder (an empty path) none is known.
[[nodiscard]] fieldbus::canopen::DriveLibrary read_drive_library(const std::filesystem::path& folder);

/// Refuses a library with a file that is wrong, or with two for the same drive; the error names each, with key and
/// reason.
[[nodiscard]] Expected<> check(const fieldbus::canopen::DriveLibrary& library);

}  // namespace rmac::gateway
